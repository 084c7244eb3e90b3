/* What a body absorbs of the light that crosses it. */
#ifndef EC_LIB_MEDIUM_H
#define EC_LIB_MEDIUM_H

#include "surface.h"

/* The material (its first word, or EC_NO_ID) whose inside a ray came through: that of the body whose back it meets, where it
 * entered unseen (a camera inside) or left another one inside; else the one it entered last. */
EC_FN lane_u medium_of(const hit_point *h, const surface *s, lane_i found, lane_u entered)
{
    lane_u medium = (s->refracts & !s->front) ? h->material : entered;
    return found ? medium : U(EC_NO_ID);
}

/* Likewise for a ray that leaves the surface: beyond it if light is refracted, else where it came from. wi_z: against ns. */
EC_FN lane_u medium_towards(const hit_point *h, const surface *s, lane_u medium, lane_f wi_z)
{
    return (s->refracts & (wi_z < 0.0f)) ? (s->front ? h->material : U(EC_NO_ID)) : medium;
}

/* Beer-Lambert over `distance` metres. */
EC_FN v3 medium_transmittance(const geometry *g, lane_u medium, lane_f distance)
{
    lane_i inside = medium != EC_NO_ID;
    if (!any_lane(inside)) return v3_splat(F(1.0f));
    quad a = gather_quad(g->materials, (inside ? medium : U(0)) + EC_MATERIAL_ABSORPTION);
    v3 t = v3_make(exp_negative(-a.a * distance), exp_negative(-a.b * distance), exp_negative(-a.c * distance));
    return v3_select(inside, t, v3_splat(F(1.0f)));
}

#endif
