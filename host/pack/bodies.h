/* Ranks bodies that refract light and may lie in one another. glTF has no priorities (Schmidt and Budge 2002), so where two overlap, the smaller
 * displaces the larger: the liquid the glass that holds it, the ice the liquid, a bubble what it is in. A body is a connected part of a material; a
 * material ranks by the volume of its largest body. */
#ifndef EC_PACK_BODIES_H
#define EC_PACK_BODIES_H

#include "base/error.h"
#include "scene/scene.h"
#include "shared/scene_buffers.h"

typedef struct ec_bodies {
    uint32_t count;                    /* number of their materials; 0: none can lie in another */
    uint32_t material[EC_BODIES_MOST]; /* by rank: the smallest volume first, which displaces the others */
    uint32_t too_many;                 /* not 0: this many are too many to tell apart, and each refracts as in air */
} ec_bodies;

/* Finds the bodies that overlap, by the boxes of their materials: an upper bound. is_body: by material. */
ec_result ec_bodies_find(const ec_scene *scene, const bool *is_body, ec_bodies *bodies, ec_error *err);
/* Sorts them by rank. */
ec_result ec_bodies_rank(const ec_scene *scene, ec_bodies *bodies, ec_error *err);
/* Tells whether a point is in a closed body of the material: its winding number is over one half. */
bool ec_bodies_contain(const ec_scene *scene, uint32_t material, const float point[3]);

#endif
