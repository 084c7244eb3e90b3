/* Bodies in bodies: a liquid in a glass, ice in it, bubbles of air. Of the bodies that contain a point, one displaces the others, and a wall refracts by the
 * indices on its two sides: nested dielectrics (Schmidt and Budge 2002, "Simple nested dielectrics in ray traced images"). glTF has no priorities, so the
 * body of least volume wins: contents displace their container (host/pack/bodies.h). A wall inside a body that displaces its own does not exist.
 *
 * A set of bodies is a word with a bit for each material, that of the least volume lowest. */
#ifndef EC_LIB_BODIES_H
#define EC_LIB_BODIES_H

#include "geometry.h"

/* Returns the first word of the material that fills the place, or EC_NO_ID for air. */
EC_FN lane_u bodies_material(const geometry *g, lane_u bodies)
{
    lane_i inside = bodies != 0u;
    lane_u rank = 31u - clz(bodies & (~bodies + 1u));
    lane_u material = as_lane_u(gather_f(g->materials, (inside ? rank : U(0)) * EC_MATERIAL_WORDS + EC_WORD_body_of_rank));
    return inside ? material : U(EC_NO_ID);
}

EC_FN lane_f bodies_index(const geometry *g, lane_u material)
{
    lane_i inside = material != EC_NO_ID;
    lane_f index = gather_f(g->materials, (inside ? material : U(0)) + EC_WORD_ior);
    return inside ? index : F(1.0f);
}

#endif
