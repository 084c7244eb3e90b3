/* Direct light without visibility, the rasteriser's picture: emission or background, and for every light what its centre would
 * send if nothing were in the way. Reads: path queue and hits. Writes: radiance of the slots, first-hit features where asked for.
 * Next: accumulate. An emissive triangle counts as a point at its centroid, the environment as its mean from everywhere. */
#include "../lib/bsdf.h"
#include "../lib/features.h"
#include "../lib/light.h"
#include "../lib/queue.h"

#define LEAST_ALPHA 0.02f /* narrower highlights of points would be met by one sample in thousands */

/* One light from its centre: radiance times cosine and density, that is, irradiance of a plane that faces it. */
EC_FN v3 light_from_centre(const light_record *l, const geometry *g, v3 p, float scene_radius, v3 *wi)
{
    lane_u type = l->kind & EC_LIGHT_KIND_MASK;
    v3 e = v3_zero();
    *wi = v3_make(F(0.0f), F(0.0f), F(1.0f));
    if (HAS(AREA_LIGHTS)) {
        /* sqrt(u1) = 2/3 and u2 = 1/2 are the centroid; the density per solid angle is pmf d^2 / (area cos). */
        light_sample s = light_sample_triangle(l, g, type == EC_KIND_TRIANGLE, p, F(4.0f / 9.0f), F(0.5f));
        e = v3_select(s.valid, v3_scale(s.radiance, l->pmf / s.pdf), e);
        *wi = v3_select(s.valid, s.wi, *wi);
    }
    if (HAS(PUNCTUAL_LIGHTS)) {
        light_sample s = light_sample_punctual(l, (type >= EC_KIND_POINT) & (type <= EC_KIND_DIRECTIONAL), p, scene_radius);
        e = v3_select(s.valid, s.radiance, e);
        *wi = v3_select(s.valid, s.wi, *wi);
    }
    return e;
}

kernel void ec_shade_raster(constant ec_params *params, uint path_count, volatile global uint *invalid,
                            global const float *paths, global const float *hits, global float *radiance, global float *aov,
                            global const float *prims, global const float *indices, global const float *normals,
                            global const float *tangents, global const float *uvs, global const float *colors,
                            global const float *materials, global const float *texture_table, global const uint *texels,
                            constant float *srgb, global const float *light_table, global const float *environment_texels)
{
    uint i = get_global_id(0) * LANES, wave = params->wave;
    if (i >= path_count) return;
    geometry g = {prims, indices, normals, tangents, uvs, colors, materials, {texture_table, texels, srgb}};
    environment env = {params, environment_texels, 0};
    lane_u slot = LANE_NUMBERS + i;
    lane_i active = slot < path_count;
    v3 o = queue_load_v3(paths, wave, EC_PATH_OX, i), d = queue_load_v3(paths, wave, EC_PATH_DX, i), wo = v3_negate(d);
    lane_u prim = queue_load_u(hits, wave, EC_HIT_PRIM, i);
    lane_i found = active & (prim != EC_NO_ID);

    v3 out = v3_zero();
    if (HAS(ENVIRONMENT)) {
        lane_i missed = active & !found;
        lane_f unused;
        if (any_lane(missed)) out = v3_select(missed, environment_look_up(&env, d, &unused), out);
    }
    hit_point h = hit_point_make(&g, found ? prim : U(0), queue_load_f(hits, wave, EC_HIT_B1, i),
                                 queue_load_f(hits, wave, EC_HIT_B2, i));
    surface s;
    surface_place(&h, wo, &s);
    surface_frame(&g, &h, found, wo, &s);
    surface_material(&g, &h, found, &s);
    quad emission = material_quad(&g, &h, EC_MATERIAL_EMISSION);
    lane_u flags = as_lane_u(emission.d);
    if (HAS(EMISSION)) {
        lane_i m = found & ((flags & EC_MATERIAL_EMISSIVE) != 0u) & (s.front | ((flags & EC_MATERIAL_DOUBLE_SIDED) != 0u));
        if (any_lane(m)) out = v3_select(m, surface_emission(&g, &h, m, emission), out);
    }
    lane_i lit = found;
    if (HAS(UNLIT)) {
        lane_i m = found & ((flags & EC_MATERIAL_UNLIT) != 0u);
        out = v3_select(m, s.base, out);
        lit = lit & !m;
    }
    s.alpha_ggx = max(s.alpha_ggx, F(LEAST_ALPHA));
    s.smooth = !TRUE_MASK;
    bsdf b = bsdf_make(&s, surface_to_local(&s, wo));
    v3 direct = v3_zero();
    if (HAS(AREA_LIGHTS) || HAS(PUNCTUAL_LIGHTS)) {
        for (uint k = 0; k < params->light_count; k++) {
            light_record one = light_load_one(light_table, k);
            v3 wi;
            lane_f pdf;
            v3 e = light_from_centre(&one, &g, s.p, params->scene_radius, &wi);
            v3 f = bsdf_eval(&b, surface_to_local(&s, wi), &pdf);
            direct = v3_add(direct, v3_select(v3_dot(s.ng, wi) > 0.0f, v3_mul(f, e), v3_zero()));
        }
    }
    if (HAS(ENVIRONMENT)) {
        /* The mean from everywhere reflects as albedo, here that of normal incidence. */
        lane_f share;
        v3 fresnel = HAS(SPECULAR) ? bsdf_fresnel(&b, F(1.0f), &share) : v3_zero();
        v3 albedo = HAS(SPECULAR) ? v3_fma(b.base, share, fresnel) : b.base;
        constant float *mean = params->environment_mean;
        direct = v3_add(direct, v3_mul(albedo, v3_make(F(mean[0]), F(mean[1]), F(mean[2]))));
    }
    out = v3_select(lit, v3_add(out, direct), out);
    radiance_add(radiance, wave, slot, out, active, invalid + EC_STAGE_SHADE);
    if (aov) {
        v3 seen = v3_sub(s.p, o);
        store_features(aov, wave, slot, v3_select(found, s.base, v3_zero()), v3_select(found, s.ns, v3_zero()),
                       found ? sqrt(v3_dot(seen, seen)) : F(0.0f), found ? F(1.0f) : F(0.0f), mask_bits(active));
    }
}
