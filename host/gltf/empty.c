/* Decides whether a scene without any triangle is an error. It is not if the file hides its surfaces, or scales them to nothing at this moment: the
 * picture then shows only the surroundings. A file without surfaces has nothing to show. */
#include "gltf/flatten_vertex.h"

#include <stdio.h>
#include <string.h>

static bool is_hidden(const ec_gltf_node *node) { return node->hidden; }

static bool is_flat(const ec_gltf_node *node)
{
    double linear[9];
    for (int i = 0; i < 9; i++) linear[i] = node->local[4 * (i / 3) + i % 3];
    return ec_gltf_determinant(linear) == 0;
}

static ec_result add_cause(const ec_gltf *g, int32_t node, bool hidden, char *text, size_t size, ec_error *err)
{
    int32_t cause;
    size_t used = strlen(text);
    EC_TRY(ec_gltf_node_above(g, node, hidden ? is_hidden : is_flat, &cause, err));
    const char *how = hidden ? "hidden by" : cause < 0 ? "without area at" : "scaled to nothing by";
    uint32_t at = (uint32_t)(cause < 0 ? node : cause);
    snprintf(text + used, size - used, "%s%s %s", used ? ", " : "", how, ec_label_of("nodes", at, g->nodes[at].name).text);
    return EC_OK;
}

ec_result ec_flatten_empty(const ec_flattener *f, const ec_gltf *g, const ec_placement_list *placements)
{
    const ec_scene *s = f->scene;
    int32_t hidden = -1, flat = -1; /* the first node of each kind */
    char why[320] = "";
    for (uint32_t i = placements->count; i-- > 0;) {
        const ec_placement *at = &placements->items[i];
        if (at->hidden && g->nodes[at->node].mesh >= 0) hidden = at->node;
        if (at->mesh >= 0 && g->animated && s->dropped_degenerate) flat = at->node;
    }
    if (hidden < 0 && flat < 0) {
        if (!f->triangle_bound) return ec_fail(f->err, "%s: nothing to render: the scene has no triangles", g->path);
        return ec_fail(f->err, "%s: nothing to render: of %llu triangles, %u have no area and %u have positions that "
                       "are NaN, infinite or beyond 1e18", g->path, (unsigned long long)f->triangle_bound, s->dropped_degenerate, s->dropped_nonfinite);
    }
    if (hidden >= 0) EC_TRY(add_cause(g, hidden, true, why, sizeof why, f->err));
    if (flat >= 0) EC_TRY(add_cause(g, flat, false, why, sizeof why, f->err));
    ec_warn(f->log, "%s: no surface shows: %s", g->path, why);
    return EC_OK;
}
