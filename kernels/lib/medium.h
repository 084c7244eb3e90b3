/* What a ray is inside of, and what that absorbs. A path keeps one word for it: the first word of the body's material, or EC_NO_ID;
 * where bodies may be nested, the set of them (bodies.h). */
#ifndef EC_LIB_MEDIUM_H
#define EC_LIB_MEDIUM_H

#include "surface.h"

#define MEDIA_NESTED(params) (HAS(NESTED) ? (params)->nested != 0u : false)

/* Whose inside a ray came through: that of the body whose back it meets, where it entered unseen (a mesh that is open) or left
 * another one inside; else the one it entered last. */
EC_FN lane_u medium_of(const hit_point *h, const surface *s, lane_i found, lane_u entered, bool nested)
{
    lane_u medium = (s->refracts & !s->front) ? h->material : entered;
    if (nested) return found ? s->bodies : U(0);
    return found ? medium : U(EC_NO_ID);
}

/* Likewise for a ray that leaves the surface: beyond it if light is refracted, else where it came from. wi_z: against ns. */
EC_FN lane_u medium_towards(const hit_point *h, const surface *s, lane_u medium, lane_f wi_z, bool nested)
{
    lane_u beyond = nested ? s->beyond : s->front ? h->material : U(EC_NO_ID);
    return (s->refracts & (wi_z < 0.0f)) ? beyond : medium;
}

/* First word of its material. */
EC_FN lane_u medium_material(const geometry *g, lane_u medium, bool nested)
{
    return nested ? bodies_material(g, medium) : medium;
}

/* Around all bodies. */
EC_FN lane_u medium_air(bool nested) { return nested ? U(0) : U(EC_NO_ID); }
EC_FN lane_i medium_is_air(lane_u medium, bool nested) { return nested ? medium == 0u : medium == EC_NO_ID; }

/* What is left of each channel after `distance` metres (Beer-Lambert). */
EC_FN v3 extinguished(v3 density, lane_f distance)
{
    return v3_make(exp_negative(-density.x * distance), exp_negative(-density.y * distance), exp_negative(-density.z * distance));
}

/* Likewise of a material. */
EC_FN v3 medium_transmittance(const geometry *g, lane_u material, lane_f distance)
{
    lane_i inside = material != EC_NO_ID;
    if (!any_lane(inside)) return v3_splat(F(1.0f));
    quad a = gather_quad(g->materials, (inside ? material : U(0)) + EC_WORD_absorption);
    return v3_select(inside, extinguished(v3_make(a.a, a.b, a.c), distance), v3_splat(F(1.0f)));
}

#endif
