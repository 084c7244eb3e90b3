/* Chooses where to split a cell of the kd-tree. */
#include <math.h>

#include "accel/kd_internal.h"

#define STEPS 64

float ec_kd_leaf_cost(uint32_t count)
{
    return EC_KD_COST_BLOCK * (float)((count + 7) / 8);
}

/* Edges are in units of the cell's longest edge, so that nothing overflows. */
static float half_area(const float edge[3]) { return edge[0] * edge[1] + (edge[0] + edge[1]) * edge[2]; }

typedef struct chooser {
    float lo[3], edge[3], scale, area;
    ec_kd_split best;
} chooser;

static void weigh_one(chooser *c, int axis, float plane, uint32_t left, uint32_t right, int flat_left)
{
    float edge[3] = {c->edge[0], c->edge[1], c->edge[2]};
    edge[axis] = (plane - c->lo[axis]) * c->scale;
    float below = half_area(edge);
    edge[axis] = c->edge[axis] - edge[axis];
    float above = half_area(edge);
    float cost = 1.0f + (below * ec_kd_leaf_cost(left) + above * ec_kd_leaf_cost(right)) / c->area;
    if (left == 0 || right == 0) cost *= EC_KD_EMPTY;
    if (cost < c->best.cost) c->best = (ec_kd_split){cost, plane, axis, flat_left, left, right};
}

/* Weighs a plane. below: items that begin before it; flat: those that lie in it; above: those that end behind it. */
static void weigh(chooser *c, int axis, float plane, uint32_t below, uint32_t flat, uint32_t above)
{
    weigh_one(c, axis, plane, below + flat, above, 1);
    if (flat) weigh_one(c, axis, plane, below, above + flat, 0);
}

/* Shell's sort with Ciura's steps. */
static void sort(float *values, uint32_t count)
{
    static const uint32_t steps[] = {57, 23, 10, 4, 1};
    for (int s = 0; s < 5; s++)
        for (uint32_t step = steps[s], i = step; i < count; i++) {
            float value = values[i];
            uint32_t k = i;
            for (; k >= step && values[k - step] > value; k -= step) values[k] = values[k - step];
            values[k] = value;
        }
}

static void weigh_all(chooser *c, int axis, const ec_kd_item *items, uint32_t count, const ec_box *cell)
{
    float lo[EC_KD_EXACT], hi[EC_KD_EXACT], flat[EC_KD_EXACT];
    uint32_t flats = 0, i = 0, k = 0, f = 0;
    for (uint32_t n = 0; n < count; n++) {
        lo[n] = items[n].box.lo[axis];
        hi[n] = items[n].box.hi[axis];
        if (lo[n] == hi[n]) flat[flats++] = lo[n];
    }
    sort(lo, count);
    sort(hi, count);
    sort(flat, flats);
    while (i < count || k < count) {
        float plane = i < count && (k >= count || lo[i] < hi[k]) ? lo[i] : hi[k];
        uint32_t begun = i, in_plane = 0; /* items with lo < plane; then those with hi <= plane are over */
        while (i < count && lo[i] == plane) i++;
        while (k < count && hi[k] == plane) k++;
        while (f < flats && flat[f] < plane) f++;
        while (f < flats && flat[f] == plane) f++, in_plane++;
        if (plane > cell->lo[axis] && plane < cell->hi[axis]) weigh(c, axis, plane, begun, in_plane, count - k);
    }
}

/* Weighs planes at equal steps by bins of where items begin and end. The outer sides of all items are planes too, so that empty space is cut off
 * exactly. */
static void weigh_steps(chooser *c, int axis, const ec_kd_item *items, uint32_t count, const ec_box *cell)
{
    uint32_t begins[STEPS] = {0}, ends[STEPS] = {0};
    float lo = items[0].box.lo[axis], hi = items[0].box.hi[axis];
    uint32_t flat_lo = 0, flat_hi = 0;
    for (uint32_t n = 1; n < count; n++) {
        lo = fminf(lo, items[n].box.lo[axis]);
        hi = fmaxf(hi, items[n].box.hi[axis]);
    }
    double step = ((double)hi - lo) / STEPS;
    if (!(step > 0.0)) {
        if (lo > cell->lo[axis] && lo < cell->hi[axis]) weigh(c, axis, lo, 0, count, 0);
        return;
    }
    float per_step = (float)fmin(1.0 / step, 3e38);
    for (uint32_t n = 0; n < count; n++) {
        float a = (items[n].box.lo[axis] - lo) * per_step, b = (items[n].box.hi[axis] - lo) * per_step;
        begins[a < STEPS - 1 ? (int)a : STEPS - 1]++;
        ends[b < STEPS - 1 ? (int)b : STEPS - 1]++;
        flat_lo += items[n].box.hi[axis] == lo;
        flat_hi += items[n].box.lo[axis] == hi;
    }
    if (lo > cell->lo[axis]) weigh(c, axis, lo, 0, flat_lo, count - flat_lo);
    if (hi < cell->hi[axis]) weigh(c, axis, hi, count - flat_hi, flat_hi, 0);
    for (uint32_t i = 1, below = 0, over = 0; i < STEPS; i++) {
        below += begins[i - 1];
        over += ends[i - 1];
        float plane = (float)(lo + step * i);
        if (plane > cell->lo[axis] && plane < cell->hi[axis]) weigh(c, axis, plane, below, 0, count - over);
    }
}

ec_kd_split ec_kd_choose(const ec_kd_item *items, uint32_t count, const ec_box *cell)
{
    chooser c = {.best = {.cost = INFINITY}};
    double edge[3], longest = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        edge[axis] = (double)cell->hi[axis] - cell->lo[axis];
        longest = fmax(longest, edge[axis]);
        c.lo[axis] = cell->lo[axis];
    }
    c.scale = (float)fmin(1.0 / longest, 3e38);
    for (int axis = 0; axis < 3; axis++) c.edge[axis] = (float)(edge[axis] * (double)c.scale);
    c.area = half_area(c.edge);
    if (!(c.area > 0.0f) || !count) return c.best; /* a line or a point: splitting it saves no ray */
    for (int axis = 0; axis < 3; axis++) {
        if (count <= EC_KD_EXACT) weigh_all(&c, axis, items, count, cell);
        else weigh_steps(&c, axis, items, count, cell);
    }
    return c.best;
}
