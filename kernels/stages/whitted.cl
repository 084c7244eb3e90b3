/* Shades one hit of Whitted's ray tree: adds background, emission, ambient light; then follows what is mirrored and what passes, both weighted by
 * Fresnel. Of two such branches one goes on and the other waits on the slot's stack; where a branch ends, the one that waited last takes its place,
 * so a slot never has more than one ray under way.
 * Reads: path queue and hits. Writes: radiance of the slots, the next path queue, stacks, first-hit features at step 0 where asked
 * for; in its own queues, beta after absorption, and no hit where no light falls. Next: whitted_light, then intersect. */
#include "../lib/blinn_phong.h"
#include "../lib/features.h"
#include "../lib/film.h"
#include "../lib/kernel.h"
#include "../lib/light_centre.h"
#include "../lib/medium.h"
#include "../lib/seen.h"

typedef struct branch {
    v3 o, d, beta;
    lane_f depth;
    lane_u prim, medium;
} branch;

EC_FN void branch_push(global float *stacks, uint wave, lane_u slot, lane_u level, const branch *b, uint bits)
{
    lane_u at = slot + (1u + level * (uint)EC_BRANCH_FIELDS) * wave;
    scatter_f(stacks, at + EC_BRANCH_OX * wave, b->o.x, bits);
    scatter_f(stacks, at + EC_BRANCH_OY * wave, b->o.y, bits);
    scatter_f(stacks, at + EC_BRANCH_OZ * wave, b->o.z, bits);
    scatter_f(stacks, at + EC_BRANCH_DX * wave, b->d.x, bits);
    scatter_f(stacks, at + EC_BRANCH_DY * wave, b->d.y, bits);
    scatter_f(stacks, at + EC_BRANCH_DZ * wave, b->d.z, bits);
    scatter_f(stacks, at + EC_BRANCH_BR * wave, b->beta.x, bits);
    scatter_f(stacks, at + EC_BRANCH_BG * wave, b->beta.y, bits);
    scatter_f(stacks, at + EC_BRANCH_BB * wave, b->beta.z, bits);
    scatter_f(stacks, at + EC_BRANCH_DEPTH * wave, b->depth, bits);
    scatter_f(stacks, at + EC_BRANCH_PRIM * wave, as_lane_f(b->prim), bits);
    if (HAS_MEDIUM) scatter_f(stacks, at + EC_BRANCH_MEDIUM * wave, as_lane_f(b->medium), bits);
}

EC_FN v3 branch_load_v3(global const float *stacks, uint wave, lane_u at, uint field)
{
    return v3_make(gather_f(stacks, at + field * wave), gather_f(stacks, at + (field + 1) * wave),
                   gather_f(stacks, at + (field + 2) * wave));
}

/* level and slot of masked-off lanes must be valid. */
EC_FN branch branch_load(global const float *stacks, uint wave, lane_u slot, lane_u level)
{
    lane_u at = slot + (1u + level * (uint)EC_BRANCH_FIELDS) * wave;
    branch b;
    b.o = branch_load_v3(stacks, wave, at, EC_BRANCH_OX);
    b.d = branch_load_v3(stacks, wave, at, EC_BRANCH_DX);
    b.beta = branch_load_v3(stacks, wave, at, EC_BRANCH_BR);
    b.depth = gather_f(stacks, at + EC_BRANCH_DEPTH * wave);
    b.prim = as_lane_u(gather_f(stacks, at + EC_BRANCH_PRIM * wave));
    b.medium = HAS_MEDIUM ? as_lane_u(gather_f(stacks, at + EC_BRANCH_MEDIUM * wave)) : U(EC_NO_ID);
    return b;
}

EC_FN branch branch_select(lane_i m, branch a, branch b)
{
    branch r = {v3_select(m, a.o, b.o), v3_select(m, a.d, b.d), v3_select(m, a.beta, b.beta), m ? a.depth : b.depth,
                m ? a.prim : b.prim, m ? a.medium : b.medium};
    return r;
}

EC_FN branch branch_make(const surface *s, v3 wi, v3 beta, lane_f depth, lane_u prim, lane_u medium)
{
    branch b = {surface_offset(s->p, s->p_error, s->ng, wi), wi, beta, depth, prim, medium};
    return b;
}

#define WHITTED_PARAMETERS(DO)                                                                                                                        \
    WAVE_PARAMETERS(DO) DO(volatile global ec_counters *, counters) DO(volatile global uint *, invalid) DO(global float *, paths)                     \
    DO(global float *, hits) DO(global float *, next) DO(global float *, branches) DO(global float *, radiance) DO(global float *, aov)               \
    SURFACE_PARAMETERS(DO) DO(global const float *, environment_texels) DO(global const uint *, parts)

EC_KERNEL(ec_whitted, LANES, WHITTED_PARAMETERS, QUEUED(at[step].rays))
{
    uint wave = params->wave;
    geometry g = {prims, indices, normals, tangents, uvs, colors, materials, {texture_table, texels, srgb}, places};
    environment env = {params, environment_texels, 0};
    lane_i active = LANE_NUMBERS < left;
    v3 o = queue_load_v3(paths, wave, EC_PATH_OX, i), d = queue_load_v3(paths, wave, EC_PATH_DX, i), wo = v3_negate(d);
    v3 beta = queue_load_v3(paths, wave, EC_PATH_BR, i);
    lane_f depth = queue_load_f(paths, wave, EC_PATH_DEPTH, i);
    lane_u slot = queue_load_u(paths, wave, EC_PATH_SLOT, i), prim = queue_load_u(hits, wave, EC_HIT_PRIM, i);
    slot = active ? slot : U(0);
    lane_i found = active & (prim != EC_NO_ID);
    bool nested = MEDIA_NESTED(params);
    lane_u bodies = U(0);
    if (nested) bodies = found ? queue_load_u(paths, wave, EC_PATH_MEDIUM, i) : U(0);
    seen e = seen_surface(&g, found, prim, queue_load_f(hits, wave, EC_HIT_B1, i), queue_load_f(hits, wave, EC_HIT_B2, i), wo,
                          bodies);
    const surface *s = &e.s;
    v3 way = v3_sub(s->p, o);
    lane_f distance = sqrt(v3_dot(way, way));
    lane_u medium = U(EC_NO_ID);
    if (HAS_MEDIUM) medium = medium_of(&e.h, s, found, queue_load_u(paths, wave, EC_PATH_MEDIUM, i), nested);
    if (HAS(ABSORPTION)) {
        beta = v3_mul(beta, medium_transmittance(&g, medium_material(&g, medium, nested), distance));
        queue_store_v3(paths, wave, EC_PATH_BR, i, beta);
    }
    if (aov && bounce == 0)
        store_features(aov, wave, slot, v3_select(found, s->base, v3_zero()), v3_select(found, s->ns, v3_zero()),
                       found ? distance : F(0.0f), found ? F(1.0f) : F(0.0f), mask_bits(active));
    if (HAS(LAYERS) && bounce == 0) store_surface_layers(params, radiance, parts, slot, prim, &e.h, s, found);

    bsdf b = bsdf_make(s, surface_to_local(s, wo), false);
    lane_i mirrors = whitted_mirrors(s), goes_on = e.lit & (depth + 3.0f <= (float)params->max_depth);
    v3 out = v3_add(seen_background(&env, active & !found, d, bounce || !params->backdrop), e.glow);
    if (HAS(ENVIRONMENT)) out = v3_add(out, v3_select(goes_on, light_ambient(params, blinn_phong_albedo(&b, mirrors)), v3_zero()));
    radiance_add(radiance, wave, slot, v3_mul(beta, out), active, invalid + EC_STAGE_SHADE);
    queue_store_f(hits, wave, EC_HIT_PRIM, i, as_lane_f(goes_on ? prim : U(EC_NO_ID)));

    lane_u waiting = HAS(TRANSMISSION) && bounce ? as_lane_u(gather_f(branches, slot)) : U(0), waited = waiting;
    branch go = {o, d, beta, depth, prim, medium};
    lane_i goes = !TRUE_MASK;
    if (HAS(SPECULAR)) {
        lane_f rest, cosine = min(max(b.wo.z, F(0.0f)), F(1.0f));
        v3 fresnel = bsdf_fresnel(&b, cosine, &rest);
        v3 mirror_beta = v3_mul(beta, fresnel);
        v3 mirror_local = v3_make(-b.wo.x, -b.wo.y, b.wo.z), mirror_wi = surface_to_world(s, mirror_local);
        lane_i m = goes_on & mirrors & (v3_max_component(mirror_beta) > params->cutoff) & (v3_dot(mirror_wi, s->ng) > 0.0f);
        go = branch_select(m, branch_make(s, mirror_wi, mirror_beta, depth + 1.0f, prim, medium), go);
        goes = m;
        if (HAS(TRANSMISSION)) {
            v3 normal = v3_make(F(0.0f), F(0.0f), F(1.0f));
            v3 pass_local = v3_select(b.refracts, refract(b.wo, normal, b.eta), v3_negate(b.wo));
            v3 pass_wi = surface_to_world(s, pass_local);
            v3 pass_beta = v3_mul(v3_mul(beta, b.base), v3_splat(rest * b.transmission));
            branch pass = branch_make(s, pass_wi, pass_beta, depth + 1.0f, prim, medium_towards(&e.h, s, medium, F(-1.0f), nested));
            lane_i p = goes_on & (v3_max_component(pass_beta) > params->cutoff) & (v3_dot(pass_wi, s->ng) < 0.0f);
            /* The mirrored branch, which is mostly the shorter, first. */
            branch_push(branches, wave, slot, waiting, &pass, mask_bits(p & m));
            waiting = (p & m) ? waiting + 1u : waiting;
            go = branch_select(p & !m, pass, go);
            goes = goes | p;
            lane_i pops = active & !goes & (waiting > 0u);
            if (any_lane(pops)) {
                waiting = pops ? waiting - 1u : waiting;
                go = branch_select(pops, branch_load(branches, wave, slot, pops ? waiting : U(0)), go);
                goes = goes | pops;
            }
            scatter_f(branches, slot, as_lane_f(waiting), mask_bits(bounce ? active & (waiting != waited) : active));
        }
    }
    uint bits = mask_bits(goes);
    if (!bits) return;
    uint at = queue_reserve(counters->at[step + 1].rays, params->part, row, bits);
    queue_push_v3(next, wave, EC_PATH_OX, at, go.o, bits);
    queue_push_v3(next, wave, EC_PATH_DX, at, go.d, bits);
    queue_push_v3(next, wave, EC_PATH_BR, at, go.beta, bits);
    queue_push_f(next, wave, EC_PATH_DEPTH, at, go.depth, bits);
    queue_push_f(next, wave, EC_PATH_SLOT, at, as_lane_f(slot), bits);
    queue_push_f(next, wave, EC_PATH_PRIM, at, as_lane_f(go.prim), bits);
    if (HAS_MEDIUM) queue_push_f(next, wave, EC_PATH_MEDIUM, at, as_lane_f(go.medium), bits);
}
