/* The order of lights in their table: one random number chooses a light by its place and goes on to a point on it, so that neighbours in the
 * table get neighbouring numbers. First what is infinitely far, the environment before all, then lamps along a curve through space. */
#ifndef EC_PACK_LIGHT_ORDER_H
#define EC_PACK_LIGHT_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "shared/scene_buffers.h"

/* The environment or a directional light: no lamp. */
bool ec_light_is_far(const ec_light_data *light);

/* Puts items[order[i]] in place i, of items of so many bytes. Fails without memory. */
ec_result ec_light_rearrange(void *items, size_t size, const uint32_t *order, uint32_t count, ec_error *err);

/* Sorts count lights, their powers, and where they come from. Fails without memory. */
ec_result ec_light_order(ec_light_data *lights, double *power, uint32_t *source, uint32_t count, ec_error *err);

#endif
