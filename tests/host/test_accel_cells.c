/* tiers: quick, long */
/* Grid and kd-tree: every triangle in every cell that its box needs, the same bytes for any number of threads, bounded stacks and
 * memory, on easy and hostile meshes; and the table of accelerators. */
#include "accel/accel.h"
#include "test_accel_meshes.h"

static ec_accel build(const char *name, const mesh *m, uint32_t threads, float density)
{
    ec_error err;
    ec_accel accel;
    ec_accel_input input = {.positions = m->positions, .indices = m->indices, .triangle_count = m->triangle_count, .threads = threads,
                            .grid_density = density};
    CHECK_OK(ec_accel_build(ec_accel_find(name), &input, &accel, &err), err);
    ec_accel_input_free(&input);
    return accel;
}

/* The references that cells must contain: those of the BVH over the same mesh, which may be parts of triangles. */
typedef struct parts {
    ec_bvh bvh;
    uint32_t count;
} parts;

static parts parts_of(const mesh *m)
{
    ec_error err;
    parts p = {.count = m->triangle_count};
    CHECK_OK(ec_bvh_build(m->positions, m->indices, m->triangle_count, 0, &p.bvh, NULL, &err), err);
    if (p.bvh.boxes) p.count = p.bvh.ref_count;
    return p;
}

static uint32_t triangle_of(const parts *p, uint32_t ref) { return p->bvh.boxes ? p->bvh.order[ref] : ref; }

static void box_of(const mesh *m, const parts *parts, uint32_t ref, float lo[3], float hi[3])
{
    for (int axis = 0; axis < 3; axis++) {
        const float *p = m->positions + 9 * (size_t)triangle_of(parts, ref) + axis;
        lo[axis] = parts->bvh.boxes ? parts->bvh.boxes[ref].lo[axis] : fminf(p[0], fminf(p[3], p[6]));
        hi[axis] = parts->bvh.boxes ? parts->bvh.boxes[ref].hi[axis] : fmaxf(p[0], fmaxf(p[3], p[6]));
    }
}

/* ---- grid ---- */

/* The cells of a triangle: their range along each axis, and their number. */
typedef struct held {
    uint32_t first[3], last[3], count;
} held;

static held *grid_held(const ec_accel *accel, const parts *parts)
{
    const ec_grid *grid = accel->buffers[0].data;
    const ec_grid_block *blocks = accel->buffers[1].data;
    const uint32_t *starts = accel->buffers[2].data, *entries = starts + grid->start_count;
    const ec_tri *triangles = accel->buffers[3].data;
    held *h = calloc(parts->count + 1, sizeof *h);
    uint32_t block_count = grid->blocks[0] * grid->blocks[1] * grid->blocks[2], next = 0;
    for (uint32_t b = 0; b < block_count; b++) {
        CHECK(blocks[b].first == next);
        for (uint32_t bit = 0; bit < 64; bit++) {
            if (!(blocks[b].occupied[bit / 32] >> bit % 32 & 1)) continue;
            uint32_t cell[3] = {4 * (b % grid->blocks[0]) + bit % 4, 4 * (b / grid->blocks[0] % grid->blocks[1]) + bit / 4 % 4,
                                4 * (b / grid->blocks[0] / grid->blocks[1]) + bit / 16};
            CHECK(starts[next] < starts[next + 1]);
            for (uint32_t i = starts[next]; i < starts[next + 1]; i++) {
                CHECK(i == starts[next] || entries[i] > entries[i - 1]); /* no triangle twice */
                held *one = &h[entries[i]];
                CHECK(triangles[entries[i]].id == triangle_of(parts, entries[i]));
                for (int axis = 0; axis < 3; axis++) {
                    if (!one->count || cell[axis] < one->first[axis]) one->first[axis] = cell[axis];
                    if (!one->count || cell[axis] > one->last[axis]) one->last[axis] = cell[axis];
                }
                one->count++;
            }
            next++;
        }
    }
    CHECK(next + 1 == grid->start_count);
    return h;
}

/* The requirements of the proof in traverse_grid.h: cells that cover the box along each axis, and all of their product. */
static void check_grid(const mesh *m, float density)
{
    ec_accel accel = build("grid", m, 0, density);
    const ec_grid *grid = accel.buffers[0].data;
    parts parts = parts_of(m);
    held *h = grid_held(&accel, &parts);
    const float *planes = (const float *)(grid + 1);
    uint32_t wrong = 0;
    for (int axis = 0; axis < 3; axis++) {
        uint32_t cells = 4 * grid->blocks[axis];
        for (uint32_t i = 0; i <= cells; i++) wrong += !isfinite(planes[i]) || (i && planes[i] < planes[i - 1]);
        for (uint32_t i = 0; i < parts.count; i++) {
            float lo[3], hi[3];
            box_of(m, &parts, i, lo, hi);
            wrong += !h[i].count || planes[h[i].first[axis]] > lo[axis] || planes[h[i].last[axis] + 1] < hi[axis];
        }
        planes += cells + 1;
    }
    for (uint32_t i = 0; i < parts.count; i++) {
        uint64_t product = 1;
        for (int axis = 0; axis < 3; axis++) product *= h[i].last[axis] - h[i].first[axis] + 1;
        wrong += product != h[i].count;
    }
    CHECK_MSG(!wrong, "%s: %u things wrong in the grid with %g cells a reference", m->name, wrong, (double)density);
    CHECK_MSG(accel.stats.references <= 64ull * (parts.count + 64), "%s: %llu entries", m->name, (unsigned long long)accel.stats.references);
    free(h);
    ec_bvh_free(&parts.bvh);
    ec_accel_free(&accel);
}

/* ---- kd-tree ---- */

typedef struct walk {
    const mesh *m;
    const parts *parts;
    const ec_kd_node *nodes;
    const ec_tri8 *blocks;
    uint32_t *marks;  /* by triangle: the last leaf that contained it */
    uint32_t leaves, wrong, visited;
} walk;

static void check_leaf(walk *w, uint32_t child, const uint32_t *ids, uint32_t count)
{
    uint32_t first = (child & ~EC_LEAF_BIT) >> 6, blocks = child & EC_KD_LEAF_MOST;
    w->leaves++;
    for (uint32_t b = first; child != EC_NO_CHILD && b < first + blocks; b++)
        for (int slot = 0; slot < 8; slot++)
            if (w->blocks[b].id[slot] != EC_NO_ID) w->marks[w->blocks[b].id[slot]] = w->leaves;
    for (uint32_t i = 0; i < count; i++) w->wrong += w->marks[triangle_of(w->parts, ids[i])] != w->leaves;
}

static uint32_t check_node(walk *w, uint32_t index, const uint32_t *ids, uint32_t count);

/* Checks the children [slot, slot + 2^levels) below a node's plane: ids whose boxes cross a plane must be on both sides, others on their
 * own. A box that lies in a plane may be on either side and is not followed. Returns the stack size that a traversal needs. */
static uint32_t check_below(walk *w, const ec_kd_node *n, uint32_t plane, uint32_t slot, int levels, const uint32_t *ids, uint32_t count)
{
    if (levels == 0) {
        if (n->child[slot] & EC_LEAF_BIT) check_leaf(w, n->child[slot], ids, count);
        return n->child[slot] & EC_LEAF_BIT ? 0 : check_node(w, n->child[slot], ids, count);
    }
    uint32_t axis = n->axes >> 2 * plane & 3, half = 1u << (levels - 1), deepest = 0;
    if (axis == EC_KD_NO_PLANE) { /* everything below belongs together: one child, or parts of a large leaf */
        uint32_t used = 0, only = slot;
        for (uint32_t k = slot; k < slot + 2 * half; k++)
            if (n->child[k] != EC_NO_CHILD) used++, only = k;
        if (used <= 1) return check_below(w, n, plane, only, 0, ids, count);
        return 8; /* parts: only the count of all triangles checks their contents */
    }
    uint32_t *part = malloc((count + 1) * sizeof *part);
    for (uint32_t side = 0; side < 2; side++) {
        uint32_t taken = 0;
        for (uint32_t i = 0; i < count; i++) {
            float lo[3], hi[3];
            box_of(w->m, w->parts, ids[i], lo, hi);
            if (side ? hi[axis] > n->plane[plane] : lo[axis] < n->plane[plane]) part[taken++] = ids[i];
        }
        uint32_t below = check_below(w, n, 2 * plane + 1 + side, slot + side * half, levels - 1, part, taken);
        if (below > deepest) deepest = below;
    }
    free(part);
    return deepest;
}

static uint32_t check_node(walk *w, uint32_t index, const uint32_t *ids, uint32_t count)
{
    w->visited++;
    return 7 + check_below(w, &w->nodes[index], 0, 0, 3, ids, count);
}

static void check_kdtree(const mesh *m)
{
    ec_accel accel = build("kdtree", m, 0, 0.0f);
    parts parts = parts_of(m);
    walk w = {.m = m, .parts = &parts, .nodes = accel.buffers[1].data, .blocks = accel.buffers[2].data, .marks = calloc(m->triangle_count + 1, 4)};
    uint32_t *ids = malloc((parts.count + 1) * sizeof *ids), missing = 0;
    for (uint32_t i = 0; i < parts.count; i++) ids[i] = i;
    uint32_t stack = check_node(&w, 0, ids, parts.count);
    CHECK_MSG(!w.wrong, "%s: %u triangles missing in leaves of the kd-tree", m->name, w.wrong);
    CHECK_MSG(stack < EC_KD_STACK, "%s: stack %u", m->name, stack);
    memset(w.marks, 0, m->triangle_count * sizeof *w.marks);
    for (uint64_t b = 0; b < accel.stats.leaves; b++)
        for (int slot = 0; slot < 8; slot++)
            if (w.blocks[b].id[slot] != EC_NO_ID) w.marks[w.blocks[b].id[slot]] = 1;
    for (uint32_t i = 0; i < m->triangle_count; i++) missing += !w.marks[i];
    CHECK_MSG(!missing, "%s: %u triangles in no leaf of the kd-tree", m->name, missing);
    CHECK_MSG(accel.stats.references <= 16ull * (m->triangle_count + 64), "%s: %llu references", m->name, (unsigned long long)accel.stats.references);
    free(w.marks);
    free(ids);
    ec_bvh_free(&parts.bvh);
    ec_accel_free(&accel);
}

/* ---- all of them ---- */

static void check_threads(const mesh *m)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        if (m->triangle_count > 20000 && !strcmp(ec_accels[a].name, "none")) continue;
        ec_accel one = build(ec_accels[a].name, m, 1, 0.0f);
        ec_accel other = build(ec_accels[a].name, m, 5, 0.0f);
        for (int k = 0; k < EC_ACCEL_BUFFERS; k++) {
            const ec_accel_buffer *x = &one.buffers[k], *y = &other.buffers[k];
            CHECK_MSG(x->bytes == y->bytes && (!x->data || !memcmp(x->data, y->data, x->bytes)),
                      "%s, %s: five threads write other %s than one", m->name, ec_accels[a].name, x->label);
        }
        ec_accel_free(&other);
        ec_accel_free(&one);
    }
}

/* The loader should drop such vertices. If it does not, every builder still finishes. */
static void test_not_numbers(void)
{
    mesh m = mesh_make(&(mesh_kind){"not numbers", triangle_small, 3000});
    for (uint32_t i = 0; i < 9 * m.triangle_count; i += 7) m.positions[i] = i % 3 == 0 ? NAN : i % 3 == 1 ? INFINITY : -INFINITY;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        ec_accel accel = build(ec_accels[a].name, &m, 0, 0.0f);
        CHECK(accel.stats.references >= m.triangle_count);
        ec_accel_free(&accel);
    }
    mesh_free(&m);
}

static void test_density(void)
{
    ec_error err;
    mesh m = mesh_make(&(mesh_kind){"small", triangle_small, 5000});
    for (int density = 1; density <= 64; density *= 8) {
        ec_accel accel;
        ec_accel_input input = {.positions = m.positions, .indices = m.indices, .triangle_count = m.triangle_count,
                                .grid_density = (float)density};
        CHECK_OK(ec_accel_build(ec_accel_find("grid"), &input, &accel, &err), err);
        double cells = (double)accel.stats.nodes / m.triangle_count;
        CHECK_MSG(cells > 0.5 * density && cells < 2.0 * density, "%d cells a triangle wanted, %g made", density, cells);
        ec_accel_free(&accel);
        ec_accel_input_free(&input);
    }
    mesh_free(&m);
}

static void test_table(void)
{
    ec_error err;
    uint32_t chosen;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        CHECK(ec_accel_find(ec_accels[a].name) == a);
        CHECK(!strcmp(ec_accel_names[a + 1], ec_accels[a].name));
        CHECK_OK(ec_accels_choose(ec_accels[a].name, 10, true, &chosen, &err), err);
        CHECK(chosen == 1u << a);
    }
    CHECK(!ec_accel_names[EC_ACCEL_COUNT + 1] && !strcmp(ec_accel_names[0], "auto"));
    CHECK(ec_accels_choose("octree", 10, true, &chosen, &err) == EC_FAILED && strstr(err.text, "octree"));
    const uint32_t bvh2 = 1u << ec_accel_find("bvh2"), bvh8 = 1u << ec_accel_find("bvh8");
    static const struct { uint32_t triangles; bool is_cpu; } scenes[] = {{10, true}, {100000, true}, {200000, true}, {1000, false}};
    const uint32_t expected[] = {bvh2, bvh2 | bvh8, bvh8, bvh2};
    for (int i = 0; i < 4; i++) {
        CHECK_OK(ec_accels_choose(i % 2 ? "auto" : NULL, scenes[i].triangles, scenes[i].is_cpu, &chosen, &err), err);
        CHECK(chosen == expected[i]);
    }
}

static void test_brute_force_is_refused(void)
{
    ec_error err;
    ec_accel accel;
    mesh m = mesh_make(&(mesh_kind){"too many", triangle_small, 20001});
    ec_accel_input input = {.positions = m.positions, .indices = m.indices, .triangle_count = m.triangle_count};
    CHECK(ec_accel_build(ec_accel_find("none"), &input, &accel, &err) == EC_FAILED);
    CHECK_MSG(strstr(err.text, "20000") && strstr(err.text, "20001") && strstr(err.text, "--accel"), "%s", err.text);
    CHECK(!accel.buffers[0].data);
    mesh_free(&m);
}

/* More triangles than any structure can number: each builder finds this before it reads any, fails, and leaves nothing behind. */
static void test_too_many(void)
{
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        ec_error err;
        ec_accel accel;
        ec_accel_input input = {.triangle_count = 1u << 31};
        CHECK_MSG(ec_accel_build(a, &input, &accel, &err) == EC_FAILED, "%s", ec_accels[a].name);
        CHECK_MSG(!accel.buffers[0].data && !input.bvh.nodes, "%s", ec_accels[a].name);
        ec_accel_input_free(&input);
    }
}

int main(void)
{
    static const float densities[] = {0.0f, 0.01f, 10000.0f}; /* the default, and the limits of --grid-density */
    for (size_t k = 0; k < MESH_KIND_COUNT; k++) {
        mesh m = mesh_make(&mesh_kinds[k]);
        if (!test_tier(m.triangle_count > 5000 ? "long" : "quick")) {
            mesh_free(&m);
            continue;
        }
        for (int i = 0; i < (m.triangle_count > 20000 ? 1 : 3); i++) check_grid(&m, densities[i]);
        check_kdtree(&m);
        check_threads(&m);
        mesh_free(&m);
    }
    if (test_tier("quick")) {
        test_too_many();
        test_not_numbers();
        test_density();
        test_table();
        test_brute_force_is_refused();
    }
    TEST_END();
}
