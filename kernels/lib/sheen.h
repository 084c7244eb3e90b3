/* Fibres over a surface (KHR_materials_sheen): the "Charlie" distribution with the visibility of Estevez and Kulla 2017,
 * "Production friendly microfacet sheen BRDF":
 *
 *   f = color D / (4 no ni (1 + L(no) + L(ni))) / max(1, E(no), E(ni)),   D = (2 + 1/alpha) sin^(1/alpha) / (2 pi)
 *
 * E is what it would return of white light (sheen_table.h): narrow fibres of roughness under 0.25 seen from the side would return
 * more than comes in, which the last factor takes away. What lies under them is scaled by 1 - max(color) E, the smaller of both
 * directions', so that the sum is reciprocal and returns no more than comes in. */
#ifndef EC_LIB_SHEEN_H
#define EC_LIB_SHEEN_H

#include "geometry.h"
#include "sheen_table.h"

typedef struct sheen_look {
    v3 color; /* 0: none */
    lane_f roughness;
} sheen_look;

EC_FN sheen_look sheen_read(const geometry *g, const hit_point *h, lane_i m)
{
    quad q = material_quad(g, h, EC_WORD_sheen);
    sheen_look look = {v3_make(q.a, q.b, q.c), q.d};
    if (HAS(SHEEN_TEXTURE)) {
        look.color = v3_mul(look.color, material_texture(g, h, m, EC_SLOT_SHEEN_COLOR, true).rgb);
        look.roughness *= material_texture(g, h, m, EC_SLOT_SHEEN_ROUGHNESS, false).a;
    }
    return look;
}

EC_FN void sheen_hide(lane_i m, sheen_look *look) { look->color = v3_select(m, v3_zero(), look->color); }

typedef struct sheen {
    v3 color;
    lane_f most;             /* its largest channel */
    lane_f roughness, power; /* power: 1 / alpha */
    lane_f albedo_o;         /* E at wo */
    lane_f shadowing_o;      /* L at wo */
    lane_f own;              /* about what it reflects */
    lane_f p;                /* probability of sampling it */
} sheen;

EC_FN lane_f sheen_exponential(lane_f x)
{
    lane_f e = exp_negative(-fabs(x));
    return x > 0.0f ? 1.0f / e : e;
}

/* The exponent of L, as fitted by Estevez and Kulla for alpha from 0 to 1; t: (1 - alpha)^2. */
EC_FN lane_f sheen_exponent(lane_f x, lane_f t)
{
    lane_f a = fma(t, F(25.3245f - 21.5473f), F(21.5473f)), b = fma(t, F(3.32435f - 3.82987f), F(3.82987f));
    lane_f c = fma(t, F(0.16801f - 0.19823f), F(0.19823f)), d = fma(t, F(-1.27393f + 1.97760f), F(-1.97760f));
    lane_f e = fma(t, F(-4.85967f + 4.32054f), F(-4.32054f));
    return a / fma(b, exp_negative(c * log_unit(x, 1.0f - x)), F(1.0f)) + fma(d, x, e);
}

EC_FN lane_f sheen_shadowing(const sheen *s, lane_f cosine)
{
    lane_f alpha = 1.0f / s->power, t = (1.0f - alpha) * (1.0f - alpha);
    lane_i grazing = cosine < 0.5f;
    lane_f x = sheen_exponent(grazing ? cosine : 1.0f - cosine, t);
    return sheen_exponential(grazing ? x : 2.0f * sheen_exponent(F(0.5f), t) - x);
}

/* Returns E, the albedo of white fibres. */
EC_FN lane_f sheen_albedo(const sheen *s, lane_f cosine)
{
    lane_f x = sqrt(cosine) * (float)(SHEEN_COSINES - 1);
    lane_f y = (s->roughness - SHEEN_LEAST_ROUGHNESS) * ((float)(SHEEN_ROUGHNESSES - 1) / (1.0f - SHEEN_LEAST_ROUGHNESS));
    lane_f x0 = min(floor(x), F((float)(SHEEN_COSINES - 2))), y0 = min(floor(y), F((float)(SHEEN_ROUGHNESSES - 2)));
    lane_u at = int_to_lane_u(to_lane_i(fma(y0, F((float)SHEEN_COSINES), x0)));
    lane_f u = x - x0, v = y - y0;
    lane_f low = fma(u, gather_constant_f(sheen_table, at + 1u), (1.0f - u) * gather_constant_f(sheen_table, at));
    lane_f high = fma(u, gather_constant_f(sheen_table, at + SHEEN_COSINES + 1u),
                      (1.0f - u) * gather_constant_f(sheen_table, at + SHEEN_COSINES));
    return fma(v, high, (1.0f - v) * low);
}

/* albedo: approximate albedo of the surface under the fibres. */
EC_FN sheen sheen_make(const sheen_look *look, v3 wo, lane_f albedo)
{
    sheen s;
    s.color = look->color;
    s.most = v3_max_component(look->color);
    s.roughness = max(look->roughness, F(SHEEN_LEAST_ROUGHNESS));
    s.power = 1.0f / (s.roughness * s.roughness);
    lane_f cosine = min(max(wo.z, F(0.0f)), F(1.0f));
    s.albedo_o = sheen_albedo(&s, cosine);
    s.shadowing_o = sheen_shadowing(&s, cosine);
    s.own = s.most * min(s.albedo_o, F(1.0f));
    lane_f under = (1.0f - s.own) * albedo;
    s.p = s.most > 0.0f ? min(max(s.own / (s.own + under), F(0.02f)), F(0.9f)) : F(0.0f); /* each matters at other angles */
    return s;
}

/* Returns the share of light between wo and a direction of this cosine that gets to what lies under the fibres. */
EC_FN lane_f sheen_leaves(const sheen *s, lane_f cosine)
{
    return 1.0f - s->most * min(max(s->albedo_o, sheen_albedo(s, min(fabs(cosine), F(1.0f)))), F(1.0f));
}

/* Samples a direction, uniform over the hemisphere. */
EC_FN v3 sheen_sample(const sheen *s, v3 wo, lane_f cosine, lane_f sine, lane_f u)
{
    lane_f r = sqrt(max(fma(-u, u, F(1.0f)), F(0.0f)));
    return v3_make(r * cosine, r * sine, u);
}

EC_FN v3 sheen_ambient(const sheen *s, v3 under)
{
    return v3_fma(s->color, min(s->albedo_o, F(1.0f)), v3_scale(under, 1.0f - s->own));
}

/* Lays the fibres over *f (f |cos wi|) and *pdf of the surface under them. */
EC_FN void sheen_over(const sheen *s, v3 wo, v3 wi, v3 *f, lane_f *pdf)
{
    lane_i covered = (s->most > 0.0f) & (wo.z > 0.0f), above = covered & (wi.z > 0.0f);
    if (!any_lane(covered)) return;
    lane_f ni = min(fabs(wi.z), F(1.0f)), albedo = max(s->albedo_o, sheen_albedo(s, ni));
    v3 h = v3_add(wo, wi);
    lane_f sine2 = fma(h.x, h.x, h.y * h.y), sum2 = fma(h.z, h.z, sine2);
    lane_f power = exp_negative(0.5f * s->power * log_unit(min(sine2 / sum2, F(1.0f)), h.z * h.z / sum2));
    lane_f d = (2.0f + s->power) * (0.5f * EC_INV_PI) * power;
    lane_f value = d / (4.0f * wo.z * (1.0f + s->shadowing_o + sheen_shadowing(s, ni)) * max(albedo, F(1.0f)));
    lane_f under = 1.0f - s->most * min(albedo, F(1.0f));
    *f = v3_select(covered, v3_scale(*f, under), *f);
    *f = v3_select(above, v3_fma(s->color, value, *f), *f);
    *pdf = fma(1.0f - s->p, *pdf, above ? s->p * (0.5f * EC_INV_PI) : F(0.0f));
}

#endif
