/* Light scattered inside bodies, KHR_materials_volume_scatter, and in fog: homogeneous media, Henyey and Greenstein's phase function. The distance is
 * sampled in closed form for one colour channel, chosen by its share of the throughput; its density is that of all three channels together (spectral
 * MIS, Wilkie et al. 2014), so that the sum of the three never grows. A scattering event takes the place of the surface. */
#ifndef EC_LIB_SCATTER_H
#define EC_LIB_SCATTER_H

#include "fog.h"

typedef struct scattering {
    lane_i m;  /* lanes whose path scatters before it meets a surface */
    v3 p;      /* where */
    lane_f g;  /* mean cosine of the scattering angle */
} scattering;

/* Returns the pdf per solid angle with which light along d goes on along wi. It uses chords of the unit sphere: cosines lose the digits of a narrow
 * peak. */
EC_FN lane_f phase_value(lane_f g, v3 d, v3 wi)
{
    lane_f narrow = fabs(g), rest = 1.0f - narrow;
    v3 chord = v3_fma(d, g < 0.0f ? F(1.0f) : F(-1.0f), wi);
    lane_f q = fma(narrow, v3_dot(chord, chord), rest * rest);
    return (0.25f * EC_INV_PI) * rest * (1.0f + narrow) / (q * sqrt(q));
}

/* Samples a direction with that density; u1, u2 in [0, 1). Inverting the distribution divides by g; in this form no digits are lost at any g: with
 * a = 1 + g (2 u - 1), the cosine c has 1 - c = 2 (1 - u) (1 - g)^2 (1 + g u) / a^2, and 1 + c is the same with -g and 1 - u. */
EC_FN v3 phase_sample(lane_f g, v3 d, lane_f u1, lane_f u2)
{
    v3 s, t;
    lane_f v2 = 1.0f - u2, a = fma(g, u2 - v2, F(1.0f)), back = (1.0f - g) / a, fore = (1.0f + g) / a;
    lane_f under = 2.0f * v2 * back * back * fma(g, u2, F(1.0f)), over = 2.0f * u2 * fore * fore * fma(-g, v2, F(1.0f));
    lane_f cos_phi, sin_phi = sincos_2pi(u1, &cos_phi), sine = sqrt(max(under * over, F(0.0f)));
    v3_frame(d, &s, &t);
    return v3_normalize(v3_fma(d, 0.5f * (over - under), v3_fma(s, sine * cos_phi, v3_scale(t, sine * sin_phi))));
}

/* Samples how many metres light goes at extinction `density` before it scatters; u in [0, 1). */
EC_FN lane_f scatter_distance(lane_f density, lane_f u)
{
    return density > 0.0f ? -log_unit(1.0f - u, u) / density : F(EC_HUGE);
}

/* The medium along a segment of a path: extinction per metre, albedo, g; where it begins and how long it is, in metres. */
typedef struct stretch {
    v3 density, albedo;
    lane_f g, from, length;
} stretch;

/* Makes the stretch of `length` metres from o along d: of a material, or of fog on the lanes `fogged`. */
EC_FN stretch stretch_make(constant ec_params *params, const geometry *g, lane_u material, lane_i fogged, v3 o, v3 d, lane_f length)
{
    lane_i inside = material != EC_NO_ID;
    lane_u at = inside ? material : U(0);
    quad scatter = gather_quad(g->materials, at + EC_WORD_scatter_albedo), density = gather_quad(g->materials, at + EC_WORD_absorption);
    stretch s = {v3_select(inside, v3_make(density.a, density.b, density.c), v3_zero()), v3_select(inside, v3_make(scatter.a, scatter.b, scatter.c), v3_zero()),
                 scatter.d, F(0.0f), length};
    if (HAS(FOG) && params->fog[0] > 0.0f) {
        lane_f from, span = fog_span(params, o, d, length, &from);
        s.density = v3_select(fogged, v3_splat(F(params->fog[0])), s.density);
        s.albedo = v3_select(fogged, v3_splat(F(params->fog[1])), s.albedo);
        s.g = fogged ? F(params->fog[2]) : s.g;
        s.from = fogged ? from : s.from;
        s.length = fogged ? span : s.length;
    }
    return s;
}

/* Samples whether and where a path from o along d scatters on the stretch `way`, before surface s, which is `length` metres away on the lanes
 * `found`. *beta takes what the medium leaves. u1 chooses a channel, u2 the distance. */
EC_FN scattering scatter_along(const stretch *way, v3 o, v3 d, const surface *s, lane_i found, lane_f length, lane_f u1, lane_f u2, v3 *beta)
{
    scattering e;
    lane_i strews = v3_max_component(way->albedo) > 0.0f;
    lane_f sum = beta->x + beta->y + beta->z, chosen = u1 * sum;
    lane_f one = chosen < beta->x ? way->density.x : chosen < beta->x + beta->y ? way->density.y : way->density.z, t = scatter_distance(one, u2);
    e.m = strews & (t < way->length);
    e.g = way->g;
    t = e.m ? t : way->length;
    v3 left = v3_mul(*beta, extinguished(way->density, t));
    v3 share = v3_select(e.m, v3_mul(left, way->density), left);
    lane_f shares = share.x + share.y + share.z;
    v3 strewn = v3_scale(v3_select(e.m, v3_mul(share, way->albedo), share), shares > 0.0f ? sum / shares : F(0.0f));
    *beta = v3_select(strews, strewn, left);
    /* From the nearer end: errors grow with the way, and no event may fall behind the wall that was met. */
    v3 end = surface_offset(s->p, s->p_error, s->ng, v3_negate(d));
    t += way->from;
    e.p = v3_select(found & (t + t >= length), v3_fma(d, t - length, end), v3_fma(d, t, o));
    return e;
}

#endif
