/* Puts three levels of the binary kd-tree into one node of the kernels. */
#include <stdlib.h>
#include <string.h>

#include "accel/build_internal.h"
#include "accel/kd_internal.h"

typedef struct collapse {
    const ec_kd_binary *tree;
    ec_kd_node *nodes;
    uint32_t count, room;
} collapse;

static uint32_t add_node(collapse *c)
{
    if (!ec_reserve_lines(&c->nodes, &c->room, c->count, c->count + 1ull, sizeof *c->nodes)) return 0;
    ec_kd_node *n = &c->nodes[c->count];
    memset(n, 0, sizeof *n);
    for (int k = 0; k < 7; k++) n->axes |= EC_KD_NO_PLANE << 2 * k;
    for (int k = 0; k < 8; k++) n->child[k] = EC_NO_CHILD;
    return ++c->count; /* one more than its index: 0 is a failure */
}

/* Makes a child for `count` blocks from `first` on: a leaf or, if they are too many, a node that divides nothing. */
static int set_leaf(collapse *c, uint32_t at, uint32_t slot, uint32_t first, uint32_t count)
{
    if (count <= EC_KD_LEAF_MOST) {
        if (count) c->nodes[at].child[slot] = EC_LEAF_BIT | first << 6 | count;
        return 1;
    }
    uint32_t below = add_node(c), share = EC_KD_LEAF_MOST;
    if (!below) return 0;
    c->nodes[at].child[slot] = below - 1;
    while (share < (count + 7) / 8) share *= 8;
    for (uint32_t k = 0; k < 8 && count; k++) {
        uint32_t part = count < share ? count : share;
        if (!set_leaf(c, below - 1, k, first, part)) return 0;
        first += part;
        count -= part;
    }
    return 1;
}

static int set_node(collapse *c, uint32_t at, uint32_t slot, uint32_t index);

/* Puts the subtree at `index` into the children [slot, slot + 2^levels) of a node, below its plane number `plane`. */
static int spread(collapse *c, uint32_t at, uint32_t plane, uint32_t slot, int levels, uint32_t index)
{
    const ec_kd_binary *from = &c->tree[index];
    if (from->axis == EC_KD_NO_PLANE) return set_leaf(c, at, slot, from->first, from->index);
    if (levels == 0) return set_node(c, at, slot, index);
    c->nodes[at].plane[plane] = from->plane;
    c->nodes[at].axes ^= (EC_KD_NO_PLANE ^ from->axis) << 2 * plane;
    return spread(c, at, 2 * plane + 1, slot, levels - 1, from->index) &&
           spread(c, at, 2 * plane + 2, slot + (1u << (levels - 1)), levels - 1, from->index + 1);
}

static int set_node(collapse *c, uint32_t at, uint32_t slot, uint32_t index)
{
    uint32_t below = add_node(c);
    if (!below) return 0;
    c->nodes[at].child[slot] = below - 1;
    return spread(c, below - 1, 0, 0, 3, index);
}

ec_kd_node *ec_kd_collapse(const ec_kd_binary *tree, uint32_t *node_count)
{
    collapse c = {.tree = tree};
    if (!add_node(&c) || !spread(&c, 0, 0, 0, 3, 0)) {
        free(c.nodes);
        return NULL;
    }
    *node_count = c.count;
    return c.nodes;
}
