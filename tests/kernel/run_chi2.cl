/* Directions from the sampling routines, with the densities that they claim, for test_chi2_*.c. */
#include "lib/bsdf.h"
#include "lib/light.h"
#include "lib/scatter.h"
#include "packed_material.h"

/* Hashed random numbers: the test is about the mapping from them to directions. */
static void numbers(lane_u i, uint seed, lane_u *r1, lane_u *r2, lane_u *pass)
{
    lane_u h = hash_u(hash_u(i) ^ seed);
    *r1 = h;
    *r2 = hash_u(h ^ 0x9e3779b9u);
    *pass = hash_u(h + 0x85ebca6bu);
}

static v3 load_v3(global const float *p, uint n) { return v3_make(LANE_LOAD(p), LANE_LOAD(p + n), LANE_LOAD(p + 2 * n)); }

static void store(global float *out, uint n, v3 w, lane_f pdf)
{
    uint at = get_global_id(0) * LANES;
    LANE_STORE(w.x, out + at);
    LANE_STORE(w.y, out + n + at);
    LANE_STORE(w.z, out + 2 * n + at);
    LANE_STORE(pdf, out + 3 * n + at);
}

/* Rotates about the normal, by turns. */
static v3 turned(v3 w, float turns)
{
    lane_f c, s = sincos_2pi(F(turns), &c);
    return v3_make(fma(c, w.x, -s * w.y), fma(s, w.x, c * w.y), w.z);
}

static bsdf make_bsdf(constant float *m)
{
    surface s;
    s.base = v3_make(F(m[PACKED_BASE]), F(m[PACKED_BASE + 1]), F(m[PACKED_BASE + 2]));
    s.f0 = v3_splat(F(m[PACKED_F0]));
    s.f90 = F(m[PACKED_F90]);
    s.metallic = F(m[PACKED_METALLIC]);
    s.alpha_ggx = F(m[PACKED_ALPHA]);
    s.smooth = s.coat_smooth = !TRUE_MASK;
    s.transmission = F(m[PACKED_TRANSMISSION]);
    s.eta = F(m[PACKED_ETA]);
    s.refracts = LANE_NUMBERS < (m[PACKED_ETA] != 1.0f ? (uint)LANES : 0u);
    s.s = v3_make(F(1.0f), F(0.0f), F(0.0f));
    s.t = v3_make(F(0.0f), F(1.0f), F(0.0f));
    s.ns = v3_make(F(0.0f), F(0.0f), F(1.0f));
    s.stretch = F(1.0f + m[PACKED_STRETCH]);
    s.sheen.color = v3_make(F(m[PACKED_SHEEN]), F(m[PACKED_SHEEN + 1]), F(m[PACKED_SHEEN + 2]));
    s.sheen.roughness = F(m[PACKED_SHEEN_ROUGHNESS]);
    s.diffuse_transmission = F(m[PACKED_DIFFUSE_TRANSMISSION]);
    s.transmission_color = v3_make(F(m[PACKED_DIFFUSE_TRANSMISSION + 1]), F(m[PACKED_DIFFUSE_TRANSMISSION + 2]), F(m[PACKED_DIFFUSE_TRANSMISSION + 3]));
    s.film = F(m[PACKED_FILM]);
    s.film_ior = F(m[PACKED_FILM + 1]);
    s.film_thickness = F(m[PACKED_FILM + 2]);
    s.coat = F(m[PACKED_COAT]);
    s.coat_alpha = F(m[PACKED_COAT_ALPHA]);
    float tilt = m[PACKED_COAT_TILT], cosine = m[PACKED_COSINE];
    s.coat_ns = v3_make(F(tilt), F(0.0f), F(sqrt(1.0f - tilt * tilt)));
    return bsdf_make(&s, turned(v3_make(F(sqrt(max(1.0f - cosine * cosine, 0.0f))), F(0.0f), F(cosine)), m[PACKED_TURN]), true);
}

/* m: packed_material.h. The fifth array is the weight, green. */
kernel void bsdf_samples(uint n, uint seed, constant float *m, global float *out)
{
    lane_u r1, r2;
    lane_f pdf;
    lane_u pass;
    numbers(LANE_NUMBERS + (uint)get_global_id(0) * LANES, seed, &r1, &r2, &pass);
    bsdf b = make_bsdf(m);
    bsdf_direction d = bsdf_sample(&b, false, to_unit(r1), chooser_make(r2), to_unit(pass));
    bsdf_eval(&b, d.wi, &pdf);
    store(out, n, turned(d.wi, 1.0f - m[PACKED_TURN]), pdf);
    LANE_STORE(d.pdf > 0.0f ? d.weight.y : F(0.0f), out + 4 * n + get_global_id(0) * LANES);
}

/* Direction after scattering in a body, for light along d. */
kernel void phase_samples(uint n, uint seed, float g, constant float *d, global float *out)
{
    lane_u r1, r2, unused;
    v3 along = v3_make(F(d[0]), F(d[1]), F(d[2]));
    numbers(LANE_NUMBERS + (uint)get_global_id(0) * LANES, seed, &r1, &r2, &unused);
    v3 w = phase_sample(F(g), along, to_unit(r1), to_unit(r2));
    store(out, n, w, phase_value(F(g), along, w));
}

/* Density of given directions. */
kernel void bsdf_densities(uint n, constant float *m, global const float *wi, global float *pdf)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    bsdf b = make_bsdf(m);
    lane_f p;
    bsdf_eval(&b, turned(load_v3(wi + at, n), m[PACKED_TURN]), &p);
    LANE_STORE(p, pdf + at);
}

/* f |cos wi|, green, and density of given directions. */
kernel void bsdf_values(uint n, constant float *m, global const float *wi, global float *f, global float *pdf)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    bsdf b = make_bsdf(m);
    lane_f p;
    LANE_STORE(bsdf_eval(&b, turned(load_v3(wi + at, n), m[PACKED_TURN]), &p).y, f + at);
    LANE_STORE(p, pdf + at);
}

/* A sample of one light of a table, seen from p. */
kernel void light_samples(uint n, uint seed, constant ec_params *params, constant float *p, global const float *table,
                          global const uint *shares, global const float *texels, global const uint *texel_table, global float *out)
{
    lane_u r1, r2, unused;
    numbers(LANE_NUMBERS + (uint)get_global_id(0) * LANES, seed, &r1, &r2, &unused);
    geometry g = {0, 0, 0, 0, 0, 0, 0, {0, 0, 0}};
    lights l = {table, shares, {params, texels, texel_table}};
    light_sample s = light_sample_one(&l, &g, TRUE_MASK, v3_make(F(p[0]), F(p[1]), F(p[2])), r1, r2);
    store(out, n, s.wi, s.valid ? s.pdf : F(0.0f));
}

/* Density and red radiance of the environment in given directions. */
kernel void environment_densities(uint n, constant ec_params *params, global const float *texels, global const uint *table,
                                  global const float *wi, global float *pdf)
{
    uint at = get_global_id(0) * LANES;
    if (at >= n) return;
    environment e = {params, texels, table};
    lane_f p;
    v3 radiance = environment_look_up(&e, load_v3(wi + at, n), &p);
    LANE_STORE(p, pdf + at);
    LANE_STORE(radiance.x, pdf + n + at);
}
