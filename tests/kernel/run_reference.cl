/* The renderer's functions over arrays, LANES values a work-item, for comparison with double precision on the host. */
#include "lib/bsdf.h"
#include "lib/sampler.h"

#define AT (get_global_id(0) * LANES)

static v3 load_v3(global const float *p, uint n) { return v3_make(LANE_LOAD(p), LANE_LOAD(p + n), LANE_LOAD(p + 2 * n)); }
static void store_v3(v3 v, global float *p, uint n)
{
    LANE_STORE(v.x, p);
    LANE_STORE(v.y, p + n);
    LANE_STORE(v.z, p + 2 * n);
}

kernel void sincos_of(global const float *u, global float *s, global float *c)
{
    lane_f cosine, sine = sincos_2pi(LANE_LOAD(u + AT), &cosine);
    LANE_STORE(sine, s + AT);
    LANE_STORE(cosine, c + AT);
}

kernel void atan2_of(global const float *y, global const float *x, global float *out)
{
    LANE_STORE(atan2_over_2pi(LANE_LOAD(y + AT), LANE_LOAD(x + AT)), out + AT);
}

kernel void exp_of(global const float *x, global float *out) { LANE_STORE(exp_negative(LANE_LOAD(x + AT)), out + AT); }

kernel void log_of(global const float *x, global float *out)
{
    lane_f v = LANE_LOAD(x + AT);
    LANE_STORE(log_unit(v, 1.0f - v), out + AT);
}

kernel void fresnel_of(global const float *cosine, global const float *eta, global float *out)
{
    LANE_STORE(fresnel_dielectric(LANE_LOAD(cosine + AT), LANE_LOAD(eta + AT)), out + AT);
}

kernel void refract_of(uint n, global const float *w, global const float *m, global const float *eta, global float *out)
{
    store_v3(refract(load_v3(w + AT, n), load_v3(m + AT, n), LANE_LOAD(eta + AT)), out + AT, n);
}

/* White glass, of grey base. material: base, f0, alpha, transmission, eta (1: thin), stretch along x. */
static bsdf glass(uint n, global const float *wo, global const float *material, lane_i smooth)
{
    surface s;
    s.base = v3_splat(LANE_LOAD(material + AT));
    s.f0 = v3_splat(LANE_LOAD(material + n + AT));
    s.f90 = F(1.0f);
    s.metallic = F(0.0f);
    s.alpha_ggx = LANE_LOAD(material + 2 * n + AT);
    s.transmission = LANE_LOAD(material + 3 * n + AT);
    s.eta = LANE_LOAD(material + 4 * n + AT);
    s.stretch = LANE_LOAD(material + 5 * n + AT);
    s.refracts = s.eta != 1.0f;
    s.smooth = smooth;
    return bsdf_make(&s, load_v3(wo + AT, n), true);
}

kernel void glass_of(uint n, global const float *wo, global const float *wi, global const float *material, global float *f, global float *pdf)
{
    bsdf b = glass(n, wo, material, !TRUE_MASK);
    lane_f p;
    LANE_STORE(bsdf_eval(&b, load_v3(wi + AT, n), &p).y, f + AT);
    LANE_STORE(p, pdf + AT);
}

kernel void smooth_of(uint n, global const float *wo, global const float *material, global const float *u, global float *wi,
                      global float *weight, global float *pdf)
{
    bsdf b = glass(n, wo, material, TRUE_MASK);
    bsdf_direction d = bsdf_sample(&b, false, F(0.3f), (chooser){F(0.6f), F(0.0f), F(0.0f)}, LANE_LOAD(u + AT));
    store_v3(d.wi, wi + AT, n);
    LANE_STORE(d.weight.y, weight + AT);
    LANE_STORE(d.pdf, pdf + AT);
}

static void opaque(surface *s)
{
    s->smooth = s->refracts = !TRUE_MASK;
    s->transmission = F(0.0f);
    s->eta = F(1.0f);
}

/* Arrays of n, structure of arrays. material: base (3), f0 (3), f90, metallic, alpha. */
kernel void bsdf_of(uint n, global const float *wo, global const float *wi, global const float *material, global float *f,
                    global float *pdf)
{
    surface s;
    s.base = load_v3(material + AT, n);
    s.f0 = load_v3(material + 3 * n + AT, n);
    s.f90 = LANE_LOAD(material + 6 * n + AT);
    s.metallic = LANE_LOAD(material + 7 * n + AT);
    s.alpha_ggx = LANE_LOAD(material + 8 * n + AT);
    opaque(&s);
    bsdf b = bsdf_make(&s, load_v3(wo + AT, n), true);
    lane_f p;
    store_v3(bsdf_eval(&b, load_v3(wi + AT, n), &p), f + AT, n);
    LANE_STORE(p, pdf + AT);
}

/* Light that leaves along wo from a white metal under uniform light, by sampling: E of GGX with single scattering. One value a work-item:
 * the sum of f cos / pdf over `count` stratified samples. */
kernel void albedo_of(uint count, global const float *cosine, global const float *alpha, global float *sum)
{
    surface s;
    s.base = v3_splat(F(1.0f));
    s.f0 = v3_splat(F(1.0f));
    s.f90 = s.metallic = F(1.0f);
    uint at = get_global_id(0);
    s.alpha_ggx = F(alpha[at]);
    opaque(&s);
    lane_f z = F(cosine[at]);
    bsdf b = bsdf_make(&s, v3_make(sqrt(max(1.0f - z * z, F(0.0f))), F(0.0f), z), true);
    lane_f total = F(0.0f), lost = F(0.0f);
    for (uint i = 0; i < count; i += LANES) {
        lane_u k = LANE_NUMBERS + i;
        lane_f u1 = (to_lane_f(k) + 0.5f) / (float)count, u2 = to_lane_f(reverse_bits(k) >> 8) * 0x1p-24f + 0x1p-25f, pdf;
        v3 wi = bsdf_sample(&b, false, u1, (chooser){u2, F(0.0f), F(0.0f)}, F(0.5f)).wi;
        v3 f = bsdf_eval(&b, wi, &pdf);
        /* Kahan's sum: plain floats lose 10^-4 here. */
        lane_f add = (pdf > 0.0f ? f.y / pdf : F(0.0f)) - lost, next = total + add;
        lost = (next - total) - add;
        total = next;
    }
    LANE_STORE(total, sum + at * 16);
}
