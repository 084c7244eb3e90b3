/* Shades what a ray found: adds emission or environment, samples one light and one direction, plays roulette.
 * Reads: path queue and hits. Writes: radiance of the slots, the shadow queue (next: connect), the next path queue (next:
 * intersect), first-hit features at bounce 0 where asked for. Every path either ends here or is pushed once. */
#include "../lib/bsdf.h"
#include "../lib/dispersion.h"
#include "../lib/features.h"
#include "../lib/film.h"
#include "../lib/group_hits.h"
#include "../lib/guide.h"
#include "../lib/kernel.h"
#include "../lib/light_path.h"
#include "../lib/motion_vector.h"
#include "../lib/pane.h"
#include "../lib/roulette.h"
#include "../lib/scatter.h"
#include "../lib/shadow.h"
#include "../lib/terminator.h"

/* Returns the MIS weight of light that a path meets, against light_pdf; 1 where light sampling cannot find it or is not used. by_light: density of
 * light paths over that of this path. */
EC_FN lane_f found_weight(uint sample, lane_f path_pdf, lane_f light_pdf, lane_f by_light)
{
    lane_i sampled = (path_pdf >= 0.0f) & (light_pdf > 0.0f);
    if (HAS(LIGHT_PATHS)) {
        lane_f r = sampled ? light_pdf / path_pdf : F(0.0f);
        if (sample == EC_SAMPLE_MIS) return 1.0f / fma(r, r, fma(by_light, by_light, F(1.0f)));
    }
    if (sample == EC_SAMPLE_MIS) return sampled ? mis_weight(path_pdf, light_pdf) : F(1.0f);
    if (sample == EC_SAMPLE_LIGHT) return sampled ? F(0.0f) : F(1.0f);
    return F(1.0f);
}

/* Returns the weight of light that a shadow ray joins to, the complement of found_weight. by_light: density of light paths. */
EC_FN lane_f joined_weight(uint sample, const light_sample *l, lane_f path_pdf, lane_f by_light)
{
    lane_f weight = F(sample == EC_SAMPLE_LIGHT ? 1.0f : 0.0f);
    if (HAS(LIGHT_PATHS) && sample == EC_SAMPLE_MIS) {
        lane_f p = l->is_delta ? F(0.0f) : path_pdf / l->pdf, t = by_light / l->pdf;
        return 1.0f / fma(p, p, fma(t, t, F(1.0f)));
    }
    if (sample == EC_SAMPLE_MIS) weight = mis_weight(l->pdf, path_pdf);
    return l->is_delta ? F(1.0f) : weight;
}

/* Returns the lanes whose direction is on the same side of facet and shading normal, which shading normals can separate. A ray that starts above the
 * facet may dip below its plane. */
EC_FN lane_i same_side(const surface *s, v3 w, v3 w_local, lane_i lifted)
{
    return (v3_dot(s->ng, w) * w_local.z > 0.0f) | (lifted & (w_local.z > 0.0f));
}

/* Returns a ray's origin: above the surface, or below it where the ray passes. */
EC_FN v3 leave(const surface *s, v3 above, v3 w, v3 w_local)
{
    if (!HAS_PASSING) return above;
    return v3_select(w_local.z < 0.0f, surface_offset(s->p, s->p_error, s->ng, w), above);
}

/* Returns the triangle that a ray need not be tested against: its own, unless the ray dips below it. */
EC_FN lane_u left_behind(const surface *s, v3 w, lane_i lifted, lane_u prim)
{
    return HAS(TERMINATOR) ? ((lifted & (v3_dot(s->ng, w) < 0.0f)) ? U(EC_NO_ID) : prim) : prim;
}

#define SHADE_PARAMETERS(DO)                                                                                                                          \
    WAVE_PARAMETERS(DO) DO(volatile global ec_counters *, counters) DO(volatile global uint *, invalid) DO(global const float *, paths)               \
    DO(global const float *, hits) DO(global float *, next) DO(global float *, shadows) DO(global float *, radiance) DO(global float *, aov)          \
    SURFACE_PARAMETERS(DO) DO(global const float *, motion) DO(global const float *, times) DO(global const float *, light_table)                     \
    DO(global const uint *, light_shares) DO(global const float *, environment_texels) DO(global const uint *, environment_table)                     \
    DO(global const float *, light_tree) DO(global const uint *, light_trails) DO(global const float *, lamp_parts)                                   \
    DO(global const uint *, emission_table) DO(global const float *, guide_table) DO(global const uint *, light_groups)                               \
    DO(global const uint *, parts) DO(global const float *, camera_keys)

#define SHADE_GEOMETRY {prims, indices, normals, tangents, uvs, colors, materials, {texture_table, texels, srgb}, places, motion}

/* Shades a packet of the queue; left: entries from its first on. */
EC_INLINED void shade_packet(uint row, const queue_packet *q, uint left, constant ec_params *params SHADE_PARAMETERS(EC_PARAMETER))
{
    uint wave = params->wave;
    geometry g = SHADE_GEOMETRY;
    lights light = {light_table, light_shares, {params, environment_texels, environment_table}, light_tree, emission_table};
    const bool by_light = HAS(LIGHT_PATHS) && params->light_paths > 0.0f && params->sample == EC_SAMPLE_MIS;
    bool only_seen = false; /* paths go on through panes alone */
    if (HAS(LIGHT_PATHS)) only_seen = params->sample == EC_SAMPLE_LIGHT_PATHS;

    lane_i active = LANE_NUMBERS < left;
    v3 o = packet_load_v3(paths, wave, EC_PATH_OX, q), d = packet_load_v3(paths, wave, EC_PATH_DX, q);
    v3 beta = packet_load_v3(paths, wave, EC_PATH_BR, q);
    lane_f path_pdf = packet_load_f(paths, wave, EC_PATH_PDF, q);
    lane_u slot = packet_load_u(paths, wave, EC_PATH_SLOT, q), prim = packet_load_u(hits, wave, EC_HIT_PRIM, q);
    slot = active ? slot : U(0);
    if (HAS(MOTION) && motion) g.time = gather_f(times, slot);
    g.parts = lamp_parts;
    lane_i ends = !TRUE_MASK, beside = !TRUE_MASK; /* rays to lamps' edges, and paths that have such rays */
    if (HAS(EMISSION) && bounce == 0u && params->edge_numbers) {
        ends = path_pdf == F(EC_PDF_ENDS);
        beside = path_pdf == F(EC_PDF_BESIDE);
        path_pdf = F(-1.0f);
    }
    lane_i found = active & (prim != EC_NO_ID);
    v3 wo = v3_negate(d);
    lane_f k = F(0.0f);
    if (by_light) k = packet_load_f(paths, wave, EC_PATH_K, q);

    v3 emitted = v3_zero();
    lane_i emits = !TRUE_MASK;
    if (HAS(ENVIRONMENT) && (bounce || !params->backdrop)) {
        lane_i missed = active & !found;
        if (any_lane(missed)) {
            lane_f pdf;
            v3 Le = environment_look_up(&light.env, d, &pdf);
            lane_f share = F(0.0f);
            if (by_light && any_lane(missed & k_is_joined(k))) share = k_is_joined(k) ? k * emission_environment(&light, pdf, o, wo) : F(0.0f);
            emitted = v3_scale(Le, found_weight(params->sample, path_pdf, pdf, share));
            emits = missed & !ends;
        }
    }

    prim = found ? prim : U(0);
    hit_point h = hit_point_make(&g, prim, packet_load_f(hits, wave, EC_HIT_B1, q),
                                 packet_load_f(hits, wave, EC_HIT_B2, q));
    surface s;
    surface_place(&h, wo, &s);
    surface_frame(&g, &h, found, wo, &s);
    bool nested = MEDIA_NESTED(params);
    if (nested) s.bodies = found ? packet_load_u(paths, wave, EC_PATH_MEDIUM, q) : U(0);
    surface_material(&g, &h, found, &s);
    quad emission = material_quad(&g, &h, EC_WORD_emission);
    lane_u flags = as_lane_u(emission.d), medium = U(EC_NO_ID);
    if (HAS_MEDIUM) medium = medium_of(&h, &s, found, packet_load_u(paths, wave, EC_PATH_MEDIUM, q), nested);
    lane_i strewn = !TRUE_MASK; /* scattered before the surface was met */
    scattering event;
    if (HAS(ABSORPTION)) {
        v3 way = v3_sub(s.p, o);
        lane_u filled = medium_material(&g, medium, nested);
        lane_f length = sqrt(v3_dot(way, way));
        if (HAS(SCATTERING)) {
            lane_u x, y;
            lane_f u1, u2;
            slot_to_pixel(params, first_pixel, pixel_list, slot, &x, &y);
            sample_pair(sampler_make(seed, x, y), EC_PAIR_MEDIUM(bounce), &u1, &u2);
            length = found ? length : F(EC_HUGE);
            stretch along = stretch_make(params, &g, filled, active & medium_is_air(medium, nested), o, d, length);
            event = scatter_along(&along, o, d, &s, found, length, u1, u2, &beta);
            strewn = active & event.m;
            emits = emits & !strewn; /* the environment, behind fog */
        } else beta = v3_mul(beta, medium_transmittance(&g, filled, length));
    }
    lane_i met = found & !strewn;

    v3 source = o; /* where light was last sampled */
    if (HAS(PANES) && bounce) source = packet_load_v3(paths, wave, EC_PATH_SX, q);
    if (HAS(EMISSION)) {
        lane_i m = met & !beside & ((flags & EC_MATERIAL_EMISSIVE) != 0u) &
                   (s.front | ((flags & EC_MATERIAL_DOUBLE_SIDED) != 0u));
        if (any_lane(m)) {
            v3 way = v3_sub(s.p, source);
            if (HAS(LIGHT_TREE) && light_tree) {
                lane_u lamp = HAS(INSTANCES) ? (h.placed ? U(0) : prim) : prim; /* no instance is a lamp, and its id lies behind the trails */
                h.light_pdf_a *= light_tree_pmf(&light, m & (path_pdf >= 0.0f) & (h.light_pdf_a > 0.0f), source,
                                                params->light_tree_numbers, gather_u(light_trails, lamp));
            }
            if (HAS(LAMP_PAIRS) && light_trails && !light_tree)
                h.light_pdf_a *= pair_found_chance(&light, light_trails, &h, m & (path_pdf >= 0.0f) & !h.placed, prim, source);
            h.light_pdf_a *= light_share_of_lamp(params);
            lane_f pdf = light_found_pdf(&g, &h, m, source, v3_dot(way, way), fabs(v3_dot(s.ng, wo)));
            v3 Le = coat_emission(&g, &h, m, wo, surface_emission(&g, &h, m, emission));
            lane_f share = F(0.0f);
            lane_i known = m & k_is_joined(k) & !h.placed;
            if (by_light && any_lane(known)) {
                lane_u id = emission_light(&light, known ? prim : U(0));
                known = known & (id != EC_NO_ID);
                share = k * emission_lamp(&light, known, id, motion_per_area(h.p0, h.p1, h.p2), s.p, wo, fabs(v3_dot(s.ng, wo)));
            }
            Le = v3_scale(Le, found_weight(params->sample, path_pdf, pdf, known ? share : F(0.0f)));
            emitted = v3_select(m, Le, emitted);
            emits = emits | m;
        }
    }
    lane_i scatters = met & !ends;
    strewn = strewn & !ends;
    if (HAS(UNLIT)) {
        lane_i m = scatters & ((flags & EC_MATERIAL_UNLIT) != 0u);
        emitted = v3_select(m, s.base, emitted);
        emits = emits | m;
        scatters = scatters & !m;
    }
    if (any_lane(emits)) {
        radiance_add(radiance_of(params, radiance, bounce + 1), wave, slot, v3_mul(beta, emitted), emits, invalid + EC_STAGE_SHADE);
        if (HAS(LAYERS)) {
            lane_u group = U(0);
            if (light_groups) group = gather_u(light_groups, found ? divide(h.material, EC_MATERIAL_WORDS) + (1u + params->light_count) : U(0));
            layers_add(params, radiance, bounce + 1, slot, group, v3_mul(beta, emitted), emits);
        }
    }

    if (aov && bounce == 0) {
        v3 seen = v3_sub(s.p, o);
        lane_f depth = sqrt(v3_dot(seen, seen));
        store_features(aov, wave, slot, v3_select(found, s.base, v3_zero()), v3_select(found, s.ns, v3_zero()),
                       found ? depth : F(0.0f), found ? F(1.0f) : F(0.0f), mask_bits(active));
    }
    if (HAS(LAYERS) && bounce == 0) store_surface_layers(params, radiance, parts, slot, prim, &h, &s, found);
    if (HAS(LAYERS) && HAS(MOTION) && motion && bounce == 0 && params->layer_of[EC_LAYER_MOTION])
        store_motion_vector(params, radiance, motion, camera_keys, slot, &h, prim, d, active, found);
    /* This vertex ends segment bounce + 1; light sampled here would arrive over segment bounce + 2. */
    if (bounce + 2 > params->max_depth || !any_lane(scatters | strewn) || (only_seen && !HAS(PANES))) return;

    lane_u pixel, sample;
    slot_to_pixel(params, first_pixel, pixel_list, slot, &pixel, &sample);
    sampler random = sampler_make(seed, pixel, sample);
    uint pair = EC_PAIR_BOUNCE(bounce);
    lane_u r1, r2;
    lane_f u_survives = F(0.0f), u_pass = F(0.0f);
    bool roulette = roulette_plays(params, bounce + 1, false);
    if (HAS(TRANSMISSION)) sample_pair(random, pair + EC_PAIR_ROULETTE, &u_survives, &u_pass);
    if (HAS(DISPERSION)) disperse(&g, &h, scatters, &u_pass, &s, &beta);
    bsdf b = bsdf_make(&s, surface_to_local(&s, wo), params->multiple != 0u);

    /* Reflected rays start at `above`. Lights are sampled from there, so that a path that meets one finds the same density. */
    lane_i lifted = !TRUE_MASK;
    v3 start = HAS(TERMINATOR) && params->terminator && normals ? terminator_origin(&g, &h, &s, &lifted) : s.p;
    v3 above = surface_offset(start, s.p_error, s.ng, wo);
    if (HAS(SCATTERING)) { /* a scattering event has no surface to be above or to leave */
        above = v3_select(strewn, event.p, above);
        lifted = lifted | strewn;
        prim = strewn ? U(EC_NO_ID) : prim;
    }

    lane_f way2 = F(0.0f), wo_z = b.wo.z;
    if (by_light) {
        v3 way = v3_sub(s.p, source);
        way2 = v3_dot(way, way);
    }
    const bool guides = HAS(GUIDING) && guide_table;
    guide guided;
    if (guides) guided = guide_at(guide_table, scatters, s.p, &b);
    lane_i joins = (scatters & !bsdf_is_single(&b)) | strewn; /* no light sample lies in a mirror's one direction */
    if ((HAS(AREA_LIGHTS) || HAS(PUNCTUAL_LIGHTS) || HAS(ENVIRONMENT)) && params->light_count && !only_seen && any_lane(joins)) {
        lane_f pdf_bsdf;
        sample_pair_u(random, pair + EC_PAIR_LIGHT, &r1, &r2);
        light_sample l = light_sample_one(&light, &g, joins, above, r1, r2);
        v3 wi_local = surface_to_local(&s, l.wi);
        v3 f = bsdf_eval(&b, wi_local, &pdf_bsdf);
        lane_f share = F(0.0f);
        if (HAS(SCATTERING)) {
            lane_f phase = phase_value(event.g, d, l.wi);
            f = v3_select(strewn, v3_splat(phase), f);
            pdf_bsdf = strewn ? phase : pdf_bsdf;
            wi_local.z = strewn ? F(1.0f) : wi_local.z;
        }
        lane_i scatters_there = pdf_bsdf > 0.0f;
        if (guides) pdf_bsdf = guide_mix(&guided, pdf_bsdf, l.wi);
        if (by_light && any_lane(joins & (k > 0.0f))) {
            lane_f k_here = light_path_k(params, &s, k, way2, wo, l.wi, wo_z, wi_local.z, pdf_bsdf, lifted, !TRUE_MASK);
            share = k_is_joined(k_here) ? k_here * pdf_bsdf * emission_sampled(&light, &l, joins, above) : F(0.0f);
        }
        lane_f weight = joined_weight(params->sample, &l, pdf_bsdf, share);
        v3 arriving = v3_mul(v3_mul(beta, f), v3_scale(l.radiance, weight / l.pdf));
        lane_u between = HAS_MEDIUM ? medium_towards(&h, &s, medium, wi_local.z, nested) : medium;
        shadow_way way = shadow_way_make(params, &g, &l, between, nested, above);
        lane_u group = U(0);
        if (HAS(LAYERS) && light_groups) group = gather_u(light_groups, l.id + 1u);
        /* A lamp that passes light does not shine on itself: seen from just above, its triangle fills the hemisphere below. */
        lane_i m = l.valid & scatters_there & same_side(&s, l.wi, wi_local, lifted) & !(scatters & (l.target == prim));
        shadow_push(params, shadows, counters->at[step].shadows, row, leave(&s, above, l.wi, wi_local), shadow_end(above, &l), arriving, slot_of_group(slot, group),
                    left_behind(&s, l.wi, lifted, prim), l.target, &way, m, invalid + EC_STAGE_SHADE);
    }

    sample_pair_u(random, pair + EC_PAIR_BSDF, &r1, &r2);
    chooser number = chooser_make(r2);
    lane_f roulette_scale = F(1.0f);
    bsdf_direction next_way;
    v3 wi;
    if (guides) {
        next_way = guide_sample_or(&guided, &s, &b, to_unit(r1), number, u_pass, &wi, &roulette_scale);
        if (bounce) roulette_scale = min(roulette_scale * packet_load_f(paths, wave, EC_PATH_ROULETTE, q), F(EC_ROULETTE_SCALE_MOST));
    } else {
        next_way = bsdf_sample(&b, params->sample == EC_SAMPLE_HEMISPHERE, to_unit(r1), number, u_pass);
        wi = surface_to_world(&s, next_way.wi); /* unit to 8 u: frame and local direction are */
    }
    if (HAS(SCATTERING)) {
        v3 strewn_way = phase_sample(event.g, d, to_unit(r1), to_unit(r2));
        wi = v3_select(strewn, strewn_way, wi);
        next_way.wi.z = strewn ? F(1.0f) : next_way.wi.z;
        next_way.weight = v3_select(strewn, v3_splat(F(1.0f)), next_way.weight);
        next_way.pdf = strewn ? phase_value(event.g, d, strewn_way) : next_way.pdf;
    }
    lane_i alive = (scatters | strewn) & (next_way.pdf != 0.0f) & same_side(&s, wi, next_way.wi, lifted);
    beta = v3_mul(beta, next_way.weight);
    lane_i finite = v3_is_finite(beta);
    uint bad = mask_bits(alive & !finite);
    if (bad) atomic_add(invalid + EC_STAGE_SHADE, popcount(bad));
    lane_f brightest = v3_max_component(beta);
    alive = alive & finite & (brightest > 0.0f);
    if (roulette) {
        if (!HAS(TRANSMISSION)) sample_pair(random, pair + EC_PAIR_ROULETTE, &u_survives, &u_pass); /* no sooner: registers are scarce above */
        lane_f survival = roulette_survival(sqrt(brightest * roulette_scale), params->survival);
        if (HAS(SMOOTH) && !roulette_plays(params, bounce + 1, true)) survival = next_way.pdf < 0.0f ? F(1.0f) : survival;
        if (HAS(SCATTERING) && params->survival == 0.0f) /* hundreds of events in a dense body need not lose light */
            survival = (strewn & (brightest >= EC_SURVIVAL_MOST)) ? F(1.0f) : survival;
        alive = alive & (u_survives < survival);
        beta = v3_scale(beta, 1.0f / survival);
    }
    lane_i straight = !TRUE_MASK; /* passes a pane */
    if (HAS(PANES)) straight = (next_way.pdf < 0.0f) & (next_way.wi.z < 0.0f) & pane_is(&b, flags);
    if (only_seen) alive = alive & straight;
    uint bits = mask_bits(alive);
    if (!bits) return;
    uint at = queue_reserve(counters->at[step + 1].rays, params->part, row, bits);
    v3 origin = leave(&s, above, wi, next_way.wi);
    queue_push_v3(next, wave, EC_PATH_OX, at, origin, bits);
    queue_push_v3(next, wave, EC_PATH_DX, at, wi, bits);
    queue_push_v3(next, wave, EC_PATH_BR, at, beta, bits);
    if (by_light) {
        k = light_path_k(params, &s, k, way2, wo, wi, wo_z, next_way.wi.z, next_way.pdf, lifted, straight);
        queue_push_f(next, wave, EC_PATH_K, at, k, bits);
    }
    if (guides) queue_push_f(next, wave, EC_PATH_ROULETTE, at, roulette_scale, bits);
    if (HAS(PANES)) {
        next_way.pdf = straight ? path_pdf : next_way.pdf;
        queue_push_v3(next, wave, EC_PATH_SX, at, v3_select(straight, source, origin), bits);
    }
    queue_push_f(next, wave, EC_PATH_PDF, at, next_way.pdf, bits);
    queue_push_f(next, wave, EC_PATH_SLOT, at, as_lane_f(slot), bits);
    queue_push_f(next, wave, EC_PATH_PRIM, at, as_lane_f(left_behind(&s, wi, lifted, prim)), bits);
    if (HAS_MEDIUM)
        queue_push_f(next, wave, EC_PATH_MEDIUM, at, as_lane_f(medium_towards(&h, &s, medium, next_way.wi.z, nested)), bits);
}

/* Cards' work-items have one hit each. Matt surfaces in a closed room all run the same code. */
#define GROUPS_HITS (LANES > 1 && (HAS(SPECULAR) || HAS(ENVIRONMENT) || HAS_TEXTURES))

EC_KERNEL(ec_shade, LANES, SHADE_PARAMETERS, QUEUED(at[step].rays))
{
    queue_packet q = {i, false, U(0)};
    if (!GROUPS_HITS) {
        shade_packet(row, &q, left, params SHADE_PARAMETERS(EC_ARGUMENT));
        return;
    }
    left = ordered_entries(left, params->part, i);
    if (!left) return;
    geometry g = SHADE_GEOMETRY;
    uint order[EC_ORDERED + LANES];
    q.is_scattered = group_hits(&g, hits, params->wave, i, left, order);
    for (uint k = 0; k < left; k += LANES) {
        q.first = i + k;
        if (q.is_scattered) q.at = LANE_LOAD(order + k);
        shade_packet(row, &q, left - k, params SHADE_PARAMETERS(EC_ARGUMENT));
    }
}
