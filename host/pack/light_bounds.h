/* Bounds of lamps: where they are and where they shine. Inside host/pack only. */
#ifndef EC_PACK_LIGHT_BOUNDS_H
#define EC_PACK_LIGHT_BOUNDS_H

#include <stdbool.h>

#include "base/error.h"
#include "shared/light_tree.h"
#include "shared/scene_buffers.h"

/* A box, and a cone around the normals; a lamp shines about its normal with the cosine, or less. */
typedef struct ec_light_bounds {
    double low[3], high[3];
    double axis[3], cos_spread; /* -1: all directions */
    double power;               /* 0: empty */
    bool two_sided;             /* some shine against their normals too */
} ec_light_bounds;

ec_light_bounds ec_light_bounds_of(const ec_light_data *light, double power); /* for a triangle, point or spot */
void ec_light_bounds_add(ec_light_bounds *to, const ec_light_bounds *other);
/* Returns the squared diagonal of the box. */
double ec_light_bounds_size2(const ec_light_bounds *bounds);
/* Returns the expected cost of the lamps as a node: power, size and spread (Conty Estevez and Kulla 2018, equation 1). */
double ec_light_bounds_cost(const ec_light_bounds *bounds);
/* Makes a node, except for its link; rounding to float never makes the bounds smaller. */
ec_light_node ec_light_bounds_node(const ec_light_bounds *bounds, double most_power);

#endif
