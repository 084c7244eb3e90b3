/* lib/bsdf.h, blinn_phong.h */
#ifndef EC_PRECISION_KERNEL_BSDF_H
#define EC_PRECISION_KERNEL_BSDF_H

#include "lib/blinn_phong.h"
#include "lib/dispersion.h"
#include "kernel.h"

/* Words: wo 0, wi 3, base 6, f0 9, f90 10, metallic 11, alpha 12 (0: smooth), transmission 13, eta 14 (1: thin), u 15 to 17, stretch 18. */
EC_FN surface material_of(global const float *in)
{
    surface s;
    s.base = V(6);
    s.f0 = v3_splat(X(9));
    s.f90 = X(10);
    s.metallic = X(11);
    s.smooth = X(12) == 0.0f;
    s.alpha_ggx = max(X(12), F(EC_SMOOTH_ALPHA));
    s.transmission = X(13);
    s.eta = X(14);
    s.refracts = s.eta != 1.0f;
    s.stretch = X(18);
    s.coat = F(0.0f);
    s.sheen.color = v3_zero();
    s.film = s.diffuse_transmission = F(0.0f);
    s.transmission_color = v3_zero();
    return s;
}
EC_FN bsdf bsdf_of(global const float *in)
{
    surface s = material_of(in);
    return bsdf_make(&s, V(0), false);
}

PRECISION(bsdf_make) { PUT(0, bsdf_of(in).p_specular); }
PRECISION(bsdf_fresnel)
{
    bsdf b = bsdf_of(in);
    lane_f rest;
    PUT_V(0, bsdf_fresnel(&b, X(15), &rest));
    PUT(3, rest);
    PUT(4, F(1.0f));
}
PRECISION(ggx_d)
{
    bsdf b = bsdf_of(in);
    PUT(0, ggx_d(&b.facets, V(0)));
}
PRECISION(ggx_lambda)
{
    bsdf b = bsdf_of(in);
    PUT(0, ggx_lambda(&b.facets, V(0)));
}
/* A coat over black with the surface's normal; alpha is in word 12. */
PRECISION(coat_over)
{
    surface s = material_of(in);
    s.s = v3_make(F(1.0f), F(0.0f), F(0.0f));
    s.t = v3_make(F(0.0f), F(1.0f), F(0.0f));
    s.ns = s.coat_ns = v3_make(F(0.0f), F(0.0f), F(1.0f));
    s.coat = F(1.0f);
    s.coat_alpha = s.alpha_ggx;
    s.coat_smooth = s.smooth;
    coat c = coat_make(&s, V(0), F(0.5f));
    v3 f = v3_zero();
    lane_f pdf = F(0.0f);
    coat_over(&c, V(3), &f, &pdf);
    PUT(0, f.x);
    PUT(1, pdf);
}
/* Fibres over black; the colour is in base, the roughness in place of alpha. */
PRECISION(multiscatter_over)
{
    multiscatter m = multiscatter_make(X(12), X(2), V(6), X(11), (1.0f - X(11)) * X(13), X(14), X(14) != 1.0f);
    multiscatter_weigh(&m, F(0.5f));
    v3 f = v3_zero();
    lane_f pdf = F(0.0f);
    multiscatter_over(&m, V(0), V(3), &f, &pdf);
    PUT_V(0, f);
    PUT(3, pdf);
}
PRECISION(sheen_over)
{
    sheen_look look = {V(6), X(12)};
    sheen s = sheen_make(&look, V(0), F(0.5f));
    v3 f = v3_zero();
    lane_f pdf = F(0.0f);
    sheen_over(&s, V(0), V(3), &f, &pdf);
    PUT_V(0, f);
    PUT(3, pdf);
    PUT(4, s.own);
}
/* White light through a sheet of colour base. */
PRECISION(bsdf_eval_diffuse_transmission)
{
    bsdf b = bsdf_of(in);
    b.diffuse_transmission = F(1.0f);
    b.transmission_color = b.base;
    b.p_below = F(0.5f);
    lane_f pdf;
    PUT_V(0, bsdf_eval_diffuse_transmission(&b, V(3), &pdf));
    PUT(3, pdf);
    PUT(4, -X(5) * EC_INV_PI);
}
PRECISION(dispersed_index)
{
    PUT(0, dispersed_index(X(0), X(1), I(0)));
    PUT(1, dispersed_index(X(0), X(1), I(2)));
}
/* Words: cosine, eta, the film's index and nanometres, f0, refracts (0 or 1). A colour is a difference of the light from both faces. */
PRECISION(film_reflectance)
{
    thin_film m = {F(1.0f), X(2), X(3)};
    film_light l = film_light_make(&m, X(0), X(1), X(5) != 0.0f);
    PUT_V(0, film_reflectance(&l, v3_splat(X(4)), F(1.0f)));
    PUT(3, F(1.0f));
}
/* The scale of a transmitted share is its value without reflection: the rounding error of 1 - F is relative to the light that arrives. */
PRECISION(bsdf_eval)
{
    bsdf b = bsdf_of(in);
    lane_f pdf;
    v3 f = bsdf_eval(&b, V(3), &pdf);
    PUT_V(0, f);
    PUT(3, pdf);
    PUT(4, max(X(5), F(0.0f)) * EC_INV_PI);
}
PRECISION(ggx_sample)
{
    bsdf b = bsdf_of(in);
    lane_f cosine, sine = sincos_2pi(X(15), &cosine);
    v3 m = ggx_sample(&b.facets, b.wo, cosine, sine, X(16));
    PUT(0, m.x);
    PUT(1, m.y);
    PUT(2, m.z);
}
PRECISION(bsdf_sample)
{
    bsdf b = bsdf_of(in);
    chooser number = {X(16), F(0.0f), F(0.0f)};
    bsdf_direction d = bsdf_sample(&b, false, X(15), number, X(17));
    PUT_V(0, d.wi);
    PUT_V(3, d.weight);
}
PRECISION(blind_sample)
{
    bsdf b = bsdf_of(in);
    lane_f pdf;
    v3 wi = blind_sample(&b, X(15), X(16), &pdf);
    PUT(0, wi.x);
    PUT(1, wi.y);
    PUT(2, wi.z);
}
PRECISION(blinn_phong_eval)
{
    bsdf b = bsdf_of(in);
    PUT_V(0, blinn_phong_eval(&b, !TRUE_MASK, V(3)));
}

#endif
