/* The kd-tree: cells split where the surface area heuristic says, references in every leaf that their boxes overlap. Large cells
 * are tasks; a small one and all below it are built by one thread; the pieces are joined in their order.
 *
 * No perfect splits (Wald and Havran 2006: at every split the rest of a triangle is clipped to the cell, and cells where nothing of it
 * is left go without). References are clipped once, where the BVH cuts triangles, and go by their boxes from then on. A hit's t is
 * clamped to the box of a reference (kernels/lib/ray.h), so all structures must hold the same ones. Nor may a cell that the box
 * overlaps go without the reference because the triangle has no part there: seen edge-on, its t is a mean of its vertices'
 * depths with weights of rounding alone, anywhere within the box, also before or behind the part that the ray passes. The ray must
 * have met the reference by that t, or another hit behind it ends the search. Tried on sponza-dabrovic, processor time of bounced rays:
 *   clipped, with a margin of 1e-6 or 1e-4 of the scene  -3 or -4 %; but 218 and 224 of 50 000 rays in a plane of triangles hit others
 *   left out where the triangle's plane is not           +2 %; and the margin would have to grow with the distance of a ray's origin
 *   planes chosen for clipped ones, none left out        +22 %: costs are of a tree that is not built */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/build_internal.h"
#include "accel/kd_internal.h"
#include "accel/leaf.h"
#include "base/freed.h"

#define SUBTREE 4096u     /* items; not tied to the number of threads, since the numbering follows from it */
#define REFUSALS 3        /* splits in a row that do not pay by themselves: better ones may lie below */
#define DEPTH_MOST 36.0  /* twelve levels of kernel nodes: see EC_KD_STACK */
#define REFS_MOST 16u     /* times as many references as at the root; then leaves stay large */

/* A cell, and what it may cost. */
typedef struct range {
    ec_kd_item *items; /* owned */
    uint32_t count, depth, refusals;
    double budget;     /* references that all leaves below may have */
    ec_box cell;
    double area;       /* its surface as a share of the root's */
} range;

/* A node with two children, or a subtree in arrays. */
typedef struct piece {
    struct piece *child[2];
    ec_kd_binary node;
    ec_kd_binary *nodes;  /* nodes[0] its root; owned */
    uint32_t *ids;      /* eight a block, EC_NO_ID where free; owned */
    uint32_t node_count, node_room, block_count, block_room;
    uint64_t references;
    double cost;
} piece;

typedef struct builder {
    uint32_t depth_most;
    int failed;
} builder;

static void fail(builder *b)
{
#pragma omp atomic write
    b->failed = 1;
}

/* Makes the items of each side, cut to it. Returns false if it is out of memory. */
static int divide(const range *r, const ec_kd_split *s, range children[2])
{
    const double whole = ec_box_half_area(r->cell.lo, r->cell.hi);
    for (int side = 0; side < 2; side++) {
        range *c = &children[side];
        *c = (range){.depth = r->depth + 1, .refusals = r->refusals, .cell = r->cell};
        (side ? c->cell.lo : c->cell.hi)[s->axis] = s->plane;
        c->area = whole > 0.0 ? r->area * ec_box_half_area(c->cell.lo, c->cell.hi) / whole : 0.0;
        for (uint32_t i = 0; i < r->count; i++) c->count += ec_kd_sides(&r->items[i], s) >> side & 1;
        c->items = malloc((c->count + (size_t)1) * sizeof *c->items);
        if (!c->items) return 0;
        ec_kd_item *to = c->items;
        for (uint32_t i = 0; i < r->count; i++) {
            if (!(ec_kd_sides(&r->items[i], s) >> side & 1)) continue;
            *to = r->items[i];
            if (side) to->box.lo[s->axis] = fmaxf(to->box.lo[s->axis], s->plane);
            else to->box.hi[s->axis] = fminf(to->box.hi[s->axis], s->plane);
            to++;
        }
    }
    double both = (double)children[0].count + children[1].count;
    for (int side = 0; side < 2; side++) children[side].budget = r->budget * children[side].count / fmax(both, 1.0);
    return 1;
}

/* Decides whether to split a range, and splits it; its items are freed then. */
static int split(builder *b, range *r, ec_kd_split *s, range children[2])
{
    if (r->depth >= b->depth_most || r->count == 0) return 0;
    *s = ec_kd_choose(r->items, r->count, &r->cell);
    if (!(s->cost < INFINITY)) return 0;
    if (s->cost >= ec_kd_leaf_cost(r->count) && (r->count <= 16 || ++r->refusals > REFUSALS)) return 0;
    children[0].items = children[1].items = NULL;
    int good = divide(r, s, children);
    if (!good) fail(b);
    if (!good || (double)children[0].count + children[1].count > r->budget) {
        free(children[0].items);
        free(children[1].items);
        return 0;
    }
    free(r->items);
    r->items = NULL;
    return 1;
}

static void make_leaf(builder *b, piece *p, uint32_t index, range *r)
{
    uint32_t blocks = (r->count + 7) / 8, first = p->block_count;
    if (!ec_reserve_lines(&p->ids, &p->block_room, first, (uint64_t)first + blocks, 8 * sizeof *p->ids)) {
        fail(b);
        return;
    }
    for (uint32_t i = 0; i < 8 * blocks; i++) p->ids[8 * (size_t)first + i] = i < r->count ? r->items[i].ref : EC_NO_ID;
    p->nodes[index] = (ec_kd_binary){.first = first, .axis = EC_KD_NO_PLANE, .index = blocks};
    p->block_count += blocks;
    p->references += r->count;
    p->cost += r->area * ec_kd_leaf_cost(r->count);
}

/* Fills p->nodes[index] and all below it. Frees the range. */
static void build_subtree(builder *b, piece *p, uint32_t index, range *r)
{
    ec_kd_split s;
    range children[2];
    if (!split(b, r, &s, children)) {
        make_leaf(b, p, index, r);
        free(r->items);
        return;
    }
    uint32_t left = p->node_count;
    if (ec_reserve_lines(&p->nodes, &p->node_room, left, left + 2ull, sizeof *p->nodes)) {
        p->node_count += 2;
        p->nodes[index] = (ec_kd_binary){.plane = s.plane, .axis = (uint32_t)s.axis, .index = left};
        p->cost += r->area;
        build_subtree(b, p, left, &children[0]);
        build_subtree(b, p, left + 1, &children[1]);
    } else {
        fail(b);
        free(children[0].items);
        free(children[1].items);
    }
}

/* Builds the tree over a range by tasks; it is complete when all tasks have ended. Frees the range. */
static void build_piece(builder *b, range r, piece **result)
{
    ec_kd_split s;
    range children[2];
    piece *p = *result = calloc(1, sizeof *p);
    int good = p != NULL;
    if (good && r.count > SUBTREE && split(b, &r, &s, children)) {
        p->node = (ec_kd_binary){.plane = s.plane, .axis = (uint32_t)s.axis};
        p->cost = r.area;
        range right = children[1];
        piece **place = &p->child[1];
#pragma omp task firstprivate(right, place)
        build_piece(b, right, place);
        build_piece(b, children[0], &p->child[0]);
        return;
    }
    if (good) good = ec_reserve_lines(&p->nodes, &p->node_room, 0, 2, sizeof *p->nodes);
    if (!good) {
        fail(b);
        free(r.items);
        return;
    }
    p->node_count = 1;
    build_subtree(b, p, 0, &r);
}

static void free_piece(piece *p)
{
    if (!p) return;
    free_piece(p->child[0]);
    free_piece(p->child[1]);
    free(p->nodes);
    free(p->ids);
    free(p);
}

typedef struct joined {
    ec_kd_binary *nodes;
    uint32_t *ids;
    uint32_t node_count, block_count;
    uint64_t references;
    double cost;
} joined;

static void count_piece(const piece *p, joined *j)
{
    j->node_count += p->nodes ? p->node_count - 1 : 2;
    j->block_count += p->block_count;
    j->references += p->references;
    j->cost += p->cost;
    for (int side = 0; side < 2 && !p->nodes; side++) count_piece(p->child[side], j);
}

/* Copies a piece: its root to `slot`, the rest behind what is there already. */
static void join_piece(const piece *p, uint32_t slot, joined *j)
{
    uint32_t rest = j->node_count;
    if (!p->nodes) {
        j->node_count += 2;
        j->nodes[slot] = p->node;
        j->nodes[slot].index = rest;
        for (uint32_t side = 0; side < 2; side++) join_piece(p->child[side], rest + side, j);
        return;
    }
    for (uint32_t i = 0; i < p->node_count; i++) {
        ec_kd_binary node = p->nodes[i];
        if (node.axis == EC_KD_NO_PLANE) node.first += j->block_count;
        else node.index += rest - 1;
        j->nodes[i ? rest + i - 1 : slot] = node;
    }
    if (p->block_count) memcpy(j->ids + 8 * (size_t)j->block_count, p->ids, 32 * (size_t)p->block_count);
    j->node_count += p->node_count - 1;
    j->block_count += p->block_count;
}

static ec_result join(const piece *p, joined *j, ec_error *err)
{
    j->node_count = 1;
    count_piece(p, j);
    if (j->block_count >= 1u << 25)
        return ec_fail(err, "a kd-tree with %u blocks of triangles is more than the kernels can address",
                       j->block_count);
    j->nodes = ec_allocate_lines(j->node_count, sizeof *j->nodes);
    j->ids = malloc((8 * (size_t)j->block_count + 1) * sizeof *j->ids);
    if (!j->nodes || !j->ids) return ec_fail(err, "out of memory for a kd-tree of %u nodes", j->node_count);
    j->node_count = 1;
    j->block_count = 0;
    join_piece(p, 0, j);
    return EC_OK;
}

/* Turns reference numbers into triangles, each block in its own place. */
static void fill_blocks(const ec_accel_input *in, const ec_ref *refs, const joined *j, ec_tri8 *blocks, ec_box8 *boxes,
                        int threads)
{
#pragma omp parallel for num_threads(threads)
    for (uint32_t i = 0; i < j->block_count; i++) {
        const uint32_t *which = j->ids + 8 * (size_t)i;
        uint32_t count = 0;
        while (count < 8 && which[count] != EC_NO_ID) count++;
        ec_accel_block(in, refs, which, count, &blocks[i], boxes ? &boxes[i] : NULL);
    }
}

static range root_of(const ec_ref *refs, uint32_t count, const ec_box *bounds)
{
    range root = {.items = malloc((count + (size_t)1) * sizeof *root.items), .count = count, .cell = *bounds, .area = 1.0,
                  .budget = (double)REFS_MOST * count};
    for (uint32_t i = 0; root.items && i < count; i++) root.items[i] = (ec_kd_item){refs[i].box, i};
    return root;
}

ec_result ec_kdtree_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    EC_FREED ec_ref *refs = NULL;
    ec_box bounds;
    uint32_t count;
    EC_TRY(ec_accel_refs(in, &refs, &count, &bounds, err));
    int threads = ec_accel_threads(in, count);
    /* Havran's rule of thumb, within the kernels' stack. */
    builder b = {.depth_most = (uint32_t)fmin(8.0 + 1.3 * log2(count + 1.0), DEPTH_MOST)};
    range root = root_of(refs, count, &bounds);
    piece *tree = NULL;
    if (root.items) {
#pragma omp parallel num_threads(threads)
#pragma omp single
        build_piece(&b, root, &tree);
    }
    joined j = {0};
    ec_kd_header *header = ec_allocate_lines(1, sizeof *header);
    ec_tri8 *blocks = NULL;
    ec_box8 *boxes = NULL;
    ec_kd_node *nodes = NULL;
    uint32_t node_count = 0;
    ec_result result = EC_OK;
    if (!root.items || b.failed || !header) result = ec_fail(err, "out of memory for a kd-tree of %u triangles", count);
    if (result == EC_OK) result = join(tree, &j, err);
    if (result == EC_OK) {
        blocks = ec_allocate_lines(j.block_count, sizeof *blocks);
        nodes = ec_kd_collapse(j.nodes, &node_count);
        if (in->bvh.boxes) boxes = ec_allocate_lines(j.block_count, sizeof *boxes);
        if (!blocks || !nodes || (in->bvh.boxes && !boxes))
            result = ec_fail(err, "out of memory for %u blocks of triangles", j.block_count);
    }
    if (result == EC_OK) {
        memset(header, 0, sizeof *header);
        memcpy(header->lo, bounds.lo, sizeof header->lo);
        memcpy(header->hi, bounds.hi, sizeof header->hi);
        fill_blocks(in, refs, &j, blocks, boxes, threads);
    }
    free_piece(tree);
    free(j.nodes);
    free(j.ids);
    accel->buffers[0] = (ec_accel_buffer){"bounds", header, sizeof *header};
    accel->buffers[1] = (ec_accel_buffer){"nodes", nodes, (uint64_t)node_count * sizeof *nodes};
    accel->buffers[2] = (ec_accel_buffer){"triangle blocks", blocks, (uint64_t)j.block_count * sizeof *blocks};
    if (boxes) accel->buffers[3] = (ec_accel_buffer){"boxes", boxes, (uint64_t)j.block_count * sizeof *boxes};
    accel->stats = (ec_accel_stats){.nodes = node_count, .leaves = j.block_count, .references = j.references, .sah_cost = j.cost};
    return result;
}
