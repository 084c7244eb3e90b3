/* tier: quick */
/* The host's light tree: every lamp is at the end of its trail, within every node above it; each bulb is one node; bytes are reproducible;
 * depth and time are bounded. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "pack/light_tree.h"
#include "support/test.h"

typedef struct forest {
    uint32_t count;
    ec_light_data *lamps;
    ec_light_bounds *bounds;
    uint32_t *ids, *trails;
    ec_light_node *nodes;
} forest;

enum { SCATTERED, IN_A_ROW, ON_A_POINT, GROWING };

static forest make(uint32_t count, int shape)
{
    forest f = {count, calloc(count, sizeof *f.lamps), calloc(count, sizeof *f.bounds), calloc(count, 4), calloc(count, 4),
                calloc(3 * (size_t)count, sizeof *f.nodes)};
    uint64_t state = 5;
    if (!f.lamps || !f.bounds || !f.ids || !f.trails || !f.nodes) exit(1);
    for (uint32_t i = 0; i < count; i++) {
        ec_light_data *l = &f.lamps[i];
        double at[3] = {0, 0, 0}, size = shape == ON_A_POINT ? 1 : 0.1;
        for (int k = 0; k < 3; k++) {
            if (shape == SCATTERED) at[k] = ec_random_unit(&state);
            if (shape == IN_A_ROW && k == 0) at[k] = i;
            if (shape == GROWING) at[k] = pow(1.05, fmin(i, 1500)) * ec_random_unit(&state); /* each bin contains nearly all */
        }
        for (int k = 0; k < 3; k++) {
            l->a[k] = (float)at[k];
            l->b[k] = (float)(at[k] + size * (shape == ON_A_POINT ? k == 0 : ec_random_unit(&state)));
            l->c[k] = (float)(at[k] + size * (shape == ON_A_POINT ? k == 1 : ec_random_unit(&state)));
        }
        l->kind = EC_KIND_TRIANGLE | (i % 5 == 0 ? EC_LIGHT_TWO_SIDED : 0);
        f.bounds[i] = ec_light_bounds_of(l, 1 + i % 10);
        f.ids[i] = 7 + i;
    }
    return f;
}

static void drop(forest *f)
{
    free(f->lamps), free(f->bounds), free(f->ids), free(f->trails), free(f->nodes);
}

static double angle_between(const double a[3], const float b[3])
{
    double d = 0, e = 0;
    for (int k = 0; k < 3; k++) d += a[k] * b[k], e += (double)b[k] * b[k];
    return acos(fmin(fmax(d / sqrt(e), -1), 1));
}

/* Checks that a node contains the lamp: its corners in the sphere, its normal (or the reverse) in the cone. */
static bool holds(const ec_light_node *n, const ec_light_data *l, const ec_light_bounds *b)
{
    const float *corners[3] = {l->a, l->b, l->c};
    for (int c = 0; c < 3; c++) {
        double d2 = 0;
        for (int k = 0; k < 3; k++) d2 += pow((double)corners[c][k] - n->centre[k], 2);
        if (d2 > (double)n->radius2) return false;
    }
    double angle = angle_between(b->axis, n->axis), spread = acos((double)n->cos_spread);
    return angle <= spread + 1e-6 && (!b->two_sided || (n->flags & EC_LIGHT_NODE_TWO_SIDED));
}

/* A bulb's record: the start of its lamps in the table, their number, and for each its first of 2^32 numbers, by power. */
static void check_record(const forest *f, const ec_bulb *bulb, const ec_light_node *bulb_node)
{
    const uint32_t *words = (const uint32_t *)(f->nodes + bulb_node->link + 2);
    double sum = 0, before = 0;
    uint32_t off = 0;
    for (uint32_t i = 0; i < bulb->count; i++) sum += f->bounds[bulb->first + i].power;
    for (uint32_t i = 0; i < bulb->count; i++) {
        off += !(fabs(words[2 + i] * 0x1p-32 - before / sum) < 1e-6);
        before += f->bounds[bulb->first + i].power;
    }
    CHECK_MSG(words[0] == f->ids[bulb->first] && words[1] == bulb->count && !off, "bulb of %u: %u numbers are off", bulb->count, off);
}

/* Each bulb is one node, with all its lamps below and nothing else. */
static void check_bulbs(const forest *f, const ec_bulb *bulbs, uint32_t bulb_count)
{
    for (uint32_t k = 0; k < bulb_count; k++) {
        uint32_t shared = 0, others = 0;
        for (uint32_t i = 0; i < f->count; i++) {
            uint32_t node = 0, depth = 0, at = EC_NO_ID;
            for (; !(f->nodes[node].link & EC_LIGHT_LEAF); depth++) {
                if (f->nodes[node].flags & EC_LIGHT_NODE_BULB) at = node;
                node = f->nodes[node].link + (f->trails[i] >> depth & 1);
            }
            const bool is_here = at != EC_NO_ID && ((const uint32_t *)(f->nodes + f->nodes[at].link + 2))[0] == f->ids[bulbs[k].first];
            if (is_here && !shared++) check_record(f, &bulbs[k], &f->nodes[at]);
            others += is_here && (i < bulbs[k].first || i >= bulbs[k].first + bulbs[k].count);
        }
        CHECK_MSG(shared == bulbs[k].count && !others, "bulb %u of %u lamps has %u, %u of them others'", k, bulbs[k].count, shared, others);
    }
}

static void check(uint32_t count, int shape, const ec_bulb *bulbs, uint32_t bulb_count)
{
    ec_error err = {0};
    forest f = make(count, shape), again = make(count, shape);
    const ec_light_set set = {count, f.bounds, f.ids, bulb_count, bulbs}, other = {count, again.bounds, again.ids, bulb_count, bulbs};
    const size_t nodes = ec_light_tree_nodes(&set);
    CHECK_OK(ec_light_tree_build(&set, f.nodes, f.trails, &err), err);
    CHECK_OK(ec_light_tree_build(&other, again.nodes, again.trails, &err), err);
    CHECK(!memcmp(f.nodes, again.nodes, nodes * sizeof *f.nodes) && !memcmp(f.trails, again.trails, 4 * (size_t)count));
    uint32_t lost = 0, outside = 0, deepest = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t node = 0, depth = 0;
        for (; depth <= EC_LIGHT_DEPTH_MOST && !(f.nodes[node].link & EC_LIGHT_LEAF); depth++) {
            outside += !holds(&f.nodes[node], &f.lamps[i], &f.bounds[i]);
            node = f.nodes[node].link + (depth < 32 ? f.trails[i] >> depth & 1 : 0);
            if (node >= nodes) break;
        }
        lost += node >= nodes || f.nodes[node].link != (EC_LIGHT_LEAF | f.ids[i]);
        deepest = depth > deepest ? depth : deepest;
    }
    printf("%u lamps, shape %d: depth %u\n", count, shape, deepest);
    CHECK_MSG(!lost && !outside && deepest <= EC_LIGHT_DEPTH_MOST, "%u lamps, shape %d: %u trails lead elsewhere, %u nodes do not hold their lamps",
              count, shape, lost, outside);
    check_bulbs(&f, bulbs, bulb_count);
    drop(&f);
    drop(&again);
}

/* Even a lamp without power has a share above 0: kernels divide by sums of shares. */
static void check_without_power(void)
{
    forest f = make(3, SCATTERED);
    ec_error err;
    for (int i = 0; i < 3; i++) f.bounds[i].power = 0;
    const ec_light_set set = {.count = 3, .bounds = f.bounds, .ids = f.ids};
    CHECK_OK(ec_light_tree_build(&set, f.nodes, f.trails, &err), err);
    for (int i = 0; i < 5; i++) CHECK_MSG(f.nodes[i].power > 0 && f.nodes[i].power < 1, "node %d: %g", i, (double)f.nodes[i].power);
    drop(&f);
}

int main(void)
{
    check_without_power();
    for (int shape = SCATTERED; shape <= GROWING; shape++) {
        check(2, shape, NULL, 0);
        check(3, shape, NULL, 0);
        check(5000, shape, NULL, 0);
        check(5000, shape, (ec_bulb[]){{0, 8}, {8, 100}, {500, 4500}}, 3); /* together they fill it, except for 392 */
        check(20, shape, (ec_bulb[]){{0, 20}}, 1);
    }
    check(100000, SCATTERED, (ec_bulb[]){{5, 8000}}, 1);
    TEST_END();
}
