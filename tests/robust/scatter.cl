/* Evaluates the BSDF and its parts over arrays; scatter_fields.h has their layout. */
#include "lib/bsdf.h"
#include "lib/sampler.h"
#include "scatter_fields.h"

#define IN(field) LANE_LOAD(in + (field) * n + at)
#define PUT(field, value) LANE_STORE(value, out + (field) * n + at)

kernel void ec_scatter(uint n, global const float *in, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    surface s;
    s.base = v3_make(IN(EC_SCATTER_BASE), IN(EC_SCATTER_BASE + 1), IN(EC_SCATTER_BASE + 2));
    s.f0 = v3_splat(IN(EC_SCATTER_F0));
    s.f90 = IN(EC_SCATTER_F90);
    s.metallic = IN(EC_SCATTER_METALLIC);
    s.alpha_ggx = IN(EC_SCATTER_ALPHA);
    s.transmission = IN(EC_SCATTER_TRANSMISSION);
    s.eta = IN(EC_SCATTER_ETA);
    s.refracts = s.eta != 1.0f;
    s.stretch = IN(EC_SCATTER_STRETCH);
    s.smooth = IN(EC_SCATTER_SMOOTH) != 0.0f;
    bsdf b = bsdf_make(&s, v3_make(IN(EC_SCATTER_WO), IN(EC_SCATTER_WO + 1), IN(EC_SCATTER_WO + 2)), true);
    v3 w = v3_make(IN(EC_SCATTER_W), IN(EC_SCATTER_W + 1), IN(EC_SCATTER_W + 2));
    lane_f pdf;
    PUT(EC_SCATTER_F, bsdf_eval(&b, w, &pdf).y);
    PUT(EC_SCATTER_PDF, pdf);
    PUT(EC_SCATTER_D, ggx_d(&b.facets, w));
    PUT(EC_SCATTER_LAMBDA, ggx_lambda(&b.facets, w));
    PUT(EC_SCATTER_FRESNEL, fresnel_dielectric(w.z, s.eta));
    chooser number = {w.y, F(0.0f), F(0.0f)};
    bsdf_direction d = bsdf_sample(&b, false, w.x, number, w.z);
    PUT(EC_SCATTER_WI, d.wi.x);
    PUT(EC_SCATTER_WI + 1, d.wi.y);
    PUT(EC_SCATTER_WI + 2, d.wi.z);
    PUT(EC_SCATTER_WI_PDF, d.pdf);
    PUT(EC_SCATTER_WEIGHT, d.weight.y);
}

/* Reflectance of a thin film: index and nanometres in w, then the cosine; over f0, or refracting where eta is not 1. */
kernel void ec_films(uint n, global const float *in, global float *out)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    lane_f eta = IN(EC_SCATTER_ETA);
    thin_film m = {F(1.0f), IN(EC_SCATTER_W), IN(EC_SCATTER_W + 1)};
    film_light l = film_light_make(&m, IN(EC_SCATTER_W + 2), eta, eta != 1.0f);
    v3 r = film_reflectance(&l, v3_splat(IN(EC_SCATTER_F0)), F(1.0f));
    PUT(EC_SCATTER_F, r.x);
    PUT(EC_SCATTER_F + 1, r.y);
    PUT(EC_SCATTER_F + 2, r.z);
}

/* A stream of numbers in [0, 1), often at its ends. */
typedef struct stream {
    lane_u key;
    uint at;
} stream;

EC_FN lane_u stream_bits(stream *s) { return hash_u(s->key + 0x9e3779b9u * ++s->at); }

EC_FN lane_f stream_unit(stream *s)
{
    lane_f u = to_unit(stream_bits(s));
    lane_u end = stream_bits(s) & 7u;
    return end == 0u ? F(0.0f) : (end == 1u ? F(1.0f - EC_ULP) : u);
}
/* In [0, 1], both ends included. */
EC_FN lane_f stream_factor(stream *s)
{
    lane_f u = stream_unit(s);
    return u == 1.0f - EC_ULP ? F(1.0f) : u;
}
/* A number from `least` to 1, log-uniform. */
EC_FN lane_f stream_scale(stream *s, float log_least, float least)
{
    lane_f x = exp_negative(stream_factor(s) * log_least);
    return min(max(x, F(least)), F(1.0f));
}

EC_FN v3 stream_direction(stream *s)
{
    lane_f z = (stream_bits(s) & 1u) != 0u ? stream_scale(s, -27.6f, 1e-12f) : stream_factor(s);
    lane_f cosine, sine = sincos_2pi(stream_unit(s), &cosine);
    lane_f r = sqrt(max(fma(-z, z, F(1.0f)), F(0.0f)));
    return v3_make(r * cosine, r * sine, z);
}

/* Adds layers over the surface, stretched lobes, and diffuse transmission. */
EC_FN void stream_layers(stream *s, surface *r)
{
    r->s = v3_make(F(1.0f), F(0.0f), F(0.0f));
    r->t = v3_make(F(0.0f), F(1.0f), F(0.0f));
    r->ns = v3_make(F(0.0f), F(0.0f), F(1.0f));
    v3 tilted = stream_direction(s);
    r->coat_ns = v3_select((stream_bits(s) & 3u) != 0u, r->ns, tilted);
    r->stretch = max(stream_scale(s, -9.3f, EC_SMOOTH_ALPHA) / r->alpha_ggx, F(1.0f));
    r->smooth = r->smooth & (r->stretch == 1.0f);
    surface_widen(r->refracts, r);
    lane_f coat_alpha = stream_scale(s, -9.3f, EC_SMOOTH_ALPHA), roughness = stream_factor(s);
    r->coat = stream_factor(s);
    r->coat_alpha = coat_alpha;
    r->coat_smooth = (coat_alpha == EC_SMOOTH_ALPHA) & ((stream_bits(s) & 1u) != 0u);
    r->sheen.color = v3_make(stream_factor(s), stream_factor(s), stream_factor(s));
    r->sheen.roughness = roughness;
    r->film = stream_factor(s);
    r->film_ior = 1.0f + stream_factor(s) * 3.0f;
    r->film_thickness = stream_factor(s) / stream_scale(s, -9.3f, EC_SMOOTH_ALPHA) * 100.0f;
    r->film = ((r->film_thickness > 0.0f) & (r->film_ior > 1.0f)) ? r->film : F(0.0f);
    r->diffuse_transmission = r->metallic < 1.0f ? stream_factor(s) : F(0.0f);
    r->transmission_color = v3_make(stream_factor(s), stream_factor(s), stream_factor(s));
}

/* Material values as kernels/lib/surface.h makes them from any material that a file can hold. */
EC_FN surface stream_surface(stream *s)
{
    const float indices[4] = {1.0f, 1.0f + 0x1p-20f, 1.5f, 2.4f};
    surface r;
    r.base = v3_make(stream_factor(s), stream_factor(s), stream_factor(s));
    r.f90 = stream_factor(s);
    r.f0 = v3_scale(v3_make(stream_factor(s), stream_factor(s), stream_factor(s)), r.f90);
    r.metallic = stream_factor(s);
    r.transmission = stream_factor(s);
    lane_u kind = stream_bits(s);
    lane_f index = (kind & 8u) != 0u ? 1.0f + stream_factor(s) * 3.0f : F(indices[0]);
    for (uint i = 1; i < 4; i++) index = (kind & 11u) == i ? F(indices[i]) : index;
    r.refracts = (index != 1.0f) & (r.transmission > 0.0f) & (r.metallic < 1.0f);
    r.eta = r.refracts ? ((kind & 16u) != 0u ? index : 1.0f / index) : F(1.0f);
    r.alpha_ggx = stream_scale(s, -9.3f, EC_SMOOTH_ALPHA);
    r.smooth = (r.alpha_ggx == EC_SMOOTH_ALPHA) & ((kind & 32u) != 0u);
    r.smooth = r.smooth | surface_passes_singly(&r);
    if (HAS(ANISOTROPY)) stream_layers(s, &r);
    return r;
}

EC_FN lane_i v3_is_negative(v3 a) { return (a.x < 0.0f) | (a.y < 0.0f) | (a.z < 0.0f); }

/* Tests random materials and directions, `rounds` of them a lane. counts: EC_FUZZ_COUNTS for each work-item. */
kernel void ec_scatter_fuzz(uint n, uint rounds, uint seed, global uint *counts)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    uint wrong[EC_FUZZ_COUNTS] = {0};
    for (uint round = 0; round < rounds; round++) {
        stream random = {hash_u(hash_u(LANE_NUMBERS + at) ^ hash_scalar(seed + round)), 0};
        surface s = stream_surface(&random);
        bsdf b = bsdf_make(&s, stream_direction(&random), true);
        v3 w = stream_direction(&random);
        w.z = (stream_bits(&random) & 1u) != 0u ? w.z : -w.z;
        lane_f pdf;
        v3 f = bsdf_eval(&b, w, &pdf);
        lane_f u1 = stream_unit(&random), u = stream_unit(&random);
        chooser number = {stream_unit(&random), F(5.9604644775390625e-8f), stream_unit(&random)};
        bsdf_direction d = bsdf_sample(&b, false, u1, number, u);
        lane_i goes = (d.pdf != 0.0f) & (d.wi.z != 0.0f); /* NaN too; shade.cl continues no such path */
        wrong[EC_FUZZ_NOT_FINITE] += count_lanes(!v3_is_finite(f) | !is_finite_bits(pdf) | !is_finite_bits(d.pdf) |
                                                 (goes & !(v3_is_finite(d.weight) & v3_is_finite(d.wi))));
        wrong[EC_FUZZ_NEGATIVE] += count_lanes(v3_is_negative(f) | (pdf < 0.0f) | ((d.pdf < 0.0f) & (d.pdf != -1.0f)) |
                                               (goes & v3_is_negative(d.weight)));
        wrong[EC_FUZZ_NOT_UNIT] += count_lanes(goes & !(fabs(v3_dot(d.wi, d.wi) - 1.0f) <= 32.0f * EC_ULP / min(s.eta, F(1.0f))));
        wrong[EC_FUZZ_ASTRAY] += count_lanes(goes & (s.transmission == 0.0f) & !(d.wi.z > 0.0f) &
                                             !(HAS(DIFFUSE_TRANSMISSION) ? s.diffuse_transmission > 0.0f : !TRUE_MASK));
        wrong[EC_FUZZ_HEAVY] += count_lanes(goes & (v3_max_component(d.weight) > EC_FUZZ_WEIGHT));
    }
    for (uint i = 0; i < EC_FUZZ_COUNTS; i++) counts[at / LANES * EC_FUZZ_COUNTS + i] = wrong[i];
}
