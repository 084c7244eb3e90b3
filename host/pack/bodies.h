/* Bodies that light is refracted by and that may lie in one another. glTF has no priorities (Schmidt and Budge 2002), so where two
 * overlap, the smaller displaces the larger: the liquid the glass that holds it, the ice the liquid, a bubble what it is in. A body
 * is a part of a material that hangs together; what counts is the volume of the material's largest. */
#ifndef EC_PACK_BODIES_H
#define EC_PACK_BODIES_H

#include "base/error.h"
#include "scene/scene.h"
#include "shared/scene_buffers.h"

typedef struct ec_bodies {
    uint32_t count;                    /* of their materials; 0 where none can lie in another */
    uint32_t material[EC_BODIES_MOST]; /* by rank: the least volume first, and so the one that displaces */
    uint32_t too_many;                 /* that many: none is told apart, each refracts as in air */
} ec_bodies;

/* Bodies that overlap, by the boxes of their materials: an upper bound. is_body: of each material. */
ec_result ec_bodies_find(const ec_scene *scene, const bool *is_body, ec_bodies *bodies, ec_error *err);
/* Brings them into order. */
ec_result ec_bodies_rank(const ec_scene *scene, ec_bodies *bodies, ec_error *err);
/* Is a point in a closed body of the material? (Its winding number is over one half.) */
bool ec_bodies_contain(const ec_scene *scene, uint32_t material, const float point[3]);

#endif
