/* Pairs of lamps that face opposite ways, as the two sides of a bulb do: of each pair the one is chosen that shines on the point. */
#ifndef EC_PACK_LAMP_PAIRS_H
#define EC_PACK_LAMP_PAIRS_H

#include "pack/pack.h"

/* Puts triangles of one emission that face opposite ways beside each other in the table, and marks them in `kind`; chances stay. Where lamps
 * stand still and no tree is made, which knows by itself what faces a point. Before there are casters. */
ec_result ec_pack_lamp_pairs(ec_pack *pack, ec_error *err);

/* The place of the other one of a pair. */
static inline uint32_t ec_lamp_partner(const ec_light_data *lights, uint32_t i) { return lights[i].kind & EC_LIGHT_PAIR_FIRST ? i + 1 : i - 1; }

#endif
