/* From the top down by binned cost, as a BVH (Conty Estevez and Kulla 2018). */
#include "pack/light_tree.h"

#include <math.h>
#include <stdlib.h>

#define BINS 12
#define MANY 4096 /* lamps: of so many only the longest axis is tried */
#define FEW 512   /* lamps: so many are not worth another thread */

typedef struct builder {
    const ec_light_bounds *bounds;
    const uint32_t *ids;
    uint32_t *order; /* indices of bounds: a node's stand together */
    ec_light_node *nodes;
    uint32_t *trails;
    double most_power;
} builder;

typedef struct task {
    uint32_t node, first, end, depth, trail;
    uint32_t free; /* nodes from here on are for those below: two for each lamp but the first */
} task;

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
        low = fmin(low, m), high = fmax(high, m);
    }
    if (!(high > low)) return;
    ec_light_bounds bins[BINS] = {{.power = 0}}, sum = {.power = 0};
    for (uint32_t i = t->first; i < t->end; i++) {
        const ec_light_bounds *one = &b->bounds[b->order[i]];
        ec_light_bounds_add(&bins[bin_of(one, axis, low, high)], one);
    }
    for (int k = BINS - 1; k > 0; k--) { /* beside an empty bin a plane parts what the one before it does */
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

/* Where the second child's lamps begin; its lamps come to stand there. Long boxes are rather cut across (the paper's regulariser). */
static uint32_t split(builder *b, const task *t, const ec_light_bounds *all)
{
    uint32_t half = t->first + (t->end - t->first) / 2, levels = 0;
    while (((uint64_t)1 << levels) < t->end - t->first) levels++;
    if (t->depth + levels >= EC_LIGHT_DEPTH_MOST) return half; /* in halves it just fits the trail */
    if (t->end - t->first == 2) return half;
    plane best = {.axis = -1};
    double longest = 0;
    for (int k = 0; k < 3; k++) longest = fmax(longest, all->high[k] - all->low[k]);
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

/* Where a node's descendants stand depends on how many there are, not on who writes them first. */
static void grow(builder *b, task t)
{
    const ec_light_bounds all = around(b, t.first, t.end);
    ec_light_node *node = &b->nodes[t.node];
    *node = ec_light_bounds_node(&all, b->most_power);
    if (t.end - t.first == 1) {
        const uint32_t lamp = b->order[t.first];
        node->link = EC_LIGHT_LEAF | b->ids[lamp];
        b->trails[lamp] = t.trail;
        return;
    }
    const uint32_t at = split(b, &t, &all), child = t.free, left = 2 * (at - t.first - 1);
    node->link = child;
    const task first = {child, t.first, at, t.depth + 1, t.trail, child + 2};
    const task second = {child + 1, at, t.end, t.depth + 1, t.trail | 1u << t.depth, child + 2 + left};
#pragma omp task if (first.end - first.first > FEW)
    grow(b, first);
    grow(b, second);
}

ec_result ec_light_tree_build(const ec_light_bounds *bounds, const uint32_t *ids, uint32_t count, ec_light_node *nodes,
                              uint32_t *trails, ec_error *err)
{
    builder b = {bounds, ids, malloc((size_t)count * sizeof *b.order), nodes, trails, 0};
    if (!b.order) return ec_fail(err, "out of memory for a tree of %u lamps", count);
    for (uint32_t i = 0; i < count; i++) {
        b.order[i] = i;
        b.most_power = fmax(b.most_power, bounds[i].power);
    }
#pragma omp parallel if (count > FEW)
#pragma omp single
    grow(&b, (task){0, 0, count, 0, 0, 1});
    free(b.order);
    return EC_OK;
}
