/* The light that an eye ray sees before any light is sampled: background, emission, unlit surfaces. */
#ifndef EC_LIB_SEEN_H
#define EC_LIB_SEEN_H

#include "coat.h"
#include "environment.h"

typedef struct seen {
    hit_point h;
    surface s;
    v3 glow;     /* radiance without any light falling on the surface */
    lane_i lit;  /* lanes with a surface that light falls on */
} seen;

EC_FN v3 seen_background(const environment *env, lane_i missed, v3 d, bool shows)
{
    lane_f unused;
    if (!HAS(ENVIRONMENT) || !shows || !any_lane(missed)) return v3_zero();
    return v3_select(missed, environment_look_up(env, d, &unused), v3_zero());
}

/* bodies: those that the ray was in, as far as is known (bodies.h). */
EC_FN seen seen_surface(const geometry *g, lane_i found, lane_u prim, lane_f b1, lane_f b2, v3 wo, lane_u bodies)
{
    seen e;
    e.h = hit_point_make(g, found ? prim : U(0), b1, b2);
    surface_place(&e.h, wo, &e.s);
    surface_frame(g, &e.h, found, wo, &e.s);
    e.s.bodies = bodies;
    surface_material(g, &e.h, found, &e.s);
    e.glow = v3_zero();
    e.lit = found;
    quad emission = material_quad(g, &e.h, EC_WORD_emission);
    lane_u flags = as_lane_u(emission.d);
    if (HAS(EMISSION)) {
        lane_i m = found & ((flags & EC_MATERIAL_EMISSIVE) != 0u) & (e.s.front | ((flags & EC_MATERIAL_DOUBLE_SIDED) != 0u));
        if (any_lane(m)) e.glow = v3_select(m, coat_emission(g, &e.h, m, wo, surface_emission(g, &e.h, m, emission)), e.glow);
    }
    if (HAS(UNLIT)) {
        lane_i m = found & ((flags & EC_MATERIAL_UNLIT) != 0u);
        e.glow = v3_select(m, e.s.base, e.glow);
        e.lit = e.lit & !m;
    }
    return e;
}

#endif
