/* Starts light paths: chooses a caster, a light, a point on it and a direction to the caster (lib/light_path.h), or one of the light's emission where
 * only light paths count; for a far light, its direction and a point of the caster's disk. Reads: params, lights. Writes: the path queue, with those
 * that carry light; the light and point of each slot's path, and zeroes the slots' radiance. Next: intersect. Slots are numbered as those of camera
 * rays, with light paths in the place of pixels. */
#include "../lib/coplanar.h"
#include "../lib/film.h"
#include "../lib/kernel.h"
#include "../lib/light_path.h"
#include "../lib/medium.h"

#define EMIT_PARAMETERS(DO)                                                                                                                           \
    DO(uint, seed) DO(uint, first_pixel) DO(uint, path_count) DO(volatile global ec_counters *, counters) DO(volatile global uint *, invalid)         \
    DO(global float *, paths) DO(global float *, radiance) DO(global float *, light_slots) SURFACE_PARAMETERS(DO) DO(global const float *, motion)    \
    DO(global float *, times) DO(global const float *, light_table) DO(global const float *, environment_texels)                                      \
    DO(global const uint *, environment_table) DO(global const uint *, emission_table) DO(global const uint *, coplanar)

EC_KERNEL(ec_emit, LANES, EMIT_PARAMETERS, slot_entries(path_count, i))
{
    uint wave = params->wave, count = params->light_count;
    geometry g = {prims, indices, normals, tangents, uvs, colors, materials, {texture_table, texels, srgb}, places, motion};
    lights light = {light_table, 0, {params, environment_texels, environment_table}, 0, emission_table};
    const bool all_around = params->sample == EC_SAMPLE_LIGHT_PATHS;
    lane_u slot = LANE_NUMBERS + i, path, sample, r1, r2, first, share;
    lane_i active = LANE_NUMBERS < left;
    slot_to_pixel(params, first_pixel, 0, slot, &path, &sample);
    sampler random = light_path_sampler(seed, path, sample);
    lane_f u_caster, unused, u3, u4;
    if (HAS(MOTION) && motion) {
        sample_pair(random, EC_PAIR_TIME, &g.time, &unused);
        queue_store_f(times, wave, 0, i, g.time);
    }
    queue_store_v3(radiance, wave, 0, i, v3_zero());

    sample_pair(random, EC_PAIR_CASTER, &u_caster, &unused);
    v3 centre = caster_centre(params, 0);
    lane_f radius = F(params->casters[0][3]);
    float before = params->caster_share[0];
    EC_LOOP
    for (uint j = 1; j < params->caster_count; j++) {
        lane_i is = u_caster >= before;
        centre = v3_select(is, caster_centre(params, j), centre);
        radius = is ? F(params->casters[j][3]) : radius;
        before += params->caster_share[j];
    }
    sample_pair_u(random, EC_PAIR_PIXEL, &r1, &r2);
    lane_u id = distribution_pick(emission_table, U(0), count, r1, &first, &share);
    lane_f u1 = choice_rest(r1 - first, share, r1), u2 = to_unit(r2);
    sample_pair_u(random, EC_PAIR_LENS, &r1, &r2);
    u3 = to_unit(r1);
    u4 = to_unit(r2);
    light_record one = light_load(&light, id);
    if (HAS(MOTION) && motion) light_move(&g, &one);
    lane_u type = one.kind & EC_LIGHT_KIND_MASK;

    v3 o = v3_zero(), d = v3_zero(), Le = v3_zero();
    lane_f e = F(0.0f), b1 = F(0.0f), b2 = F(0.0f);
    if (HAS(AREA_LIGHTS)) {
        lane_i is = active & (type == EC_KIND_TRIANGLE);
        if (any_lane(is)) {
            lane_f root = sqrt(u1);
            b1 = u2 * root;
            b2 = root - b1;
            lane_f b0 = 1.0f - b1 - b2;
            v3 q = v3_fma(one.c, b2, v3_fma(one.b, b1, v3_scale(one.a, b0)));
            v3 sum = v3_fma(v3_abs(one.c), b2, v3_fma(v3_abs(one.b), b1, v3_scale(v3_abs(one.a), b0)));
            v3 n = v3_normalize(v3_cross(v3_sub(one.b, one.a), v3_sub(one.c, one.a)));
            lane_i both_sides = (one.kind & EC_LIGHT_TWO_SIDED) != 0u;
            lane_f per_cosine, per_area = motion_per_area(one.a, one.b, one.c);
            d = all_around ? lamp_direction(n, both_sides, u3, u4, &per_cosine) : aim_sample(centre, radius, q, u3, u4);
            lane_f cosine = v3_dot(n, d);
            is = is & ((cosine > 0.0f) | both_sides);
            Le = v3_select(is, light_radiance(&one, &g, is, b1, b2, v3_negate(d)), Le);
            e = all_around ? (is ? emission_pmf(&light, is ? id : U(0)) * per_area * per_cosine : F(0.0f))
                           : emission_lamp(&light, is, id, per_area, q, d, fabs(cosine));
            o = surface_offset(q, v3_scale(sum, F(EC_GAMMA(9))), n, d);
            if (HAS_COPLANAR) {
                hit_filter filter = {g, filter_key(seed, path, sample, 0, true), false, 0};
                ray back = ray_make(o, v3_negate(d), params->scene_max);
                e = coplanar_hides(coplanar, &filter, &back, is, one.prim, U(EC_NO_ID)) ? F(0.0f) : e;
            }
        }
    }
    if (HAS(PUNCTUAL_LIGHTS)) {
        lane_i is = active & (type >= EC_KIND_POINT) & (type <= EC_KIND_DIRECTIONAL), far = is & (type == EC_KIND_DIRECTIONAL);
        lane_f pdf;
        v3 along = all_around ? punctual_direction(&one, u3, u4, &pdf) : aim_sample(centre, radius, one.a, u3, u4);
        along = v3_select(far, one.b, along);
        o = v3_select(is, v3_select(far, aim_far_origin(params, centre, radius, one.b, u3, u4), one.a), o);
        d = v3_select(is, along, d);
        lane_f near_e = emission_pmf(&light, id) * (all_around ? pdf : aim_pdf(params, o, d));
        e = is ? (far ? emission_far(&light, id, F(1.0f), o, d) : near_e) : e;
        Le = v3_select(is, v3_scale(one.emission, far ? F(1.0f) : light_falloff(&one, v3_dot(d, one.b))), Le);
    }
    if (HAS(ENVIRONMENT)) {
        lane_i is = active & (type == EC_KIND_ENVIRONMENT);
        if (any_lane(is)) {
            lane_f pdf;
            v3 found, wi = environment_sample(&light.env, r1, r2, &pdf, &found), down = v3_negate(wi);
            v3 from = aim_far_origin(params, centre, radius, down, u1, u2);
            o = v3_select(is, from, o);
            d = v3_select(is, down, d);
            Le = v3_select(is, found, Le);
            e = is ? emission_environment(&light, pdf, from, down) : e;
        }
    }
    v3 beta = v3_scale(Le, 1.0f / e);
    lane_i alive = active & (e > 0.0f) & (v3_max_component(Le) > 0.0f), finite = v3_is_finite(beta);
    uint bad = mask_bits(alive & !finite), bits = mask_bits(alive & finite);
    if (bad) atomic_add(invalid + EC_STAGE_GENERATE, popcount(bad));
    queue_store_f(light_slots, wave, EC_LIGHT_SLOT_LIGHT, i, as_lane_f(id));
    queue_store_f(light_slots, wave, EC_LIGHT_SLOT_B1, i, b1);
    queue_store_f(light_slots, wave, EC_LIGHT_SLOT_B2, i, b2);
    if (!bits) return;
    uint at = queue_reserve(counters->at[0].rays, params->part, row, bits);
    lane_i is_delta = (type >= EC_KIND_POINT) & (type <= EC_KIND_DIRECTIONAL);
    queue_push_v3(paths, wave, EC_PATH_OX, at, o, bits);
    queue_push_v3(paths, wave, EC_PATH_DX, at, d, bits);
    queue_push_v3(paths, wave, EC_PATH_BR, at, beta, bits);
    queue_push_f(paths, wave, EC_PATH_PDF, at, F(EC_HUGE) * (is_delta ? F(-1.0f) : F(1.0f)), bits);
    queue_push_f(paths, wave, EC_PATH_SLOT, at, as_lane_f(slot), bits);
    queue_push_f(paths, wave, EC_PATH_PRIM, at, as_lane_f(type == EC_KIND_TRIANGLE ? one.prim : U(EC_NO_ID)), bits);
    queue_push_f(paths, wave, EC_PATH_MEDIUM, at, as_lane_f(U(MEDIA_NESTED(params) ? 0u : EC_NO_ID)), bits);
    queue_push_v3(paths, wave, EC_PATH_SX, at, o, bits);
    queue_push_f(paths, wave, EC_PATH_K, at, e, bits);
}
