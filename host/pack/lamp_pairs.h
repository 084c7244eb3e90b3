/* Pairs lamps that face opposite ways, such as the two sides of a bulb: of each pair the one that faces the point is chosen. */
#ifndef EC_PACK_LAMP_PAIRS_H
#define EC_PACK_LAMP_PAIRS_H

#include "pack/pack.h"

#define EC_LAMP_PAIRS_MOST 8192 /* lamps: each is compared with every other */

/* Finds each light's partner, the nearest of the same emission that faces the opposite way, or EC_NO_ID; *pairs: their number. O(count^2). partner:
 * the caller's, count entries. */
ec_result ec_lamp_pairs_match(const ec_light_data *lights, uint32_t count, uint32_t *partner, uint32_t *pairs, ec_error *err);

/* Marks pairs in `kind`. Both of a pair are to stand where its first one did; order: the light that comes to each place. */
void ec_lamp_pairs_order(ec_light_data *lights, uint32_t count, const uint32_t *partner, uint32_t *order);

/* Moves light order[i] to place i of the table, with its probability and everything that refers to it by place. */
ec_result ec_lights_move(ec_pack *pack, const uint32_t *order, ec_error *err);

/* Places paired triangles side by side in the table and marks them in `kind`, without changing probabilities. For scenes whose lamps stand still and
 * that have no tree; before casters are made. */
ec_result ec_pack_lamp_pairs(ec_pack *pack, ec_error *err);

/* Returns the place of the other lamp of a pair. */
static inline uint32_t ec_lamp_partner(const ec_light_data *lights, uint32_t i) { return lights[i].kind & EC_LIGHT_PAIR_FIRST ? i + 1 : i - 1; }

#endif
