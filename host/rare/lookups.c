/* Questions about lights that have been found, for those who find them and for those who use them. */
#include "rare/lights.h"

uint32_t ec_rare_stored_of(const ec_rare_lights *all, uint32_t id, const ec_placed **placed)
{
    *placed = NULL;
    if (!all->placed_count || id < all->placed[0].id) return id;
    uint32_t low = 0, high = all->placed_count - 1;
    while (low < high) {
        const uint32_t middle = (low + high + 1) / 2;
        if (all->placed[middle].id <= id) low = middle;
        else high = middle - 1;
    }
    *placed = &all->placed[low];
    return all->shapes[all->placed[low].shape].first + id - all->placed[low].id;
}

uint32_t ec_rare_material_of(const ec_rare_lights *all, uint32_t id)
{
    const ec_placed *placed;
    const uint32_t stored = ec_rare_stored_of(all, id, &placed);
    return stored < all->stored_count ? all->triangle_material[stored] : 0;
}

void ec_rare_turn_from_map(const float d[3], const ec_params *params, float direction[3])
{
    for (int k = 0; k < 3; k++) {
        const float *turn = params->environment_turn + 4 * k;
        direction[k] = params->environment_turned ? turn[0] * d[0] + turn[1] * d[1] + turn[2] * d[2] : d[k];
    }
}

void ec_rare_light_direction(const ec_rare_light *light, const ec_params *params, float direction[3])
{
    ec_rare_turn_from_map(light->direction, params, direction);
}
