/* What the light tree needs beside the table of lights. Lamps are triangles, points and spots: what is infinitely far away keeps its
 * probability, and what the lamps have together goes to the tree. */
#include <math.h>
#include <stdlib.h>

#include "pack/light_tree.h"
#include "pack/pack.h"

static bool is_lamp(const ec_light_data *light)
{
    uint32_t kind = light->kind & EC_LIGHT_KIND_MASK;
    return kind == EC_KIND_TRIANGLE || kind == EC_KIND_POINT || kind == EC_KIND_SPOT;
}

static uint32_t lamp_count(const ec_pack *pack)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pack->light_count; i++) count += is_lamp(&pack->lights[i]);
    return count;
}

/* A tree takes its time at every surface (a quarter to three quarters of a sample's). That is well spent where there are many lamps and
 * they are in different places; of a bulb of many triangles all are as near, and power alone is as good. */
bool ec_pack_wants_light_tree(const ec_pack *pack)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, size2 = 0;
    if (lamp_count(pack) < EC_LIGHT_TREE_FROM || pack->lamp_share < EC_LIGHT_TREE_LEAST) return false;
    for (uint32_t i = 0; i < pack->light_count; i++)
        for (int k = 0; k < 3 && is_lamp(&pack->lights[i]); k++) {
            low[k] = fmin(low[k], (double)pack->lights[i].a[k]);
            high[k] = fmax(high[k], (double)pack->lights[i].a[k]);
        }
    for (int k = 0; k < 3; k++) size2 += (high[k] - low[k]) * (high[k] - low[k]);
    return size2 > EC_LIGHT_TREE_SPREAD * EC_LIGHT_TREE_SPREAD * (double)pack->scene_radius * (double)pack->scene_radius;
}

/* Densities of the table are those of the lamp chosen already: the tree's probability comes on top of them. */
static void share_out(ec_pack *pack)
{
    double far = 0;
    for (uint32_t i = 0; i < pack->light_count; i++) far += is_lamp(&pack->lights[i]) ? 0 : (double)pack->lights[i].pmf;
    pack->light_tree_pmf = (float)(1 - far);
    for (uint32_t i = 0; i < pack->light_count; i++) {
        ec_light_data *l = &pack->lights[i];
        if (!is_lamp(l)) continue;
        if (l->pmf > 0) l->pdf_a = (float)((double)l->pdf_a / l->pmf * (1 - far));
        l->pmf = pack->light_tree_pmf;
    }
}

ec_result ec_pack_light_tree(ec_pack *pack, ec_error *err)
{
    uint32_t lamps = lamp_count(pack), n = 0;
    if (lamps < 2) return EC_OK;
    ec_light_bounds *bounds = malloc(lamps * sizeof *bounds);
    uint32_t *ids = malloc(lamps * sizeof *ids), *trails = malloc(lamps * sizeof *trails);
    uint32_t *trail_of = calloc(pack->light_count, sizeof *trail_of);
    pack->light_tree = malloc((2 * (size_t)lamps - 1) * sizeof *pack->light_tree);
    ec_result result = bounds && ids && trails && trail_of && pack->light_tree
                           ? EC_OK
                           : ec_fail(err, "out of memory for a tree of %u lamps", lamps);
    for (uint32_t i = 0; result == EC_OK && i < pack->light_count; i++) {
        if (!is_lamp(&pack->lights[i])) continue;
        bounds[n] = ec_light_bounds_of(&pack->lights[i], pack->lights[i].pmf);
        ids[n++] = i;
    }
    if (result == EC_OK) result = ec_light_tree_build(bounds, ids, lamps, pack->light_tree, trails, err);
    if (result == EC_OK) {
        share_out(pack);
        pack->light_node_count = 2 * lamps - 1;
        for (uint32_t i = 0; i < lamps; i++) trail_of[ids[i]] = trails[i];
        for (uint32_t p = 0; p < pack->prim_count; p++) {
            uint32_t light = pack->light_of_prim[p];
            pack->light_of_prim[p] = light == EC_NO_ID ? 0 : trail_of[light];
            if (light != EC_NO_ID) pack->prims[p].light_pdf_a = pack->lights[light].pdf_a;
        }
    }
    free(bounds);
    free(ids);
    free(trails);
    free(trail_of);
    return result;
}
