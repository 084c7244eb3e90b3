/* Shades what a light path meets: joins it to the camera, and continues it. Reads: path queue, hits, lights of the slots' paths. Writes: the shadow
 * queue (next: connect, splat), the pixels that its light goes to, the next path queue (next: intersect).
 * Values are those that a camera path has there, so at each vertex the surface is evaluated from both sides: for sampled directions it is
 * seen from the light (a), for values from the camera (c). A light path carries beta = Le / E * product of value |ng c| / (|ng a| pdf), and for
 * its weight (lib/light_path.h) E, in EC_PATH_K, and N / P at x_k-1, its first vertex, in EC_PATH_PDF: EC_HUGE before there is one, negative for
 * punctual lights. */
#include "../lib/bsdf.h"
#include "../lib/dispersion.h"
#include "../lib/film_point.h"
#include "../lib/guide.h"
#include "../lib/kernel.h"
#include "../lib/light_path.h"
#include "../lib/pane.h"
#include "../lib/roulette.h"
#include "../lib/shadow.h"
#include "../lib/terminator.h"

#define EC_NO_VERTEX 1e38f
#define EC_RATIO_LEAST 1e-30f

EC_FN lane_i agrees(const surface *s, v3 w, v3 w_local) { return v3_dot(s->ng, w) * w_local.z > 0.0f; }

#define SHADE_LIGHT_PARAMETERS(DO)                                                                                                                    \
    WAVE_PARAMETERS(DO) DO(volatile global ec_counters *, counters) DO(volatile global uint *, invalid) DO(global const float *, paths)               \
    DO(global const float *, hits) DO(global float *, next) DO(global float *, shadows) DO(global float *, light_slots)                               \
    DO(global const float *, filter) DO(global const float *, camera_keys) SURFACE_PARAMETERS(DO) DO(global const float *, motion)                    \
    DO(global const float *, times) DO(global const float *, light_table) DO(global const float *, environment_texels)                                \
    DO(global const uint *, environment_table) DO(global const float *, light_tree) DO(global const float *, lamp_parts)                              \
    DO(global const uint *, emission_table) DO(global float *, photons) DO(uint, path_count) DO(global const float *, guide_table)

EC_KERNEL(ec_shade_light, LANES, SHADE_LIGHT_PARAMETERS, QUEUED(at[step].rays))
{
    uint wave = params->wave;
    geometry g = {prims, indices, normals, tangents, uvs, colors, materials, {texture_table, texels, srgb}, places, motion};
    lights light = {light_table, 0, {params, environment_texels, environment_table}, light_tree, emission_table};
    const uint vertex = bounce & ~EC_LIGHT_BOUNCE;
    const bool alone = params->sample == EC_SAMPLE_LIGHT_PATHS; /* nothing else finds what light paths miss */

    lane_i active = LANE_NUMBERS < left;
    v3 o = queue_load_v3(paths, wave, EC_PATH_OX, i), d = queue_load_v3(paths, wave, EC_PATH_DX, i);
    v3 beta = queue_load_v3(paths, wave, EC_PATH_BR, i);
    lane_f ratio = queue_load_f(paths, wave, EC_PATH_PDF, i), e = queue_load_f(paths, wave, EC_PATH_K, i);
    lane_u slot = queue_load_u(paths, wave, EC_PATH_SLOT, i), prim = queue_load_u(hits, wave, EC_HIT_PRIM, i);
    slot = active ? slot : U(0);
    if (HAS(MOTION) && motion) g.time = gather_f(times, slot);
    g.parts = lamp_parts;
    lane_i found = active & (prim != EC_NO_ID);
    if (!any_lane(found)) return;
    v3 a = v3_negate(d), source = o;
    if (HAS(PANES) && vertex) source = queue_load_v3(paths, wave, EC_PATH_SX, i);

    prim = found ? prim : U(0);
    hit_point h = hit_point_make(&g, prim, queue_load_f(hits, wave, EC_HIT_B1, i), queue_load_f(hits, wave, EC_HIT_B2, i));
    bool nested = MEDIA_NESTED(params);
    surface sa;
    surface_place(&h, a, &sa);
    surface_frame(&g, &h, found, a, &sa);
    if (nested) sa.bodies = found ? queue_load_u(paths, wave, EC_PATH_MEDIUM, i) : U(0);
    surface_material(&g, &h, found, &sa);
    lane_u flags = as_lane_u(material_quad(&g, &h, EC_WORD_emission).d), medium = U(EC_NO_ID);
    if (HAS_MEDIUM) medium = medium_of(&h, &sa, found, queue_load_u(paths, wave, EC_PATH_MEDIUM, i), nested);
    if (HAS(ABSORPTION)) {
        v3 way = v3_sub(sa.p, o);
        beta = v3_mul(beta, medium_transmittance(&g, medium_material(&g, medium, nested), sqrt(v3_dot(way, way))));
    }
    lane_i scatters = found;
    if (HAS(UNLIT)) scatters = scatters & ((flags & EC_MATERIAL_UNLIT) == 0u);
    if (vertex + 2 > params->max_depth || !any_lane(scatters)) return;

    lane_u path, sample, r1, r2;
    slot_to_pixel(params, first_pixel, 0, slot, &path, &sample);
    sampler random = light_path_sampler(seed, path, sample);
    uint pair = EC_PAIR_BOUNCE(vertex);
    lane_f u_survives, u_pass, u1, u2, unused;
    sample_pair(random, pair + EC_PAIR_ROULETTE, &u_survives, &u_pass);
    if (HAS(DISPERSION)) disperse(&g, &h, scatters, &u_pass, &sa, &beta);
    bsdf ba = bsdf_make(&sa, surface_to_local(&sa, a), params->multiple != 0u);
    sample_pair_u(random, pair + EC_PAIR_BSDF, &r1, &r2);
    bsdf_direction way_on = bsdf_sample(&ba, false, to_unit(r1), chooser_make(r2), u_pass);
    lane_i single = way_on.pdf < 0.0f, below = way_on.wi.z < 0.0f, straight = single & below & pane_is(&ba, flags);

    const bool records = HAS(GUIDING) && photons;
    if (records && vertex && vertex <= EC_PHOTON_VERTICES) {
        /* Camera paths cannot find what comes from a point by way of a mirror. */
        lane_i counts = scatters & !bsdf_is_single(&ba) & ((ratio >= 0.0f) | (ratio < -EC_RATIO_LEAST));
        lane_u at = ((vertex - 1u) * path_count + slot) * EC_PHOTON_WORDS;
        uint bits = mask_bits(counts);
        scatter_f(photons, at + EC_PHOTON_X, sa.p.x, bits);
        scatter_f(photons, at + EC_PHOTON_Y, sa.p.y, bits);
        scatter_f(photons, at + EC_PHOTON_Z, sa.p.z, bits);
        scatter_f(photons, at + EC_PHOTON_DX, a.x, bits);
        scatter_f(photons, at + EC_PHOTON_DY, a.y, bits);
        scatter_f(photons, at + EC_PHOTON_DZ, a.z, bits);
        scatter_f(photons, at + EC_PHOTON_FLUX, luminance(beta), bits);
    }

    sample_pair_u(random, pair + EC_PAIR_LIGHT, &r1, &r2);
    u1 = to_unit(r1);
    u2 = to_unit(r2);
    camera_axes axes = camera_axes_make(params);
    if (HAS(MOTION) && motion && camera_keys) axes = camera_axes_at(camera_keys, motion, g.time);
    film_point film = film_point_of(params, &axes, filter, sa.p, u1, u2, to_unit(hash_u(r1)), to_unit(hash_u(r2)));

    /* N at the first vertex. */
    lane_i is_first = fabs(ratio) > EC_NO_VERTEX, is_delta = ratio < 0.0f;
    lane_f n_joined = F(0.0f), e_here = e, window = F(1.0f);
    if (any_lane(scatters & is_first)) {
        lane_u id = as_lane_u(gather_f(light_slots + EC_LIGHT_SLOT_LIGHT * wave, slot));
        v3 between = v3_sub(sa.p, source);
        n_joined = light_path_joined_pdf(&light, &g, scatters & is_first, id, gather_f(light_slots + EC_LIGHT_SLOT_B1 * wave, slot),
                                         gather_f(light_slots + EC_LIGHT_SLOT_B2 * wave, slot), sa.p, source, d);
        if (HAS(PUNCTUAL_LIGHTS)) {
            light_record one = light_load(&light, scatters & is_first ? id : U(0));
            lane_u type = one.kind & EC_LIGHT_KIND_MASK;
            lane_i near = is_first & ((type == EC_KIND_POINT) | (type == EC_KIND_SPOT));
            lane_f way2 = v3_dot(between, between);
            e_here = near ? e / way2 : e;
            window = near ? light_range_window(&one, way2) : window;
        }
    }

    EC_LOOP
    for (uint turn = records ? 1u : 0u; turn < 2; turn++) {
        bool joins = turn == 0;
        v3 c = joins ? film.to_camera : surface_to_world(&sa, way_on.wi);
        lane_i m = scatters & (joins ? film.seen & (alone ? TRUE_MASK : !is_first) : way_on.pdf != 0.0f);
        if (!any_lane(m) || (!joins && vertex + 3 > params->max_depth)) continue;
        surface s;
        v3 beta_c = joins ? v3_scale(beta, window) : v3_scale(beta, straight ? F(1.0f) : window);
        surface_place(&h, c, &s);
        surface_frame(&g, &h, m, c, &s);
        lane_i crosses = v3_dot(sa.ng, c) < 0.0f;
        if (nested) s.bodies = (crosses & sa.refracts) ? sa.beyond : sa.bodies;
        surface_material(&g, &h, m, &s);
        unused = F(0.5f);
        if (HAS(DISPERSION)) disperse(&g, &h, m, &unused, &s, &beta_c);
        v3 c_local = surface_to_local(&s, c), a_local = surface_to_local(&s, a);
        bsdf b = bsdf_make(&s, c_local, params->multiple != 0u);
        lane_f pdf;
        v3 value = bsdf_eval(&b, a_local, &pdf);
        lane_i scatters_so = pdf > 0.0f;
        if (HAS(GUIDING) && guide_table) {
            guide guided = guide_at(guide_table, m, s.p, &b);
            pdf = guide_mix(&guided, pdf, a);
        }
        lane_i lifted = !TRUE_MASK;
        if (HAS(TERMINATOR) && params->terminator && normals) (void)terminator_origin(&g, &h, &s, &lifted);
        lane_i misses = light_path_misses(&s, a, c_local.z, a_local.z, lifted) & (alone ? !TRUE_MASK : TRUE_MASK);
        lane_i good = agrees(&s, a, a_local) & agrees(&s, c, c_local);
        lane_f turn_cosines = fabs(v3_dot(s.ng, c)) / fabs(v3_dot(s.ng, a));
        lane_f n_over_p = min(n_joined / pdf, F(EC_K_MOST));
        if (joins) {
            m = m & good & !misses & scatters_so;
            if (HAS(CULLING)) {
                lane_u prim_flags = as_lane_u(gather_f(prims, geometry_prim(&g, prim) * EC_PRIM_WORDS + 11u));
                m = m & (s.front | ((prim_flags & EC_PRIM_SINGLE_SIDED) == 0u));
            }
            lane_f kappa = F(params->light_paths), area = film.area;
            lane_f t_over_p = e_here * min(kappa * area / (turn_cosines * pdf), F(EC_K_MOST));
            lane_f np = fabs(ratio) / t_over_p, pp = is_delta ? F(0.0f) : 1.0f / t_over_p;
            lane_f weight = alone ? F(1.0f) : 1.0f / fma(np, np, fma(pp, pp, F(1.0f)));
            v3 arriving = v3_scale(v3_mul(beta_c, value), turn_cosines * weight * film.weight / (area * kappa));
            shadow_way way = {U(params->camera_medium), v3_splat(F(1.0f)), !TRUE_MASK};
            if (HAS(ABSORPTION)) {
                lane_u near = (s.refracts & !s.front) ? h.material : U(params->camera_medium);
                near = nested ? s.bodies : near;
                way.left = medium_transmittance(&g, medium_material(&g, near, nested), sqrt(film.way2));
            }
            scatter_f(light_slots + EC_LIGHT_SLOT_PIXEL * wave, slot, as_lane_f(film.place), mask_bits(m));
            shadow_push(params, shadows, counters->at[step].shadows, row, film.o, surface_offset(s.p, s.p_error, s.ng, c), arriving, slot,
                        U(EC_NO_ID), prim, &way, m, invalid + EC_STAGE_SHADE);
            continue;
        }
        v3 factor = v3_scale(value, turn_cosines / way_on.pdf);
        if (HAS(SMOOTH)) {
            v3 passing = bsdf_passing(&b, a_local.z), passing_a = bsdf_passing(&ba, way_on.wi.z);
            lane_f per_chance = v3_max_component(way_on.weight) / v3_max_component(passing_a);
            v3 alone = v3_select(below, v3_scale(passing, per_chance), way_on.weight);
            lane_f cosines = turn_cosines * fabs(a_local.z) / fabs(c_local.z) * ((s.refracts & below) ? s.eta * s.eta : F(1.0f));
            factor = v3_select(single, v3_scale(alone, cosines), factor);
            if (HAS(TRANSMISSION)) good = good & (!single | !below | (b.facets.smooth != 0));
            good = good & (straight | !single | !(s.bent | sa.bent)); /* mirrored at two normals: c does not lead to a */
        }
        v3 before = beta_c;
        beta_c = v3_mul(beta_c, factor);
        lane_i alive = m & good & (straight | !misses) & (single | scatters_so);
        lane_i finite = v3_is_finite(beta_c);
        uint bad = mask_bits(alive & !finite);
        if (bad) atomic_add(invalid + EC_STAGE_SHADE, popcount(bad));
        alive = alive & finite & (v3_max_component(beta_c) > 0.0f);
        if (roulette_plays(params, vertex + 1, true)) {
            lane_f survival = roulette_survival(min(v3_max_component(beta_c) / v3_max_component(before), F(1.0f)), params->survival);
            alive = alive & (u_survives < survival);
            beta_c = v3_scale(beta_c, 1.0f / survival);
        }
        uint bits = mask_bits(alive);
        if (!bits) return;
        lane_f np = single ? F(0.0f) : n_over_p;
        np = is_delta ? -max(np, F(EC_RATIO_LEAST)) : np;
        np = (is_first & !straight) ? np : ratio;
        v3 origin = surface_offset(s.p, s.p_error, s.ng, c);
        uint at = queue_reserve(counters->at[step + 1].rays, params->part, row, bits);
        queue_push_v3(next, wave, EC_PATH_OX, at, origin, bits);
        queue_push_v3(next, wave, EC_PATH_DX, at, c, bits);
        queue_push_v3(next, wave, EC_PATH_BR, at, beta_c, bits);
        queue_push_v3(next, wave, EC_PATH_SX, at, v3_select(straight, source, origin), bits);
        queue_push_f(next, wave, EC_PATH_PDF, at, np, bits);
        queue_push_f(next, wave, EC_PATH_SLOT, at, as_lane_f(slot), bits);
        queue_push_f(next, wave, EC_PATH_PRIM, at, as_lane_f(prim), bits);
        queue_push_f(next, wave, EC_PATH_MEDIUM, at,
                     as_lane_f(HAS_MEDIUM ? medium_towards(&h, &sa, medium, way_on.wi.z, nested) : U(EC_NO_ID)), bits);
        queue_push_f(next, wave, EC_PATH_K, at, straight ? e : e_here * light_path_turn(&s, c, a, c_local.z, a_local.z), bits);
    }
}
