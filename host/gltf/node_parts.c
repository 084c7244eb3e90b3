#include "gltf/flatten_vertex.h"

#include <stdlib.h>
#include <string.h>

static const char *name_of(const ec_gltf *g, const ec_gltf_node *node)
{
    return node->name || node->mesh < 0 ? node->name : g->meshes[node->mesh].name;
}

/* Finds each node's root. Nodes form trees, as gltf_tree.c has checked. */
static void find_roots(const ec_gltf *g, uint32_t *roots)
{
    for (uint32_t i = 0; i < g->node_count; i++) roots[i] = i;
    for (uint32_t i = 0; i < g->node_count; i++)
        for (uint32_t k = 0; k < g->nodes[i].child_count; k++) roots[g->nodes[i].children[k]] = i;
    for (uint32_t i = 0; i < g->node_count; i++)
        while (roots[i] != roots[roots[i]]) roots[i] = roots[roots[i]];
}

ec_result ec_parts_start(ec_scene *s, const ec_gltf *g, uint32_t most, ec_error *err)
{
    s->parts = malloc(((size_t)most + 1) * sizeof *s->parts);
    s->node_names = calloc((size_t)g->node_count + 1, sizeof *s->node_names);
    s->node_roots = malloc(((size_t)g->node_count + 1) * sizeof *s->node_roots);
    bool ok = s->parts && s->node_names && s->node_roots;
    for (uint32_t i = 0; ok && i < g->node_count; i++) {
        const char *name = name_of(g, &g->nodes[i]);
        if (name) ok = (s->node_names[i] = strdup(name)) != NULL;
    }
    if (ok) find_roots(g, s->node_roots);
    return ok ? EC_OK : ec_fail(err, "%s: out of memory for %u nodes", g->path, g->node_count);
}

void ec_part_add(ec_scene *s, uint32_t first, uint32_t node)
{
    ec_part *last = s->part_count ? &s->parts[s->part_count - 1] : NULL;
    if (last && last->node == node) return;
    if (last && last->first == first) last->node = node; /* the last part has no triangles left */
    else s->parts[s->part_count++] = (ec_part){first, node};
}

int64_t ec_scene_node_of(const ec_scene *s, uint32_t id)
{
    uint32_t low = 0, high = s->part_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (s->parts[middle].first <= id) low = middle + 1;
        else high = middle;
    }
    return low && s->parts[low - 1].node != EC_NO_NODE ? (int64_t)s->parts[low - 1].node : -1;
}
