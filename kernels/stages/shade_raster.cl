/* Direct light without visibility, the rasteriser's picture: emission or background, and for every light what its centre would
 * send if nothing were in the way. Reads: path queue and hits. Writes: radiance of the slots, first-hit features where asked for.
 * Next: accumulate. */
#include "../lib/bsdf.h"
#include "../lib/features.h"
#include "../lib/kernel.h"
#include "../lib/light_centre.h"
#include "../lib/seen.h"

#define LEAST_ALPHA 0.02f /* narrower highlights of points would be met by one sample in thousands */

#define SHADE_RASTER_PARAMETERS(DO)                                                                                                                   \
    DO(uint, path_count) DO(volatile global uint *, invalid) DO(global const float *, paths) DO(global const float *, hits)                           \
    DO(global float *, radiance) DO(global float *, aov) SURFACE_PARAMETERS(DO) DO(global const float *, light_table)                                 \
    DO(global const float *, environment_texels) DO(global const uint *, parts)

EC_KERNEL(ec_shade_raster, LANES, SHADE_RASTER_PARAMETERS, slot_entries(path_count, i))
{
    uint wave = params->wave;
    geometry g = {prims, indices, normals, tangents, uvs, colors, materials, {texture_table, texels, srgb}, places};
    environment env = {params, environment_texels, 0};
    lane_u slot = LANE_NUMBERS + i;
    lane_i active = slot < path_count;
    v3 o = queue_load_v3(paths, wave, EC_PATH_OX, i), d = queue_load_v3(paths, wave, EC_PATH_DX, i), wo = v3_negate(d);
    lane_u prim = queue_load_u(hits, wave, EC_HIT_PRIM, i);
    lane_i found = active & (prim != EC_NO_ID);

    seen e = seen_surface(&g, found, prim, queue_load_f(hits, wave, EC_HIT_B1, i),
                          queue_load_f(hits, wave, EC_HIT_B2, i), wo, U(0));
    surface s = e.s;
    if (HAS(ANISOTROPY)) s.stretch = s.alpha_ggx < LEAST_ALPHA ? max(s.alpha_ggx * s.stretch / LEAST_ALPHA, F(1.0f)) : s.stretch;
    s.alpha_ggx = max(s.alpha_ggx, F(LEAST_ALPHA));
    s.smooth = !TRUE_MASK;
    if (HAS(CLEARCOAT)) {
        s.coat_alpha = max(s.coat_alpha, F(LEAST_ALPHA));
        s.coat_smooth = !TRUE_MASK;
    }
    bsdf b = bsdf_make(&s, surface_to_local(&s, wo), false);
    v3 direct = v3_zero();
    for (uint k = 0; (HAS(AREA_LIGHTS) || HAS(PUNCTUAL_LIGHTS)) && k < params->light_count; k++) {
        light_sample l = light_from_centre(light_table, k, &g, e.lit, s.p, params->scene_radius);
        lane_f pdf;
        v3 f = bsdf_eval(&b, surface_to_local(&s, l.wi), &pdf);
        direct = v3_add(direct, v3_select(l.valid & (v3_dot(s.ng, l.wi) > 0.0f), v3_mul(f, l.radiance), v3_zero()));
    }
    if (HAS(ENVIRONMENT)) {
        lane_f rest; /* The mean from everywhere reflects as albedo, here that of normal incidence. */
        v3 fresnel = HAS(SPECULAR) ? bsdf_fresnel(&b, F(1.0f), &rest) : v3_zero();
        v3 albedo = HAS(SPECULAR) ? v3_fma(b.base, rest, fresnel) : b.base;
        if (HAS(DIFFUSE_TRANSMISSION)) albedo = v3_fma(b.base, rest * (1.0f - b.diffuse_transmission), fresnel);
#define AMBIENT(feature, layer) \
    if (HAS(feature)) albedo = layer##_ambient(&b.layer, albedo);
        LAYERS_UP(AMBIENT)
        if (HAS(CLEARCOAT)) albedo = v3_fma(v3_splat(F(1.0f)), b.coat.share, v3_scale(albedo, 1.0f - b.coat.share));
        direct = v3_add(direct, light_ambient(params, albedo));
    }
    v3 out = v3_add(seen_background(&env, active & !found, d, !params->backdrop), e.glow);
    out = v3_add(out, v3_select(e.lit, direct, v3_zero()));
    radiance_add(radiance, wave, slot, out, active, invalid + EC_STAGE_SHADE);
    if (aov) {
        v3 way = v3_sub(s.p, o);
        store_features(aov, wave, slot, v3_select(found, s.base, v3_zero()), v3_select(found, s.ns, v3_zero()),
                       found ? sqrt(v3_dot(way, way)) : F(0.0f), found ? F(1.0f) : F(0.0f), mask_bits(active));
    }
    if (HAS(LAYERS)) store_surface_layers(params, radiance, parts, slot, prim, &e.h, &s, found);
}
