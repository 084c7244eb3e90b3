/* Sorts triangles along a Morton curve of their centres, under a tree with eight children per node; then tests the triangles of each lowest node
 * against the tree. Triangles of a mesh are small and adjacent, so few boxes touch. */
#include "pack/near_pairs.h"

#include <math.h>
#include <stdlib.h>

#include "base/freed.h"
#include "base/morton.h"

enum { WIDTH = 8, LEVELS = 12 /* for 8^11 triangles */, FEW = 4096 /* fewer are not worth several threads */ };

typedef struct box {
    float lo[3], hi[3];
} box;

/* Boxes of eight children, as columns; unused ones touch nothing. */
typedef struct node {
    float lo[3][WIDTH], hi[3][WIDTH];
} node;

typedef struct search {
    const ec_prim *prims;
    const uint32_t *order;
    uint32_t count, level_count;
    const node *level[LEVELS]; /* level 0: of triangles; the last one has a single node */
    ec_pair_visit visit;
    void *user;
} search;

static float lesser(float a, float b) { return a < b ? a : b; }
static float greater(float a, float b) { return a > b ? a : b; }

static box box_of(const ec_prim *p, float margin)
{
    box b;
    for (int k = 0; k < 3; k++) {
        b.lo[k] = lesser(p->v0[k], lesser(p->v1[k], p->v2[k])) - margin;
        b.hi[k] = greater(p->v0[k], greater(p->v1[k], p->v2[k])) + margin;
    }
    return b;
}

static void grow(box *b, const box *by)
{
    for (int k = 0; k < 3; k++) {
        b->lo[k] = lesser(b->lo[k], by->lo[k]);
        b->hi[k] = greater(b->hi[k], by->hi[k]);
    }
}

static uint32_t code_of(const box *b, const box *all)
{
    uint32_t at[3];
    for (int k = 0; k < 3; k++) {
        double extent = (double)all->hi[k] - all->lo[k], middle = 0.5 * ((double)b->lo[k] + b->hi[k]) - all->lo[k];
        at[k] = extent > 0 ? (uint32_t)(middle / extent * 1023) : 0;
    }
    return (uint32_t)ec_morton(at);
}

/* Sorts by the low 32 bits above the index with a radix sort, least digit first, which keeps the order of equals. */
static void sort(uint64_t *a, uint64_t *b, uint32_t count)
{
    for (int shift = 32; shift < 64; shift += 8) {
        uint32_t place[257] = {0};
        for (uint32_t i = 0; i < count; i++) place[(a[i] >> shift & 255) + 1]++;
        for (int d = 0; d < 256; d++) place[d + 1] += place[d];
        for (uint32_t i = 0; i < count; i++) b[place[a[i] >> shift & 255]++] = a[i];
        uint64_t *other = a;
        a = b, b = other;
    }
}

static ec_result order_of(const ec_prim *prims, uint32_t count, uint32_t *order, ec_error *err)
{
    EC_FREED uint64_t *keys = malloc(2 * (size_t)count * sizeof *keys);
    if (!keys) return ec_fail(err, "out of memory to look for faces in one plane among %u triangles", count);
    box all = box_of(prims, 0);
    for (uint32_t i = 1; i < count; i++) {
        box b = box_of(prims + i, 0);
        grow(&all, &b);
    }
    for (uint32_t i = 0; i < count; i++) {
        box b = box_of(prims + i, 0);
        keys[i] = (uint64_t)code_of(&b, &all) << 32 | i;
    }
    sort(keys, keys + count, count);
    for (uint32_t i = 0; i < count; i++) order[i] = (uint32_t)keys[i];
    return EC_OK;
}

static uint32_t parts(uint32_t count) { return count / WIDTH + (count % WIDTH != 0); }

static box child_at(const node *n, uint32_t k)
{
    box b;
    for (int axis = 0; axis < 3; axis++) b.lo[axis] = n->lo[axis][k], b.hi[axis] = n->hi[axis][k];
    return b;
}

static box box_about(const node *n)
{
    box all = child_at(n, 0);
    for (uint32_t k = 1; k < WIDTH; k++) {
        const box one = child_at(n, k);
        grow(&all, &one);
    }
    return all;
}

/* Builds all levels, at least two, in `nodes`, which has room for them. */
static void make_levels(search *s, float margin, node *nodes)
{
    static const box none = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    uint32_t below = s->count;
    for (s->level_count = 0; s->level_count < 2 || below > 1; s->level_count++) {
        const node *children = s->level_count ? s->level[s->level_count - 1] : NULL;
        const uint32_t size = parts(below);
        for (uint32_t k = 0; k < WIDTH * size; k++) {
            const box one = k >= below ? none : children ? box_about(&children[k]) : box_of(s->prims + s->order[k], margin);
            for (int axis = 0; axis < 3; axis++) nodes[k / WIDTH].lo[axis][k % WIDTH] = one.lo[axis], nodes[k / WIDTH].hi[axis][k % WIDTH] = one.hi[axis];
        }
        s->level[s->level_count] = nodes;
        below = size;
        nodes += size;
    }
}

/* Returns bits for the children that touch a box. */
static uint32_t touched(const node *n, const box *b)
{
    uint32_t near[WIDTH], bits = 0;
    for (int k = 0; k < WIDTH; k++)
        near[k] = (uint32_t)((n->lo[0][k] <= b->hi[0]) & (b->lo[0] <= n->hi[0][k]) & (n->lo[1][k] <= b->hi[1]) & (b->lo[1] <= n->hi[1][k]) &
                             (n->lo[2][k] <= b->hi[2]) & (b->lo[2] <= n->hi[2][k]));
    for (int k = 0; k < WIDTH; k++) bits |= near[k] << k;
    return bits;
}

/* Tests the triangles of two lowest nodes; about: the box of the other one. */
static bool compare(const search *s, uint32_t own, uint32_t other, const box *about)
{
    for (uint32_t mine = touched(&s->level[0][own], about); mine; mine &= mine - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(mine), p = s->order[WIDTH * own + i];
        const box one = child_at(&s->level[0][own], i);
        for (uint32_t bits = touched(&s->level[0][other], &one) & (own == other ? ~0u << (i + 1) : ~0u); bits; bits &= bits - 1) {
            const uint32_t q = s->order[WIDTH * other + (uint32_t)__builtin_ctz(bits)];
            if (!s->visit(s->user, p < q ? p : q, p < q ? q : p)) return false;
        }
    }
    return true;
}

/* Tests a lowest node against itself and all after it. */
static bool search_node(const search *s, uint32_t own)
{
    uint32_t stack[LEVELS * WIDTH], levels[LEVELS * WIDTH], depth = 1;
    const box mine = child_at(&s->level[1][own / WIDTH], own % WIDTH);
    stack[0] = 0, levels[0] = s->level_count - 1;
    while (depth) {
        const uint32_t level = levels[--depth], at = stack[depth];
        const node *n = &s->level[level][at];
        for (uint32_t bits = touched(n, &mine); bits; bits &= bits - 1) {
            const uint32_t k = (uint32_t)__builtin_ctz(bits), child = WIDTH * at + k;
            if (((uint64_t)child + 1) << 3 * (level - 1) <= own) continue; /* lies entirely before own */
            if (level > 1) {
                stack[depth] = child, levels[depth++] = level - 1;
                continue;
            }
            const box about = child_at(n, k);
            if (!compare(s, own, child, &about)) return false;
        }
    }
    return true;
}

ec_result ec_near_pairs(const ec_prim *prims, uint32_t count, float margin, ec_pair_visit visit, void *user, ec_error *err)
{
    if (count < 2) return EC_OK;
    EC_FREED uint32_t *order = malloc((size_t)count * sizeof *order);
    EC_FREED node *nodes = malloc(((size_t)count / (WIDTH - 1) + 2 * LEVELS) * sizeof *nodes);
    if (!order || !nodes) return ec_fail(err, "out of memory to look for faces in one plane among %u triangles", count);
    EC_TRY(order_of(prims, count, order, err));
    search s = {.prims = prims, .order = order, .count = count, .visit = visit, .user = user};
    make_levels(&s, margin, nodes);
    const uint32_t lowest = parts(count);
    bool ended = false;
#pragma omp parallel for schedule(dynamic, 256) if (count > FEW)
    for (uint32_t own = 0; own < lowest; own++) {
        bool over;
#pragma omp atomic read
        over = ended;
        if (over || search_node(&s, own)) continue;
#pragma omp atomic write
        ended = true;
    }
    return EC_OK;
}
