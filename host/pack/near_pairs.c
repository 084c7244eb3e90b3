/* Triangles in the order of a Morton curve of their middles, in blocks of eight under a tree of eight children a node; then each block against
 * the tree. Blocks of one mesh are small and lie side by side, so few meet. */
#include "pack/near_pairs.h"

#include <stdlib.h>
#include <string.h>

#include "base/freed.h"

enum { WIDTH = 8, LEVELS = 12 /* 8^11 triangles */, FEW = 4096 /* not worth several threads */ };

typedef struct box {
    float lo[3], hi[3];
} box;

typedef struct search {
    const ec_prim *prims;
    const uint32_t *order;
    uint32_t count, level_count;
    uint32_t level_size[LEVELS];
    const box *level[LEVELS]; /* 0: blocks of triangles */
    float margin;
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

static bool touch(const box *a, const box *b)
{
    bool apart = false;
    for (int k = 0; k < 3; k++) apart |= (a->lo[k] > b->hi[k]) | (b->lo[k] > a->hi[k]);
    return !apart;
}

/* Every third bit of 30 from bit 0 on. */
static uint32_t spread(uint32_t x)
{
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

static uint32_t code_of(const box *b, const box *all)
{
    uint32_t code = 0;
    for (int k = 0; k < 3; k++) {
        double extent = (double)all->hi[k] - all->lo[k], middle = 0.5 * ((double)b->lo[k] + b->hi[k]) - all->lo[k];
        code |= spread(extent > 0 ? (uint32_t)(middle / extent * 1023) : 0) << k;
    }
    return code;
}

/* Sorted by the low 32 bits of what is above the number: radix, least digit first, so that equals stay in order. */
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

/* boxes: room for all levels. */
static void make_levels(search *s, box *boxes)
{
    uint32_t below = s->count;
    for (s->level_count = 0; s->level_count == 0 || below > 1; s->level_count++) {
        uint32_t size = parts(below);
        for (uint32_t i = 0; i < size; i++)
            for (uint32_t k = WIDTH * i; k < below && k < WIDTH * (i + 1); k++) {
                box one = s->level_count ? s->level[s->level_count - 1][k] : box_of(s->prims + s->order[k], s->margin);
                if (k == WIDTH * i) boxes[i] = one;
                else grow(&boxes[i], &one);
            }
        s->level[s->level_count] = boxes;
        s->level_size[s->level_count] = below = size;
        boxes += size;
    }
}

/* A block's triangles, their boxes as columns; where there are fewer than eight the rest touch nothing. */
typedef struct block {
    uint32_t ids[WIDTH], count;
    float lo[3][WIDTH], hi[3][WIDTH];
} block;

static block block_at(const search *s, uint32_t place)
{
    const uint32_t first = WIDTH * place;
    block b = {.count = s->count - first < WIDTH ? s->count - first : WIDTH};
    for (uint32_t k = 0; k < b.count; k++) {
        b.ids[k] = s->order[first + k];
        box one = box_of(s->prims + b.ids[k], s->margin);
        for (int axis = 0; axis < 3; axis++) b.lo[axis][k] = one.lo[axis], b.hi[axis][k] = one.hi[axis];
    }
    return b;
}

/* Which of b's boxes does a's i-th one touch? */
static uint32_t touched(const block *a, uint32_t i, const block *b)
{
    uint32_t near[WIDTH], bits = 0;
    for (int k = 0; k < WIDTH; k++)
        near[k] = (uint32_t)((a->lo[0][i] <= b->hi[0][k]) & (b->lo[0][k] <= a->hi[0][i]) & (a->lo[1][i] <= b->hi[1][k]) & (b->lo[1][k] <= a->hi[1][i]) &
                             (a->lo[2][i] <= b->hi[2][k]) & (b->lo[2][k] <= a->hi[2][i]));
    for (uint32_t k = 0; k < b->count; k++) bits |= near[k] << k;
    return bits;
}

/* Which of a block's boxes touch another box? */
static uint32_t touching(const block *a, const box *b)
{
    uint32_t bits = 0;
    for (uint32_t k = 0; k < a->count; k++) {
        uint32_t near = 1;
        for (int axis = 0; axis < 3; axis++) near &= (uint32_t)((a->lo[axis][k] <= b->hi[axis]) & (b->lo[axis] <= a->hi[axis][k]));
        bits |= near << k;
    }
    return bits;
}

static bool compare(const search *s, const block *a, uint32_t place, bool same)
{
    uint32_t mine = touching(a, &s->level[0][place]);
    if (!mine) return true;
    const block b = block_at(s, place);
    for (; mine; mine &= mine - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(mine);
        for (uint32_t bits = touched(a, i, &b) & (same ? ~0u << (i + 1) : ~0u); bits; bits &= bits - 1) {
            uint32_t p = a->ids[i], q = b.ids[__builtin_ctz(bits)];
            if (!s->visit(s->user, p < q ? p : q, p < q ? q : p)) return false;
        }
    }
    return true;
}

/* A block against all from itself on. */
static bool search_block(const search *s, uint32_t place)
{
    uint32_t stack[LEVELS * WIDTH], levels[LEVELS * WIDTH], depth = 1;
    const block own = block_at(s, place);
    stack[0] = 0, levels[0] = s->level_count - 1;
    while (depth) {
        uint32_t level = levels[--depth], node = stack[depth];
        if (!touch(&s->level[level][node], &s->level[0][place])) continue;
        if (level == 0) {
            if (!compare(s, &own, node, node == place)) return false;
            continue;
        }
        for (uint32_t k = WIDTH * node; k < WIDTH * (node + 1) && k < s->level_size[level - 1]; k++) {
            if (((uint64_t)k + 1) << 3 * (level - 1) <= place) continue; /* all of it before the block */
            stack[depth] = k, levels[depth++] = level - 1;
        }
    }
    return true;
}

ec_result ec_near_pairs(const ec_prim *prims, uint32_t count, float margin, ec_pair_visit visit, void *user, ec_error *err)
{
    if (count < 2) return EC_OK;
    EC_FREED uint32_t *order = malloc((size_t)count * sizeof *order);
    EC_FREED box *boxes = malloc(((size_t)count / (WIDTH - 1) + 2 * LEVELS) * sizeof *boxes);
    if (!order || !boxes) return ec_fail(err, "out of memory to look for faces in one plane among %u triangles", count);
    EC_TRY(order_of(prims, count, order, err));
    search s = {.prims = prims, .order = order, .count = count, .margin = margin, .visit = visit, .user = user};
    make_levels(&s, boxes);
    bool ended = false;
#pragma omp parallel for schedule(dynamic, 256) if (count > FEW)
    for (uint32_t place = 0; place < s.level_size[0]; place++) {
        bool over;
#pragma omp atomic read
        over = ended;
        if (over || search_block(&s, place)) continue;
#pragma omp atomic write
        ended = true;
    }
    return EC_OK;
}
