/* Fits the light tree into the table of lights. Lamps are triangles, points and spots: lights at infinity keep their probabilities, and the tree gets
 * the sum of the lamps'. */
#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "pack/casters.h"
#include "pack/distribution.h"
#include "pack/light_bounds.h"
#include "pack/light_order.h"
#include "pack/light_tree.h"
#include "pack/pack.h"

static uint32_t lamp_count(const ec_pack *pack)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pack->light_count; i++) count += !ec_light_is_far(&pack->lights[i]);
    return count;
}

/* A tree takes time at every surface (a sixth to three quarters of a sample's). That pays off if lamps are in different places; the triangles of a
 * bulb, or the two of a large panel, are all equally near, and power alone is as good. */
ec_result ec_pack_wants_light_tree(const ec_pack *pack, const uint32_t *root, bool *wants, ec_error *err)
{
    const uint32_t count = pack->light_count;
    const double radius2 = (double)pack->scene_radius * (double)pack->scene_radius;
    uint32_t lamps = 0;
    double size2 = 0;
    ec_light_bounds all = {.power = 0};
    *wants = false;
    if (lamp_count(pack) < 2 || pack->lamp_share < EC_LIGHT_TREE_LEAST) return EC_OK;
    EC_FREED ec_light_bounds *bodies = calloc(count, sizeof *bodies);
    if (!bodies) return ec_fail(err, "out of memory for %u lights", count);
    for (uint32_t i = 0; i < count; i++) {
        if (ec_light_is_far(&pack->lights[i])) continue;
        const ec_light_bounds one = ec_light_bounds_of(&pack->lights[i], pack->lights[i].pmf);
        ec_light_bounds_add(&bodies[root[i]], &one);
        ec_light_bounds_add(&all, &one);
    }
    for (uint32_t i = 0; i < count; i++) {
        if (ec_light_is_far(&pack->lights[i])) continue;
        const ec_light_bounds one = ec_light_bounds_of(&pack->lights[i], pack->lights[i].pmf);
        const double body2 = ec_light_bounds_size2(&bodies[root[i]]);
        const bool is_large = body2 > EC_LIGHT_TREE_BODY * EC_LIGHT_TREE_BODY * radius2;
        size2 += one.power * (is_large ? ec_light_bounds_size2(&one) : body2);
        lamps += is_large || root[i] == i;
    }
    const double spread2 = ec_light_bounds_size2(&all);
    *wants = lamps > 1 && spread2 > EC_LIGHT_TREE_SPREAD * EC_LIGHT_TREE_SPREAD * radius2
             && (lamps >= EC_LIGHT_TREE_MANY || spread2 * all.power > EC_LIGHT_TREE_SIZES * EC_LIGHT_TREE_SIZES * size2);
    return EC_OK;
}

/* Changes the table to lights at infinity and one last entry for all lamps, which has half of the numbers or all; the tree gets one for every two of
 * them. Densities become those of a lamp that has been chosen, as the tree's probability includes that of the entry. */
static void share_out(ec_pack *pack)
{
    uint32_t far = 0;
    while (ec_light_is_far(&pack->lights[far])) far++;
    pack->light_choices = far + 1;
    pack->light_tree_numbers = (uint32_t)((((uint64_t)1 << 32) - pack->light_shares[far].first) / 2);
    ec_distribution_guide(pack->light_choices, pack->light_shares);
    for (uint32_t i = far; i < pack->light_count; i++) {
        ec_light_data *l = &pack->lights[i];
        if (l->pmf > 0) l->pdf_a = (float)((double)l->pdf_a / l->pmf);
        l->pmf = 1.0f;
    }
}

ec_result ec_pack_light_tree(ec_pack *pack, ec_error *err)
{
    uint32_t lamps = lamp_count(pack), n = 0;
    if (lamps < 2) return EC_OK;
    EC_FREED ec_light_bounds *bounds = malloc(lamps * sizeof *bounds);
    EC_FREED uint32_t *ids = malloc(lamps * sizeof *ids);
    EC_FREED uint32_t *trails = malloc(lamps * sizeof *trails);
    EC_FREED uint32_t *trail_of = calloc(pack->light_count, sizeof *trail_of);
    EC_FREED ec_bulb *bulbs = malloc((pack->bulb_count + (size_t)1) * sizeof *bulbs);
    if (!bounds || !ids || !trails || !trail_of || !bulbs) return ec_fail(err, "out of memory for a tree of %u lamps", lamps);
    for (uint32_t i = 0; i < pack->light_count; i++) {
        if (ec_light_is_far(&pack->lights[i])) continue;
        bounds[n] = ec_light_bounds_of(&pack->lights[i], pack->lights[i].pmf);
        ids[n++] = i;
    }
    for (uint32_t i = 0; i < pack->bulb_count; i++) bulbs[i] = (ec_bulb){pack->bulbs[i].first - ids[0], pack->bulbs[i].count};
    const ec_light_set set = {lamps, bounds, ids, pack->bulb_count, bulbs};
    const size_t nodes = ec_light_tree_nodes(&set);
    pack->light_tree = malloc(nodes * sizeof *pack->light_tree);
    if (!pack->light_tree) return ec_fail(err, "out of memory for a tree of %u lamps", lamps);
    EC_TRY(ec_light_tree_build(&set, pack->light_tree, trails, err));
    share_out(pack);
    pack->light_node_count = (uint32_t)nodes;
    for (uint32_t i = 0; i < lamps; i++) trail_of[ids[i]] = trails[i];
    if (pack->emission) memcpy(pack->emission + ec_emission_trails(pack->light_count), trail_of, pack->light_count * sizeof *trail_of);
    for (uint32_t p = 0; p < pack->prim_count; p++) {
        uint32_t light = pack->light_of_prim[p];
        pack->light_of_prim[p] = light == EC_NO_ID ? 0 : trail_of[light];
        if (light != EC_NO_ID) pack->prims[p].light_pdf_a = pack->lights[light].pdf_a;
    }
    return EC_OK;
}
