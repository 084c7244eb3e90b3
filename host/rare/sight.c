#include "rare/sight.h"

#include <math.h>
#include <stdlib.h>

static uint32_t targets_of(const ec_rare_light *light) { return light->lamp_count ? light->lamp_count : 1; }

static void aim(const ec_rare_light *light, uint32_t lamp, const ec_params *params, const ec_chain *from, ec_chain *ray)
{
    double square = 0;
    *ray = *from;
    if (!light->lamp_count) {
        ec_rare_light_direction(light, params, ray->direction);
        return;
    }
    for (int k = 0; k < 3; k++) {
        ray->direction[k] = light->lamps[lamp].middle[k] - from->origin[k];
        square += (double)ray->direction[k] * ray->direction[k];
    }
    for (int k = 0; k < 3; k++) ray->direction[k] /= (float)fmax(sqrt(square), 1e-30);
}

/* Rays towards one target, from all chains. What mirrors or lets light through on the way leaves it in sight; but a ray into the body that it
 * starts at tells nothing, as another point of that body may face the target. */
static void judge(const ec_rare_lights *all, const ec_rare_light *light, const ec_chain *rays, uint32_t count, bool *in_sight)
{
    bool is_told = false;
    for (uint32_t i = 0; i < count; i++) {
        const bool is_miss = rays[i].hit == EC_NO_ID;
        const uint32_t material = is_miss ? UINT32_MAX : ec_rare_material_of(all, rays[i].hit);
        const bool is_sharp = !is_miss && all->sharp[material] > 0, is_own = is_sharp && material == ec_rare_material_of(all, rays[i].prim);
        in_sight[i] = !is_own && (is_sharp || (light->lamp_count ? material == light->material : is_miss));
        is_told |= !is_own;
    }
    for (uint32_t i = 0; i < count && !is_told; i++) in_sight[i] = true;
}

ec_result ec_rare_sight(const ec_rare_lights *all, const ec_chain *const *chains, uint32_t count, ec_pipeline *p, bool **in_sight, ec_error *err)
{
    uint32_t targets = 0, at = 0;
    *in_sight = NULL;
    for (uint32_t i = 0; i < all->count; i++) targets += targets_of(&all->lights[i]);
    if (!targets || !count) return EC_OK;
    ec_chain *rays = calloc((size_t)targets * count, sizeof *rays);
    *in_sight = calloc((size_t)targets * count, sizeof **in_sight);
    ec_result result = rays && *in_sight ? EC_OK : ec_fail(err, "out of memory for %u rays", targets * count);
    for (uint32_t i = 0; result == EC_OK && i < all->count; i++)
        for (uint32_t l = 0; l < targets_of(&all->lights[i]); l++)
            for (uint32_t c = 0; c < count; c++) aim(&all->lights[i], l, &p->params, chains[c], &rays[at++]);
    if (result == EC_OK) result = ec_chains_meet(p, rays, targets * count, err);
    for (uint32_t i = at = 0; result == EC_OK && i < all->count; i++)
        for (uint32_t l = 0; l < targets_of(&all->lights[i]); l++, at += count) judge(all, &all->lights[i], rays + at, count, *in_sight + at);
    free(rays);
    if (result != EC_OK) free(*in_sight), *in_sight = NULL;
    return result;
}
