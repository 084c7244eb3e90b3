/* A thin film on a surface (KHR_materials_iridescence): reflectance by Belcour and Barla 2017, "A practical extension to microfacet theory for the modeling
 * of varying iridescence", with the constants of the extension's text. Light that has crossed the film to and fro m = 0, 1, 2 times is delayed; each of X,
 * Y, Z gets a cosine of the delay that fades with it. The outer face has Fresnel's own formula, not Schlick's as in that text, which does not vanish with
 * the film; the inner one has Schlick's, but Fresnel's where the surface refracts, so that light from inside finds the same film. */
#ifndef EC_LIB_IRIDESCENCE_H
#define EC_LIB_IRIDESCENCE_H

#include "fresnel.h"

typedef struct thin_film {
    lane_f weight;    /* share of the surface that has the film; 0: none */
    lane_f ior;       /* at least 1 */
    lane_f thickness; /* nanometres */
} thin_film;

/* Terms of the film that do not depend on the surface under it. */
typedef struct film_light {
    lane_f ior, inside;  /* its index, and the cosine inside it */
    lane_f outer;        /* reflectance of its outer face */
    v3 once, twice;      /* X, Y, Z of light delayed by one crossing to and fro; Rec. 709 of light delayed by two */
    lane_i exact, total; /* exact: the surface refracts; total: total reflection, no light gets here from outside */
} film_light;

/* One Gaussian of the eye's sensitivity: peak is sqrt(2 pi variance) over 1.0685e-7 times that of the text. */
EC_FN lane_f film_sensitivity(float peak, float position, float variance, lane_f way)
{
    lane_f turns = way * position, cosine, phase = way * (2.0f * EC_PI);
    sincos_2pi(turns - floor(turns), &cosine);
    return peak * cosine * exp_negative(phase * phase * -variance);
}

EC_FN v3 film_late(lane_f way)
{
    lane_f x = film_sensitivity(0.84659000f, 1.6810e+06f, 4.3278e+09f, way) +
               film_sensitivity(0.15386832f, 2.2399e+06f, 4.5282e+09f, way);
    return v3_make(x, film_sensitivity(1.0002219f, 1.7953e+06f, 9.3046e+09f, way),
                   film_sensitivity(1.0011225f, 2.2084e+06f, 6.6121e+09f, way));
}

EC_FN v3 film_rec709(v3 xyz)
{
    return v3_make(fma(xyz.x, F(3.2404542f), fma(xyz.y, F(-1.5371385f), xyz.z * -0.4985314f)),
                   fma(xyz.x, F(-0.9692660f), fma(xyz.y, F(1.8760108f), xyz.z * 0.0415560f)),
                   fma(xyz.x, F(0.0556434f), fma(xyz.y, F(-0.2040259f), xyz.z * 1.0572252f)));
}

/* Makes the film's terms for this cosine. eta: the index beyond the surface over that on this side, under 1 where the light comes from inside. */
EC_FN film_light film_light_make(const thin_film *m, lane_f cosine, lane_f eta, lane_i exact)
{
    film_light l;
    /* The film vanishes with its thickness: its index goes to that of air over the first 0.03 nm. */
    lane_f t = min(m->thickness * (1.0f / 0.03f), F(1.0f));
    l.ior = fma(m->ior - 1.0f, t * t * fma(t, F(-2.0f), F(3.0f)), F(1.0f));
    l.exact = exact;
    lane_f out2 = refracted_cosine2(cosine, eta);
    lane_i within = exact & (eta < 1.0f);
    l.total = within & !(out2 > 0.0f);
    lane_f outside = within ? min(sqrt(max(out2, F(0.0f))) / eta, F(1.0f)) : cosine;
    l.inside = min(sqrt(max(refracted_cosine2(outside, l.ior), F(0.0f))) / l.ior, F(1.0f));
    l.outer = fresnel_dielectric(outside, l.ior);
    lane_f way = 2.0e-9f * l.ior * m->thickness * l.inside;
    l.once = film_late(way);
    l.twice = film_rec709(film_late(2.0f * way));
    return l;
}

/* Returns the reflectance of the inner face, over a surface that would reflect f0 head-on without a film. *sparser: its index is below the film's. */
EC_FN lane_f film_inner(const film_light *l, lane_f f0, lane_f f90, lane_i *sparser)
{
    lane_f root = sqrt(min(f0, F(0.9999f))), base = (1.0f + root) / (1.0f - root),
           r = (base - l->ior) / (base + l->ior), head_on = r * r;
    *sparser = base < l->ior;
    return fma(f90 - head_on, fresnel_rise(l->inside, base / l->ior, l->exact), head_on);
}

EC_FN lane_f film_sum(const film_light *l, lane_f inner, lane_f once, lane_f twice)
{
    lane_f both = min(l->outer * inner, F(0.9999f)), through = 1.0f - l->outer;
    lane_f settled = through * through * inner / (1.0f - both), c = 2.0f * (settled - through);
    lane_f sum = fma(c * sqrt(both), once, l->outer + settled);
    sum = min(max(fma(c * both, twice, sum), F(0.0f)), F(1.0f)); /* the series is truncated, and colours may leave the gamut */
    return l->total ? F(1.0f) : sum;
}

/* Returns the reflectance of film and surface. A channel's sign in X, Y, Z is that of the text: reflection at a denser medium shifts by half a turn. */
EC_FN v3 film_reflectance(const film_light *l, v3 f0, lane_f f90)
{
    lane_i x, y, z;
    v3 inner;
    inner.x = film_inner(l, f0.x, f90, &x);
    inner.y = film_inner(l, f0.y, f90, &y);
    inner.z = film_inner(l, f0.z, f90, &z);
    v3 late = l->once, once = film_rec709(v3_make(x ? late.x : -late.x, y ? late.y : -late.y, z ? late.z : -late.z));
    return v3_make(film_sum(l, inner.x, once.x, l->twice.x), film_sum(l, inner.y, once.y, l->twice.y),
                   film_sum(l, inner.z, once.z, l->twice.z));
}

#endif
