/* EXT_mesh_gpu_instancing: places a node's mesh many times, each by translation, rotation and scale in the node's frame. */
#include <stdio.h>

#include "gltf/gltf_tree.h"

#define IMPLIED_PLACES 65536u /* the most instances that no bytes stand for: a tiny file could claim any number */

static ec_result open_attribute(ec_gltf *g, int32_t node, int32_t accessor, const char *name, uint32_t components,
                                uint64_t *count, ec_error *err)
{
    char what[96];
    if (accessor < 0) return EC_OK;
    snprintf(what, sizeof what, "nodes[%d] EXT_mesh_gpu_instancing %s", node, name);
    EC_TRY(ec_gltf_accessor_open(g, accessor, what, err));
    const ec_gltf_accessor *a = &g->accessors[accessor];
    if (a->components != components || !(a->component_type == EC_GLTF_FLOAT || a->normalized))
        return ec_fail(err, "%s: %s: accessors[%d] must hold vectors of %u floats or normalised integers", g->path, what,
                       accessor, components);
    if (a->view < 0 && a->count > IMPLIED_PLACES)
        return ec_fail(err, "%s: %s: accessors[%d] has no bufferView for its %llu elements; at most %u may do without",
                       g->path, what, accessor, (unsigned long long)a->count, IMPLIED_PLACES);
    if (*count && *count != a->count)
        return ec_fail(err, "%s: %s: accessors[%d] has %llu elements, but another attribute has %llu", g->path, what, accessor,
                       (unsigned long long)a->count, (unsigned long long)*count);
    *count = a->count;
    return EC_OK;
}

static void read(const ec_gltf *g, int32_t accessor, uint64_t i, uint32_t count, double *out)
{
    float values[4];
    if (accessor < 0) return;
    ec_gltf_accessor_floats(&g->accessors[accessor], i, count, values);
    for (uint32_t k = 0; k < count; k++) out[k] = (double)values[k];
}

static ec_result place(ec_gltf *g, uint32_t index, ec_placement_list *placements, ec_error *err)
{
    const ec_placement node = placements->items[index];
    const ec_gltf_instancing *of = &g->nodes[node.node].instances;
    uint64_t count = 0;
    EC_TRY(open_attribute(g, node.node, of->translation, "TRANSLATION", 3, &count, err));
    EC_TRY(open_attribute(g, node.node, of->rotation, "ROTATION", 4, &count, err));
    EC_TRY(open_attribute(g, node.node, of->scale, "SCALE", 3, &count, err));
    if (!count) return EC_OK; /* attributes that an application defines say nothing of places */
    placements->items[index].mesh = -1;
    for (uint64_t i = 0; i < count; i++) {
        double translation[3] = {0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1}, local[16];
        ec_placement at = {.node = node.node, .mesh = node.mesh, .reached = node.reached, .moves = node.moves, .extra = true};
        read(g, of->translation, i, 3, translation);
        read(g, of->rotation, i, 4, rotation);
        read(g, of->scale, i, 3, scale);
        ec_gltf_compose(translation, rotation, scale, local);
        ec_placement_compose(&node, local, &at);
        EC_TRY(ec_placement_append(placements, &at, err));
    }
    return EC_OK;
}

ec_result ec_gltf_place_instances(ec_gltf *g, ec_placement_list *placements, const ec_log *log, ec_error *err)
{
    uint32_t count = placements->count;
    for (uint32_t i = 0; i < count; i++) {
        const ec_gltf_node *node = &g->nodes[placements->items[i].node];
        if (!node->instances.used || placements->items[i].mesh < 0) continue;
        if (node->skin < 0) EC_TRY(place(g, i, placements, err));
        else ec_warn(log, "%s: nodes[%d] has a skin, which cannot be instanced; its instances are left out", g->path,
                     placements->items[i].node);
    }
    return EC_OK;
}
