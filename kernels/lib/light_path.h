/* Light paths: paths that start at lights and are joined to the camera at each of their vertices but the first, a third way in which path tracing
 * finds light (Veach 1997, chapter 10, with t = 1 and s > 2; --integrator light has s = 2, too). They start towards the casters, spheres about what
 * bends or mirrors light sharply.
 *
 * For one and the same path x_1 (seen by the camera) … x_k (on a light), let P, N and T be the densities with which directions sampled at x_k-1 find
 * it, light sampling there, and light paths. The contribution of each is weighted by the power heuristic over the three. With c and a directions at a
 * vertex towards the camera and the light, Q the density of c where light paths sample it and P that of a,
 *
 *     T / P = E K,   K = M |ng a_1| / (|ng c_1| P_1) * product over i = 2 … k-1 of |ng a_i| Q_i / (|ng c_i| P_i)
 *
 * where M is the area of camera paths at x_1 times the number of light paths per camera path, and E the density of emission (emission_*). Weights may
 * be of approximate densities as long as all three strategies use the same ones. A BSDF that is sampled by its value has |ns a| Q = |ns c| P, times 1
 * / eta^2 where light is bent, since values are of basic radiance; so behind x_1 a vertex only multiplies K by light_path_turn. K is 0 where no light
 * path comes by: where c is the only direction that leads to a at x_1, where rays start above their facet (terminator.h), and where the shading
 * normal is bent for one of both (surface_seen_normal). */
#ifndef EC_LIB_LIGHT_PATH_H
#define EC_LIB_LIGHT_PATH_H

#include "bsdf.h"
#include "light.h"

#define EC_K_MOST 1e30f
#define EC_K_LOW 1e-4f /* cosines to ns below this have few digits left */

/* Returns the sampler of light path number `path` in round `sample`. seed: that of the replicate's light paths. */
EC_FN sampler light_path_sampler(uint seed, lane_u path, lane_u sample) { return sampler_make(seed, sample, path); }
#define EC_PAIR_CASTER 0x80000001u

EC_FN v3 caster_centre(constant ec_params *params, uint j)
{
    constant float *c = params->casters[j];
    return v3_make(F(c[0]), F(c[1]), F(c[2]));
}

/* Returns the pdf per solid angle, over all casters, of direction d from point q of a lamp: uniform in the cone about a sphere. */
EC_FN lane_f aim_pdf(constant ec_params *params, v3 q, v3 d)
{
    lane_f sum = F(0.0f);
    EC_LOOP
    for (uint j = 0; j < params->caster_count; j++) {
        v3 way = v3_sub(caster_centre(params, j), q);
        lane_f d2 = v3_dot(way, way), radius = F(params->casters[j][3]), sine2 = radius * radius / d2;
        lane_f cosine = sqrt(max(1.0f - sine2, F(0.0f)));
        lane_f cone = v3_dot(way, d) >= cosine * sqrt(d2) ? 0.5f * EC_INV_PI * (1.0f + cosine) / sine2 : F(0.0f);
        sum = fma(sine2 < 1.0f ? cone : F(0.25f * EC_INV_PI), F(params->caster_share[j]), sum);
    }
    return sum;
}

/* Returns the direction at an angle of cosine 1 - rise to the axis; u1: its azimuth, in turns. */
EC_FN v3 direction_about(v3 axis, lane_f rise, lane_f u1)
{
    v3 s, t;
    lane_f cos_phi, sin_phi = sincos_2pi(u1, &cos_phi), sine = sqrt(max(rise * (2.0f - rise), F(0.0f)));
    v3_frame(axis, &s, &t);
    return v3_normalize(v3_fma(axis, 1.0f - rise, v3_fma(s, sine * cos_phi, v3_scale(t, sine * sin_phi))));
}

/* Samples a direction from q in the cone to the caster about `centre`; u1, u2 in [0, 1). */
EC_FN v3 aim_sample(v3 centre, lane_f radius, v3 q, lane_f u1, lane_f u2)
{
    v3 way = v3_sub(centre, q);
    lane_f d2 = v3_dot(way, way), sine2 = radius * radius / d2;
    lane_f rise = u2 * (sine2 < 1.0f ? sine2 / (1.0f + sqrt(max(1.0f - sine2, F(0.0f)))) : F(2.0f));
    v3 axis = v3_select(d2 > 0.0f, v3_scale(way, 1.0f / sqrt(d2)), v3_make(F(0.0f), F(0.0f), F(1.0f)));
    return direction_about(axis, rise, u1);
}

/* Samples a direction of a lamp's emission in proportion to its cosine; *pdf_per_cosine: the pdf over the cosine. With both_sides, the first half of
 * u2 is behind n. */
EC_FN v3 lamp_direction(v3 n, lane_i both_sides, lane_f u1, lane_f u2, lane_f *pdf_per_cosine)
{
    lane_i behind = both_sides & (u2 < 0.5f);
    lane_f rest = both_sides ? (behind ? 2.0f * u2 : 2.0f * u2 - 1.0f) : u2;
    *pdf_per_cosine = both_sides ? F(0.5f * EC_INV_PI) : F(EC_INV_PI);
    return direction_about(v3_select(behind, v3_negate(n), n), 1.0f - sqrt(1.0f - rest), u1);
}

/* Samples a direction of a punctual light's emission, uniform over a spot's cone or all around. */
EC_FN v3 punctual_direction(const light_record *l, lane_f u1, lane_f u2, lane_f *pdf)
{
    lane_i is_spot = (l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_SPOT;
    lane_f most = is_spot ? 1.0f - l->c.y : F(2.0f);
    *pdf = 0.5f * EC_INV_PI / most;
    return direction_about(v3_select(is_spot, l->b, v3_make(F(0.0f), F(0.0f), F(1.0f))), most * u2, u1);
}

/* Returns the density, per area across d, of the line through p along d: uniform over the casters' disks. */
EC_FN lane_f aim_far_pdf(constant ec_params *params, v3 p, v3 d)
{
    lane_f sum = F(0.0f);
    EC_LOOP
    for (uint j = 0; j < params->caster_count; j++) {
        v3 off = v3_cross(v3_sub(caster_centre(params, j), p), d);
        float radius2 = params->casters[j][3] * params->casters[j][3];
        sum += v3_dot(off, off) <= radius2 ? F(params->caster_share[j] * EC_INV_PI / radius2) : F(0.0f);
    }
    return sum;
}

/* Samples such a line to the caster about `centre`; returns a point on it before the scene. */
EC_FN v3 aim_far_origin(constant ec_params *params, v3 centre, lane_f radius, v3 d, lane_f u1, lane_f u2)
{
    v3 s, t;
    lane_f r = radius * sqrt(u2), cosine, sine = sincos_2pi(u1, &cosine);
    v3_frame(d, &s, &t);
    v3 on_disk = v3_fma(s, r * cosine, v3_fma(t, r * sine, centre));
    return v3_fma(d, F(-2.0f * params->scene_radius) - radius, on_disk);
}

/* Returns the probability with which light paths start from light id. The table `emission` has, in words: ec_distribution_entry of each light, then
 * their probabilities, then their trails where there is a light tree, and the lights of triangles. */
EC_FN lane_f emission_pmf(const lights *l, lane_u id)
{
    return as_lane_f(gather_u(l->emission, id + 2u * l->env.params->light_count));
}
/* The light of a triangle, or EC_NO_ID. */
EC_FN lane_u emission_light(const lights *l, lane_u prim) { return gather_u(l->emission, prim + 4u * l->env.params->light_count); }

/* Returns E of point q of a lamp whose area is 1 / per_area, along d with this cosine to its normal. */
EC_FN lane_f emission_lamp(const lights *l, lane_i m, lane_u id, lane_f per_area, v3 q, v3 d, lane_f cosine)
{
    lane_f pdf = emission_pmf(l, m ? id : U(0)) * per_area * aim_pdf(l->env.params, q, d) / cosine;
    return (m & (cosine > 0.0f)) ? pdf : F(0.0f);
}
/* Returns E of a far light along d through p; pdf: the density of d among the light's directions. */
EC_FN lane_f emission_far(const lights *l, lane_u id, lane_f pdf, v3 p, v3 d)
{
    return emission_pmf(l, id) * pdf * aim_far_pdf(l->env.params, p, d);
}
/* Returns E of the environment, always the first light, where light sampling has density pdf. */
EC_FN lane_f emission_environment(const lights *l, lane_f pdf, v3 p, v3 d)
{
    lane_f own = pdf / F(l->env.params->environment_pmf);
    return pdf > 0.0f ? emission_far(l, U(0), own, p, d) : F(0.0f);
}

/* Returns E of light sample s for p, on the lanes m. */
EC_FN lane_f emission_sampled(const lights *l, const light_sample *s, lane_i m, v3 p)
{
    v3 d = v3_negate(s->wi);
    lane_f e = F(0.0f);
    if (HAS(AREA_LIGHTS)) {
        lane_i is = m & (s->target != EC_NO_ID);
        e = emission_lamp(l, is, s->id, s->per_area, v3_add(p, s->towards), d, fabs(v3_dot(s->end_normal, d)));
    }
    if (HAS(PUNCTUAL_LIGHTS)) {
        lane_i is = m & s->is_delta, far = is & s->is_far;
        v3 q = v3_add(p, s->towards);
        lane_f near = emission_pmf(l, is ? s->id : U(0)) * aim_pdf(l->env.params, q, d) / v3_dot(s->towards, s->towards);
        e = is ? (far ? emission_far(l, far ? s->id : U(0), F(1.0f), p, d) : near) : e;
    }
    if (HAS(ENVIRONMENT)) e = (m & s->is_far & !s->is_delta) ? emission_environment(l, s->pdf, p, d) : e;
    return e;
}

/* Returns the lanes on which no light path passes this vertex from wi to wo. wo_z, wi_z: their local z; lifted: rays start above the facet. Among
 * these are walls whose lobe is too narrow to resolve from one side only, and tilted coats that mirror. */
EC_FN lane_i light_path_misses(const surface *s, v3 wi, lane_f wo_z, lane_f wi_z, lane_i lifted)
{
    lane_i passes = wi_z < 0.0f, none = s->bent | (fabs(wi_z) < surface_least_cosine(fabs(v3_dot(s->ng, wi)))) | (lifted & !passes);
    none = none | (fabs(wo_z) <= EC_K_LOW) | (fabs(wi_z) <= EC_K_LOW);
    if (HAS(SMOOTH) && HAS(TRANSMISSION)) {
        lane_f there = s->eta > 0.0f ? s->alpha_ggx * fabs(s->eta - 1.0f) / s->eta : F(0.0f);
        lane_i differs = s->smooth ? there >= EC_SMOOTH_ALPHA : there < EC_SMOOTH_ALPHA;
        none = none | (passes & s->refracts & !s->displaced & differs);
    }
    if (HAS(CLEARCOAT) && HAS_BENDING) {
        v3 away = v3_sub(s->coat_ns, s->ns);
        none = none | ((s->coat > 0.0f) & s->coat_smooth & (v3_dot(away, away) > 0.0f));
    }
    return none;
}

/* Returns |ng a| Q / (|ng c| P) at a vertex; c_z, a_z: local z of c and a. */
EC_FN lane_f light_path_turn(const surface *s, v3 c, v3 a, lane_f c_z, lane_f a_z)
{
    lane_f turn = fabs(v3_dot(s->ng, a) * c_z) / fabs(v3_dot(s->ng, c) * a_z);
    return (s->refracts & (c_z * a_z < 0.0f)) ? turn / (s->eta * s->eta) : turn;
}

/* Light paths leave direct light to the other two strategies: these find it with every path, in the order of their samples, where a random number of
 * light paths would bring it. The last bit of K says so behind the first vertex. */
EC_FN lane_f k_mark_direct(lane_f k) { return k > 0.0f ? as_lane_f(as_lane_u(k) | 1u) : F(0.0f); }
EC_FN lane_f k_unmark(lane_f k) { return as_lane_f(as_lane_u(k) & ~1u); }
EC_FN lane_i k_is_joined(lane_f k) { return (k > 0.0f) & ((as_lane_u(k) & 1u) == 0u); }

/* Returns K behind a vertex that a path leaves along wi with density pdf (< 0: the only direction). k: K before the vertex, < 0 at the first one;
 * way2: squared distance from the camera to the first one. straight: a pane is passed, which is no vertex. */
EC_FN lane_f light_path_k(constant ec_params *params, const surface *s, lane_f k, lane_f way2, v3 wo, v3 wi, lane_f wo_z, lane_f wi_z, lane_f pdf,
                          lane_i lifted, lane_i straight)
{
    lane_f first = -k * (params->orthographic ? F(1.0f) : way2) * fabs(v3_dot(s->ng, wi)) / (fabs(v3_dot(s->ng, wo)) * pdf);
    first = pdf > 0.0f ? k_mark_direct(min(first, F(EC_K_MOST))) : F(0.0f);
    lane_f later = k_unmark(min(k * light_path_turn(s, wo, wi, wo_z, wi_z), F(EC_K_MOST)));
    lane_f next = light_path_misses(s, wi, wo_z, wi_z, lifted) ? F(0.0f) : k < 0.0f ? first : later;
    return straight ? k : next;
}

/* Returns the pdf with which light sampling at p finds `source`, the point (b1, b2) of light id where a light path starts along d. */
EC_FN lane_f light_path_joined_pdf(const lights *l, const geometry *g, lane_i m, lane_u id, lane_f b1, lane_f b2, v3 p, v3 source, v3 d)
{
    constant ec_params *params = l->env.params;
    id = m ? id : U(0);
    light_record one = light_load(l, id);
    lane_u type = one.kind & EC_LIGHT_KIND_MASK;
    lane_f chance = F(1.0f);
    if (lights_have_tree(l)) {
        lane_i near = m & (type != EC_KIND_DIRECTIONAL) & (type != EC_KIND_ENVIRONMENT);
        if (any_lane(near)) {
            lane_f pmf = light_tree_pmf(l, near, p, params->light_tree_numbers, gather_u(l->emission, id + 3u * params->light_count));
            chance = near ? pmf : chance;
        }
    }
    chance *= light_share_scale(params, one.kind);
    lane_f pdf = one.pmf * chance;
    if (HAS(AREA_LIGHTS)) {
        lane_i is = m & (type == EC_KIND_TRIANGLE);
        if (any_lane(is)) {
            hit_point h = hit_point_make(g, is ? one.prim : U(0), b1, b2);
            v3 way = v3_sub(p, source), n = v3_normalize(v3_cross(v3_sub(h.p1, h.p0), v3_sub(h.p2, h.p0)));
            h.light_pdf_a *= chance;
            lane_i paired = is & ((one.kind & EC_LIGHT_PAIRED) != 0u);
            if (HAS(LAMP_PAIRS) && !lights_have_tree(l) && any_lane(paired)) {
                light_record other = light_load(l, paired ? pair_partner(one.kind, id) : U(0));
                lane_f own = pair_chance(one.a, one.b, one.c, one.pmf, &other, p);
                h.light_pdf_a *= paired ? own : F(1.0f);
            }
            lane_f found = light_found_pdf(g, &h, is, p, v3_dot(way, way), fabs(v3_dot(n, d)));
            pdf = is ? found : pdf;
        }
    }
    if (HAS(ENVIRONMENT)) {
        lane_i is = m & (type == EC_KIND_ENVIRONMENT);
        lane_f found;
        if (any_lane(is)) {
            environment_look_up(&l->env, v3_negate(d), &found);
            pdf = is ? found : pdf;
        }
    }
    return pdf;
}

#endif
