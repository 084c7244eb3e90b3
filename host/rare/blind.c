#include "rare/blind.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "rare/leave.h"

#define PI 3.14159265358979323846
#define CHANCE 1e-7 /* that a sample meets such light, so small that the look's paths would not have */
enum { RAYS = 128 }; /* rays from each light */

/* Starts a ray from a part of an environment, through a disk as large as the scene. */
static void start_far_away(const ec_rare_light *light, const ec_params *params, double radius, uint64_t *random, ec_chain *ray)
{
    const double r = radius * sqrt(ec_random_unit(random)), angle = 2 * PI * ec_random_unit(random);
    float towards[3];
    double u[3], v[3];
    ec_rare_light_direction(light, params, towards);
    ec_rare_frame(towards, u, v);
    for (int c = 0; c < 3; c++) {
        ray->origin[c] = (float)(2 * radius * towards[c] + r * (cos(angle) * u[c] + sin(angle) * v[c]));
        ray->direction[c] = -towards[c];
    }
    ray->prim = EC_NO_ID;
}

/* Starts rays from each light that is not all around; returns how many. */
static uint32_t start_rays(const ec_rare_lights *all, const ec_params *params, ec_chain *rays)
{
    uint64_t random = 7;
    uint32_t count = 0;
    for (uint32_t i = 0; i < all->count; i++) {
        const ec_rare_light *light = &all->lights[i];
        for (uint32_t k = 0; k < RAYS && !ec_rare_light_is_all_around(light); k++, count++)
            if (light->lamp_count) ec_rare_leave_lamp(&light->lamps[k % light->lamp_count], &random, &rays[count]);
            else start_far_away(light, params, all->radius, &random, &rays[count]);
    }
    return count;
}

/* Adds a kind, in place of any other where there is no room: how often it is met is not known. */
static void add_kind(const ec_rare_lights *all, const ec_rare_light *light, uint32_t material, double share, ec_rare *rare)
{
    ec_rare_kind *kind = ec_rare_make_room(rare, INFINITY);
    *kind = (ec_rare_kind){.chance = CHANCE, .luminance = share / (1 - fmin(share, 0.9)), .is_relative = true, .clamped = 1, .caustic = all->casts[material],
                            .gathered = 1, .peak = 1};
    memset(kind->share, 255, sizeof kind->share);
    snprintf(kind->through, sizeof kind->through, "%s", all->materials[material]);
    memcpy(kind->light, light->name, sizeof kind->light);
}

/* Adds a kind for each material that sends on much of a light's rays and that paths have hardly met, unless light paths are aimed at it. */
static void judge_light(const ec_rare_lights *all, const ec_chains *chains, const ec_rare_light *light, const ec_chain *rays, bool has_light_paths,
                        double *shares, ec_rare *rare)
{
    memset(shares, 0, all->material_count * sizeof *shares);
    for (int k = 0; k < RAYS; k++) {
        if (rays[k].hit == EC_NO_ID) continue;
        const uint32_t m = ec_rare_material_of(all, rays[k].hit);
        shares[m] += all->sharp[m] * light->power / all->power / RAYS;
    }
    for (uint32_t m = 0; m < all->material_count; m++)
        if (shares[m] >= EC_BLIND_SHARE && chains->visits[m] < EC_BLIND_VISITS && !(has_light_paths && all->casts[m])) add_kind(all, light, m, shares[m], rare);
}

ec_result ec_rare_blind_find(const ec_rare_lights *all, const ec_chains *chains, ec_pipeline *p, ec_rare *rare, ec_error *err)
{
    bool any = false;
    uint32_t count = 0;
    for (uint32_t m = 0; m < all->material_count; m++) any |= all->sharp[m] >= EC_BLIND_SHARE && chains->visits[m] < EC_BLIND_VISITS;
    if (!any || !(all->power > 0)) return EC_OK;
    ec_chain *rays = calloc((size_t)all->count * RAYS, sizeof *rays);
    double *shares = malloc((all->material_count + (size_t)1) * sizeof *shares);
    ec_result result = rays && shares ? EC_OK : ec_fail(err, "out of memory for %u rays", all->count * RAYS);
    if (result == EC_OK) count = start_rays(all, &p->params, rays);
    if (result == EC_OK) result = ec_chains_meet(p, rays, count, err);
    const ec_chain *own = rays;
    for (uint32_t i = 0; result == EC_OK && i < all->count; i++) {
        if (ec_rare_light_is_all_around(&all->lights[i])) continue;
        judge_light(all, chains, &all->lights[i], own, (p->effects.called.bits & EC_FEATURE_LIGHT_PATHS) != 0, shares, rare);
        own += RAYS;
    }
    free(rays);
    free(shares);
    return result;
}
