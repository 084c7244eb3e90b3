/* Pairs of lamps that face opposite ways, as the two sides of a bulb do: of each pair the one is chosen that shines on the point. */
#ifndef EC_PACK_LAMP_PAIRS_H
#define EC_PACK_LAMP_PAIRS_H

#include "base/error.h"
#include "shared/scene_buffers.h"

/* Puts triangles of one emission that face opposite ways beside each other, marks them in `kind`, and moves power and source along. *pairs: how
 * many there are. Lights are in the order of light_order.h, which each pair's first keeps. */
ec_result ec_lamp_pairs_find(ec_light_data *lights, double *power, uint32_t *source, uint32_t count, uint32_t *pairs, ec_error *err);

/* The place of the other one of a pair. */
static inline uint32_t ec_lamp_partner(const ec_light_data *lights, uint32_t i) { return lights[i].kind & EC_LIGHT_PAIR_FIRST ? i + 1 : i - 1; }

#endif
