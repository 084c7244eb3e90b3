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

kernel void acos_of(global const float *x, global float *out) { LANE_STORE(acos_over_pi(LANE_LOAD(x + AT)), out + AT); }

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
    bsdf b = bsdf_make(&s, load_v3(wo + AT, n));
    lane_f p;
    store_v3(bsdf_eval(&b, load_v3(wi + AT, n), &p), f + AT, n);
    LANE_STORE(p, pdf + AT);
}

/* Light leaving along wo from a white metal under uniform light, by sampling: E of one-bounce GGX. One value a work-item:
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
    bsdf b = bsdf_make(&s, v3_make(sqrt(max(1.0f - z * z, F(0.0f))), F(0.0f), z));
    lane_f total = F(0.0f), lost = F(0.0f);
    for (uint i = 0; i < count; i += LANES) {
        lane_u k = LANE_NUMBERS + i;
        lane_f u1 = (to_lane_f(k) + 0.5f) / (float)count, u2 = to_lane_f(reverse_bits(k) >> 8) * 0x1p-24f + 0x1p-25f, pdf;
        v3 wi = bsdf_sample(&b, false, u1, u2, F(0.5f)).wi;
        v3 f = bsdf_eval(&b, wi, &pdf);
        /* Kahan's sum: plain floats lose 10^-4 here. */
        lane_f add = (pdf > 0.0f ? f.y / pdf : F(0.0f)) - lost, next = total + add;
        lost = (next - total) - add;
        total = next;
    }
    LANE_STORE(total, sum + at * 16);
}
