/* The order of lights in their table: one random number chooses a light by its place and goes on to a point on it, so that neighbours in the table
 * get neighbouring numbers. Lights at infinity come first, the environment before all others, then lamps along a curve through space. */
#ifndef EC_PACK_LIGHT_ORDER_H
#define EC_PACK_LIGHT_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "shared/scene_buffers.h"

/* Tells whether a light is at infinity: the environment or a directional light, and so not a lamp. */
bool ec_light_is_far(const ec_light_data *light);

/* Moves items[order[i]] to place i; `size` bytes each. Fails if there is no memory. */
ec_result ec_light_rearrange(void *items, size_t size, const uint32_t *order, uint32_t count, ec_error *err);

/* Sorts lights together with their powers and sources. Fails if there is no memory. */
ec_result ec_light_order(ec_light_data *lights, double *power, uint32_t *source, uint32_t count, ec_error *err);

#endif
