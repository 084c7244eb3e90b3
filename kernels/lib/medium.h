/* The medium that a ray is in, and what it absorbs. A path keeps one word for it: the first word of the body's material, or EC_NO_ID; where bodies
 * may be nested, the set of them (bodies.h). */
#ifndef EC_LIB_MEDIUM_H
#define EC_LIB_MEDIUM_H

#include "surface.h"

#define MEDIA_NESTED(params) (HAS(NESTED) ? (params)->nested != 0u : false)

/* Returns the medium through which a ray came to h: that of the body whose back it meets, since it may have entered unseen (an open mesh) or left
 * another body inside; else `entered`, the one it entered last. */
EC_FN lane_u medium_of(const hit_point *h, const surface *s, lane_i found, lane_u entered, bool nested)
{
    lane_u medium = (s->refracts & !s->front) ? h->material : entered;
    if (nested) return found ? s->bodies : U(0);
    return found ? medium : U(EC_NO_ID);
}

/* Returns the medium of a ray that leaves the surface: the one beyond if light is refracted, else `medium`, where it came from. wi_z: cosine to ns. */
EC_FN lane_u medium_towards(const hit_point *h, const surface *s, lane_u medium, lane_f wi_z, bool nested)
{
    lane_u beyond = nested ? s->beyond : s->front ? h->material : U(EC_NO_ID);
    return (s->refracts & (wi_z < 0.0f)) ? beyond : medium;
}

/* Returns the first word of the medium's material, or EC_NO_ID. */
EC_FN lane_u medium_material(const geometry *g, lane_u medium, bool nested)
{
    return nested ? bodies_material(g, medium) : medium;
}

/* The medium around all bodies. */
EC_FN lane_u medium_air(bool nested) { return nested ? U(0) : U(EC_NO_ID); }
EC_FN lane_i medium_is_air(lane_u medium, bool nested) { return nested ? medium == 0u : medium == EC_NO_ID; }

/* Returns the transmittance of each channel over `distance` metres (Beer-Lambert); density: extinction per metre. */
EC_FN v3 extinguished(v3 density, lane_f distance)
{
    return v3_make(exp_negative(-density.x * distance), exp_negative(-density.y * distance), exp_negative(-density.z * distance));
}

/* Returns the transmittance of a material over `distance` metres; 1 for EC_NO_ID. */
EC_FN v3 medium_transmittance(const geometry *g, lane_u material, lane_f distance)
{
    lane_i inside = material != EC_NO_ID;
    if (!any_lane(inside)) return v3_splat(F(1.0f));
    quad a = gather_quad(g->materials, (inside ? material : U(0)) + EC_WORD_absorption);
    return v3_select(inside, extinguished(v3_make(a.a, a.b, a.c), distance), v3_splat(F(1.0f)));
}

#endif
