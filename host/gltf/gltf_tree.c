/* Walks the node tree without recursion, since a file may be a chain of a million nodes. */
#include "gltf/gltf_tree.h"
#include "base/freed.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>

ec_label ec_label_of(const char *list, uint32_t index, const char *name)
{
    ec_label label;
    const char *quote = name ? "\"" : "";
    snprintf(label.text, sizeof label.text, "%s[%u]%s%s%.*s%s", list, index, name ? " " : "", quote, EC_CUT(name ? name : "", 80), quote);
    return label;
}

/* Finds parents; parent[i] is -1 for roots. */
static ec_result find_parents(const ec_gltf *g, int32_t *parent, ec_error *err)
{
    for (uint32_t i = 0; i < g->node_count; i++) parent[i] = -1;
    for (uint32_t i = 0; i < g->node_count; i++) {
        for (uint32_t c = 0; c < g->nodes[i].child_count; c++) {
            int32_t child = g->nodes[i].children[c];
            if (parent[child] >= 0)
                return ec_fail(err, "%s: %s is a child of nodes[%d] and of nodes[%u]; glTF's nodes must form a tree",
                               g->path, ec_label_of("nodes", (uint32_t)child, g->nodes[child].name).text, parent[child], i);
            parent[child] = (int32_t)i;
        }
    }
    return EC_OK;
}

ec_result ec_gltf_node_above(const ec_gltf *g, int32_t node, bool (*is)(const ec_gltf_node *), int32_t *found,
                             ec_error *err)
{
    EC_FREED int32_t *parent = malloc(((size_t)g->node_count + 1) * sizeof *parent);
    if (!parent) return ec_fail(err, "%s: out of memory for %u nodes", g->path, g->node_count);
    EC_TRY(find_parents(g, parent, err));
    while (node >= 0 && !is(&g->nodes[node])) node = parent[node];
    *found = node;
    return EC_OK;
}

/* Fails if there is a cycle. As every node has at most one parent, going up from a node in a cycle returns to it. */
static ec_result check_cycles(const ec_gltf *g, const int32_t *parent, uint32_t *seen_from, ec_error *err)
{
    for (uint32_t i = 0; i < g->node_count; i++) {
        int32_t at = (int32_t)i;
        while (at >= 0 && !seen_from[at]) {
            seen_from[at] = i + 1;
            at = parent[at];
        }
        if (at >= 0 && seen_from[at] == i + 1)
            return ec_fail(err, "%s: the node tree has a cycle through %s; a node cannot contain itself", g->path,
                           ec_label_of("nodes", (uint32_t)at, g->nodes[at].name).text);
    }
    return EC_OK;
}

void ec_placement_compose(const ec_placement *parent, const double m[16], ec_placement *out)
{
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) sum += (parent ? parent->linear[3 * row + k] : row == k) * m[4 * column + k];
            out->linear[3 * row + column] = sum;
        }
        double origin = parent ? parent->origin[row] : 0;
        for (int k = 0; k < 3; k++) origin += (parent ? parent->linear[3 * row + k] : row == k) * m[12 + k];
        out->origin[row] = origin;
    }
}

static void place(const ec_gltf *g, int32_t node, const ec_placement *parent, ec_placement *out)
{
    bool hidden = g->nodes[node].hidden || (parent && parent->hidden);
    *out = (ec_placement){.node = node, .mesh = hidden ? -1 : g->nodes[node].mesh, .hidden = hidden};
    out->reached = g->animated && (g->animated[node] || (parent && parent->reached));
    out->moves = g->blurs && out->reached;
    ec_placement_compose(parent, g->nodes[node].local, out);
}

static ec_result walk(const ec_gltf *g, bool *visited, ec_placement_list *list, ec_error *err)
{
    for (uint32_t i = 0; i < g->root_count; i++) {
        if (visited[g->roots[i]])
            return ec_fail(err, "%s: the scene lists nodes[%d] twice", g->path, g->roots[i]);
        visited[g->roots[i]] = true;
        place(g, g->roots[i], NULL, &list->items[list->count++]);
    }
    for (uint32_t done = 0; done < list->count; done++) {
        const ec_gltf_node *node = &g->nodes[list->items[done].node];
        for (uint32_t c = 0; c < node->child_count; c++) {
            if (visited[node->children[c]])
                return ec_fail(err, "%s: the scene lists nodes[%d], which is also a child of nodes[%d]", g->path,
                               node->children[c], list->items[done].node);
            visited[node->children[c]] = true;
            place(g, node->children[c], &list->items[done], &list->items[list->count++]);
        }
    }
    return EC_OK;
}

ec_result ec_gltf_place_nodes(const ec_gltf *g, ec_placement_list *list, ec_error *err)
{
    size_t count = (size_t)g->node_count + 1;
    EC_FREED int32_t *parent = malloc(count * sizeof *parent);
    EC_FREED uint32_t *seen_from = calloc(count, sizeof *seen_from);
    EC_FREED bool *visited = calloc(count, sizeof *visited);
    *list = (ec_placement_list){.items = malloc(count * sizeof *list->items), .room = (uint32_t)count};
    if (!parent || !seen_from || !visited || !list->items)
        return ec_fail(err, "%s: out of memory for %u nodes", g->path, g->node_count);
    EC_TRY(find_parents(g, parent, err));
    EC_TRY(check_cycles(g, parent, seen_from, err));
    return walk(g, visited, list, err);
}

ec_result ec_placement_append(ec_placement_list *list, const ec_placement *placement, ec_error *err)
{
    ec_placement copy = *placement; /* placement may point into the list */
    if (list->count == list->room) {
        size_t room = 2 * (size_t)list->room + 8;
        ec_placement *grown = room <= INT32_MAX ? realloc(list->items, room * sizeof *grown) : NULL;
        if (!grown) return ec_fail(err, "out of memory for more than %u instances", list->count);
        list->items = grown;
        list->room = (uint32_t)room;
    }
    list->items[list->count++] = copy;
    return EC_OK;
}

void ec_gltf_compose(const double t[3], const double q[4], const double s[3], double m[16])
{
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double x = 0, y = 0, z = 0, w = 1;
    if (length > 0) x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
    const double r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),
                         2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
                         2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    memset(m, 0, 16 * sizeof *m);
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++) m[4 * column + row] = r[3 * column + row] * s[column];
        m[12 + column] = t[column];
    }
    m[15] = 1;
}

double ec_gltf_determinant(const double m[9])
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

void ec_gltf_normal_matrix(const double linear[9], double out[9])
{
    double largest = 0, m[9];
    for (int i = 0; i < 9; i++) largest = fmax(largest, fabs(linear[i]));
    if (!(largest > 0) || !isfinite(largest)) largest = 1;
    for (int i = 0; i < 9; i++) m[i] = linear[i] / largest; /* products then neither overflow nor vanish */
    double sign = ec_gltf_determinant(m) < 0 ? -1 : 1;
    for (int row = 0; row < 3; row++) {
        const double *a = m + 3 * ((row + 1) % 3), *b = m + 3 * ((row + 2) % 3);
        out[3 * row + 0] = sign * (a[1] * b[2] - a[2] * b[1]);
        out[3 * row + 1] = sign * (a[2] * b[0] - a[0] * b[2]);
        out[3 * row + 2] = sign * (a[0] * b[1] - a[1] * b[0]);
    }
}
