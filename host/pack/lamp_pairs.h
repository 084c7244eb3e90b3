/* Pairs of lamps that face opposite ways, as the two sides of a bulb do: of each pair the one is chosen that shines on the point. */
#ifndef EC_PACK_LAMP_PAIRS_H
#define EC_PACK_LAMP_PAIRS_H

#include "pack/pack.h"

#define EC_LAMP_PAIRS_MOST 8192 /* lamps: each is compared with each */

/* The partner of each of these lights, or EC_NO_ID: the nearest of the same emission that faces the opposite way. How many pairs there are. O(count^2).
 * Room for each of them: partner is the caller's. */
ec_result ec_lamp_pairs_match(const ec_light_data *lights, uint32_t count, uint32_t *partner, uint32_t *pairs, ec_error *err);

/* Marks them in `kind`. Each pair is to stand where its first one did; order: which light comes to each place. */
void ec_lamp_pairs_order(ec_light_data *lights, uint32_t count, const uint32_t *partner, uint32_t *order);

/* Moves lights in the table, light order[i] to place i; chances and what knows lights by their places go with them. */
ec_result ec_lights_move(ec_pack *pack, const uint32_t *order, ec_error *err);

/* Puts triangles of one emission that face opposite ways beside each other in the table, and marks them in `kind`; chances stay. Where lamps
 * stand still and no tree is made. Before there are casters. */
ec_result ec_pack_lamp_pairs(ec_pack *pack, ec_error *err);

/* The place of the other one of a pair. */
static inline uint32_t ec_lamp_partner(const ec_light_data *lights, uint32_t i) { return lights[i].kind & EC_LIGHT_PAIR_FIRST ? i + 1 : i - 1; }

#endif
