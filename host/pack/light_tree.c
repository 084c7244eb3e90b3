/* Splits top-down by binned cost, as for a BVH (Conty Estevez and Kulla 2018). */
#include "pack/light_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/vec3.h"
#include "pack/distribution.h"
#include "pack/lamp_pairs.h"

#define BINS 12
#define MANY 4096 /* lamps: of more, only the longest axis is tried */
#define FEW 512   /* lamps: fewer are not worth another thread */

/* A tree of items: bulbs, and lamps outside of them; or, below a bulb, its lamps. */
typedef struct builder {
    const ec_light_set *set;
    const ec_light_bounds *bounds; /* of items */
    const ec_bulb *items;          /* the lamps of each item; NULL: one each */
    const struct builder *below;   /* builder of the trees of bulbs' lamps */
    uint32_t below_levels;         /* levels of the deepest bulb */
    uint32_t *order;               /* indices into bounds, those of a node side by side */
    ec_light_node *nodes;
    uint32_t *trails;
    double most_power;
} builder;

typedef struct task {
    uint32_t node, first, end, depth, trail;
    uint32_t free;   /* first node that is free for descendants */
    uint32_t record; /* number of these, after the first two, that are reserved */
} task;

static uint32_t levels_of(uint32_t count)
{
    uint32_t levels = 0;
    while (((uint64_t)1 << levels) < count) levels++;
    return levels;
}

static uint32_t record_nodes(uint32_t lamps) { return (2 + 2 * lamps + EC_LIGHT_NODE_WORDS - 1) / EC_LIGHT_NODE_WORDS; }

/* Returns the number of nodes below an item with this many lamps. */
static uint32_t nodes_below(uint32_t lamps) { return lamps > 1 ? 2 * (lamps - 1) + record_nodes(lamps) : 0; }

static double middle(const ec_light_bounds *b, int axis) { return 0.5 * (b->low[axis] + b->high[axis]); }

static uint32_t bin_of(const ec_light_bounds *b, int axis, double low, double high)
{
    double place = BINS * ((middle(b, axis) - low) / (high - low));
    return place < BINS - 1 ? (uint32_t)fmax(place, 0) : BINS - 1;
}

typedef struct plane {
    int axis; /* -1: none */
    uint32_t bin;
    double low, high, cost;
} plane;

static ec_light_bounds around(const builder *b, uint32_t first, uint32_t end)
{
    ec_light_bounds all = {.power = 0};
    for (uint32_t i = first; i < end; i++) ec_light_bounds_add(&all, &b->bounds[b->order[i]]);
    return all;
}

static void try_axis(const builder *b, const task *t, int axis, double stretch, plane *best)
{
    double low = INFINITY, high = -INFINITY, above[BINS];
    for (uint32_t i = t->first; i < t->end; i++) {
        double m = middle(&b->bounds[b->order[i]], axis);
        low = ec_lesser(low, m), high = ec_greater(high, m);
    }
    if (!(high > low)) return;
    ec_light_bounds bins[BINS] = {{.power = 0}}, sum = {.power = 0};
    for (uint32_t i = t->first; i < t->end; i++) {
        const ec_light_bounds *one = &b->bounds[b->order[i]];
        ec_light_bounds_add(&bins[bin_of(one, axis, low, high)], one);
    }
    for (int k = BINS - 1; k > 0; k--) { /* beside an empty bin a plane splits like the one before */
        ec_light_bounds_add(&sum, &bins[k]);
        above[k] = bins[k].power > 0 || k == BINS - 1 ? ec_light_bounds_cost(&sum) : above[k + 1];
    }
    sum = (ec_light_bounds){.power = 0};
    for (uint32_t k = 0; k < BINS - 1; k++) {
        if (!(bins[k].power > 0)) continue;
        ec_light_bounds_add(&sum, &bins[k]);
        double cost = stretch * (ec_light_bounds_cost(&sum) + above[k + 1]);
        if (best->axis < 0 || cost < best->cost) *best = (plane){axis, k, low, high, cost};
    }
}

/* Partitions a node's lamps, and returns where the second child's begin. Prefers cutting long boxes across (the paper's regulariser). */
static uint32_t split(const builder *b, const task *t, const ec_light_bounds *all)
{
    uint32_t half = t->first + (t->end - t->first) / 2;
    if (t->depth + levels_of(t->end - t->first) + b->below_levels >= EC_LIGHT_DEPTH_MOST) return half; /* halving just fits into the trail */
    if (t->end - t->first == 2) return half;
    plane best = {.axis = -1};
    double longest = 0;
    for (int k = 0; k < 3; k++) longest = ec_greater(longest, all->high[k] - all->low[k]);
    for (int k = 0; k < 3; k++)
        if (all->high[k] > all->low[k] && (t->end - t->first < MANY || all->high[k] - all->low[k] == longest))
            try_axis(b, t, k, longest / (all->high[k] - all->low[k]), &best);
    if (best.axis < 0) return half;
    uint32_t at = t->first;
    for (uint32_t i = t->first; i < t->end; i++) {
        uint32_t one = b->order[i];
        if (bin_of(&b->bounds[one], best.axis, best.low, best.high) > best.bin) continue;
        b->order[i] = b->order[at];
        b->order[at++] = one;
    }
    return at > t->first && at < t->end ? at : half;
}

/* Writes what kernels/lib/bulb.h reads. */
static void write_record(const ec_light_set *set, const ec_bulb *bulb, ec_light_node *record)
{
    ec_distribution_entry table[EC_LAMP_PAIRS_MOST];
    double weights[EC_LAMP_PAIRS_MOST];
    uint32_t *words = (uint32_t *)memset(record, 0, record_nodes(bulb->count) * sizeof *record);
    for (uint32_t i = 0; i < bulb->count; i++) weights[i] = set->bounds[bulb->first + i].power;
    ec_distribution_build(weights, bulb->count, table, weights);
    words[0] = set->ids[bulb->first];
    words[1] = bulb->count;
    for (uint32_t i = 0; i < bulb->count; i++) {
        words[2 + i] = table[i].first;
        words[2 + bulb->count + i] = table[i].guide;
    }
}

static void grow(const builder *b, task t);

static void grow_item(const builder *b, const task *t)
{
    const uint32_t item = b->order[t->first], lamp = b->items ? b->items[item].first : item, count = b->items ? b->items[item].count : 1;
    ec_light_node *node = &b->nodes[t->node];
    if (count == 1) {
        node->link = EC_LIGHT_LEAF | b->set->ids[lamp];
        b->trails[lamp] = t->trail;
        return;
    }
    grow(b->below, (task){t->node, lamp, lamp + count, t->depth, t->trail, t->free, record_nodes(count)});
    node->flags |= EC_LIGHT_NODE_BULB;
    write_record(b->set, &b->items[item], node + (node->link + 2 - t->node));
}

/* Builds a node and its descendants, whose places depend on their number only, not on which thread is first. */
static void grow(const builder *b, task t)
{
    const ec_light_bounds all = around(b, t.first, t.end);
    ec_light_node *node = &b->nodes[t.node];
    *node = ec_light_bounds_node(&all, b->most_power);
    if (t.end - t.first == 1) {
        grow_item(b, &t);
        return;
    }
    const uint32_t at = split(b, &t, &all), child = t.free, free = child + 2 + t.record;
    uint32_t left = 2 * (at - t.first - 1);
    for (uint32_t i = t.first; b->items && i < at; i++) left += nodes_below(b->items[b->order[i]].count);
    node->link = child;
    const task first = {child, t.first, at, t.depth + 1, t.trail, free, 0};
    const task second = {child + 1, at, t.end, t.depth + 1, t.trail | 1u << t.depth, free + left, 0};
#pragma omp task if (first.end - first.first > FEW)
    grow(b, first);
    grow(b, second);
}

size_t ec_light_tree_nodes(const ec_light_set *set)
{
    size_t nodes = 2 * (size_t)set->count - 1;
    for (uint32_t i = 0; i < set->bulb_count; i++) nodes += record_nodes(set->bulbs[i].count);
    return nodes;
}

/* Lists bulbs and the lamps between them. items, bounds: the caller's, room for one per lamp. */
static uint32_t list_items(const ec_light_set *set, ec_bulb *items, ec_light_bounds *bounds, uint32_t *levels)
{
    uint32_t n = 0, bulb = 0;
    *levels = 0;
    for (uint32_t i = 0; i < set->count; n++) {
        const bool is_bulb = bulb < set->bulb_count && set->bulbs[bulb].first == i;
        items[n] = is_bulb ? set->bulbs[bulb++] : (ec_bulb){i, 1};
        bounds[n] = (ec_light_bounds){.power = 0};
        for (const uint32_t end = i + items[n].count; i < end; i++) ec_light_bounds_add(&bounds[n], &set->bounds[i]);
        if (is_bulb && levels_of(items[n].count) > *levels) *levels = levels_of(items[n].count);
    }
    return n;
}

ec_result ec_light_tree_build(const ec_light_set *set, ec_light_node *nodes, uint32_t *trails, ec_error *err)
{
    const size_t count = set->count;
    EC_FREED uint32_t *order = malloc(2 * count * sizeof *order);
    EC_FREED ec_bulb *items = malloc(count * sizeof *items);
    EC_FREED ec_light_bounds *bounds = malloc(count * sizeof *bounds);
    if (!order || !items || !bounds) return ec_fail(err, "out of memory for a tree of %u lamps", set->count);
    builder lamps = {.set = set, .bounds = set->bounds, .order = order, .nodes = nodes, .trails = trails};
    for (uint32_t i = 0; i < count; i++) {
        order[i] = order[count + i] = i;
        lamps.most_power = fmax(lamps.most_power, set->bounds[i].power);
    }
    builder top = lamps;
    top.bounds = bounds;
    top.items = items;
    top.below = &lamps;
    top.order = order + count;
    const uint32_t item_count = list_items(set, items, bounds, &top.below_levels);
#pragma omp parallel if (count > FEW)
#pragma omp single
    grow(&top, (task){0, 0, item_count, 0, 0, 1, 0});
    return EC_OK;
}
