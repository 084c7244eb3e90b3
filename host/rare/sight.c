#include "rare/sight.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t targets_of(const ec_rare_light *light) { return ec_rare_light_is_all_around(light) ? 0 : light->lamp_count ? light->lamp_count : 1; }

/* Makes a ray from the light to where a chain starts: whichever side of a body that is on, the ray meets the side that the light shines on. */
static void aim(const ec_rare_lights *all, const ec_rare_light *light, uint32_t lamp, const ec_params *params, const ec_chain *to, ec_chain *ray)
{
    double square = 0;
    *ray = (ec_chain){.prim = EC_NO_ID};
    if (!light->lamp_count) {
        float towards[3];
        ec_rare_light_direction(light, params, towards);
        for (int k = 0; k < 3; k++) ray->origin[k] = to->origin[k] + 2 * all->radius * towards[k], ray->direction[k] = -towards[k];
        return;
    }
    memcpy(ray->origin, light->lamps[lamp].middle, sizeof ray->origin);
    ray->prim = light->lamps[lamp].prim;
    for (int k = 0; k < 3; k++) {
        ray->direction[k] = to->origin[k] - ray->origin[k];
        square += (double)ray->direction[k] * ray->direction[k];
    }
    for (int k = 0; k < 3; k++) ray->direction[k] /= (float)fmax(sqrt(square), 1e-30);
}

/* Returns whether the light is in sight; what mirrors or lets light through on the way does not hide it. */
static bool is_reached(const ec_rare_lights *all, const ec_chain *from, const ec_chain *ray)
{
    if (ray->hit == EC_NO_ID) return true;
    const uint32_t material = ec_rare_material_of(all, ray->hit);
    return all->sharp[material] > 0 || (from->prim != EC_NO_ID && material == ec_rare_material_of(all, from->prim));
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
            for (uint32_t c = 0; c < count; c++) aim(all, &all->lights[i], l, &p->params, chains[c], &rays[at++]);
    if (result == EC_OK) result = ec_chains_meet(p, rays, targets * count, err);
    for (uint32_t i = 0; result == EC_OK && i < targets * count; i++) (*in_sight)[i] = is_reached(all, chains[i % count], &rays[i]);
    free(rays);
    if (result != EC_OK) free(*in_sight), *in_sight = NULL;
    return result;
}
