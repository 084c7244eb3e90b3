/* tier: quick */
/* The two layouts: every triangle once with its own bits; rays find what a search of all triangles finds; stacks suffice. */
#include <omp.h>

#include "accel/bvh.h"
#include "test_accel_meshes.h"

typedef struct layouts {
    ec_bvh bvh;
    ec_bvh2_node *nodes2;
    ec_tri *triangles;
    ec_bvh8_node *nodes8;
    ec_tri8 *blocks;
    ec_box *boxes2;
    ec_box8 *boxes8;
    uint32_t count2, triangle_count, count8, block_count;
} layouts;

static layouts make_layouts(const mesh *m)
{
    ec_error err;
    layouts l;
    ec_bvh2 two;
    ec_bvh8 eight;
    CHECK_OK(ec_bvh_build(m->positions, m->indices, m->triangle_count, 0, &l.bvh, NULL, &err), err);
    CHECK_OK(ec_bvh2_layout(&l.bvh, m->positions, m->indices, &two, &err), err);
    CHECK_OK(ec_bvh8_layout(&l.bvh, m->positions, m->indices, &eight, &err), err);
    l.nodes2 = two.nodes, l.triangles = two.triangles, l.boxes2 = two.boxes, l.count2 = two.node_count, l.triangle_count = two.triangle_count;
    l.nodes8 = eight.nodes, l.blocks = eight.blocks, l.boxes8 = eight.boxes, l.count8 = eight.node_count, l.block_count = eight.block_count;
    return l;
}

static void free_layouts(layouts *l)
{
    ec_bvh_free(&l->bvh);
    free(l->nodes2);
    free(l->triangles);
    free(l->nodes8);
    free(l->blocks);
    free(l->boxes2);
    free(l->boxes8);
}

/* ---- invariants ---- */

typedef struct walk {
    const mesh *m;
    const layouts *l;
    uint32_t *seen; /* by triangle: a checksum of its references, independent of their order */
    uint32_t visited;
    uint32_t bad;
} walk;

/* 1 for a whole triangle. */
static uint32_t number_of(const ec_box *box)
{
    uint32_t number = 1;
    for (size_t i = 0; box && i < sizeof *box; i++) number = (number ^ ((const unsigned char *)box)[i]) * 16777619u;
    return number;
}

static int inside(const float a_lo[3], const float a_hi[3], const float lo[3], const float hi[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (a_lo[axis] < lo[axis] || a_hi[axis] > hi[axis]) return 0;
    return 1;
}

/* Checks a reference: the vertices are the triangle's, and its box is within the leaf's. */
static void see(walk *w, uint32_t id, const float *v[3], const ec_box *box, const float lo[3], const float hi[3])
{
    if (id >= w->m->triangle_count) {
        w->bad++;
        return;
    }
    w->seen[id] += number_of(box);
    if (box && !inside(box->lo, box->hi, lo, hi)) w->bad++;
    for (int corner = 0; corner < 3; corner++) {
        const float *p = w->m->positions + 3 * (size_t)w->m->indices[3 * (size_t)id + corner];
        if (memcmp(p, v[corner], 12)) w->bad++;
        for (int axis = 0; axis < 3; axis++)
            if (!box && (p[axis] < lo[axis] || p[axis] > hi[axis])) w->bad++;
    }
}

/* Returns the height: the stack size for an ordered traversal. */
static uint32_t walk2(walk *w, uint32_t index, const float lo[3], const float hi[3])
{
    const ec_bvh2_node *node = &w->l->nodes2[index];
    uint32_t height = 0;
    w->visited++;
    for (int side = 0; side < 2; side++) {
        uint32_t child = node->child[side];
        if (child == EC_NO_CHILD) {
            CHECK(index == 0 && side == 1 && isinf(node->lo[1][0]) && node->hi[1][2] == -INFINITY);
            continue;
        }
        if (!inside(node->lo[side], node->hi[side], lo, hi)) w->bad++;
        if (child & EC_LEAF_BIT) {
            uint32_t first = (child & ~EC_LEAF_BIT) >> 4, count = child & 15;
            if (count > 4 || first + count > w->l->triangle_count) w->bad++;
            for (uint32_t i = first; i < first + count; i++) {
                const ec_tri *t = &w->l->triangles[i];
                see(w, t->id, (const float *[3]){t->v0, t->v1, t->v2}, w->l->boxes2 ? &w->l->boxes2[i] : NULL,
                    node->lo[side], node->hi[side]);
            }
        } else {
            if (child <= index || child >= w->l->count2) {
                w->bad++;
                continue;
            }
            uint32_t below = 1 + walk2(w, child, node->lo[side], node->hi[side]);
            if (below > height) height = below;
        }
    }
    return height;
}

/* Returns the largest stack of a traversal that always takes the worst child first. */
static uint32_t walk8(walk *w, uint32_t index, const float lo[3], const float hi[3])
{
    const ec_bvh8_node *node = &w->l->nodes8[index];
    uint32_t children = 0, deepest = 0;
    w->visited++;
    for (int k = 0; k < 8; k++) {
        float a_lo[3], a_hi[3];
        for (int axis = 0; axis < 3; axis++) a_lo[axis] = node->bound[2 * axis][k];
        for (int axis = 0; axis < 3; axis++) a_hi[axis] = node->bound[2 * axis + 1][k];
        uint32_t child = node->child[k];
        if (child == EC_NO_CHILD) {
            if (a_lo[0] != INFINITY || a_hi[0] != -INFINITY || a_lo[2] != INFINITY || a_hi[2] != -INFINITY) w->bad++;
            continue;
        }
        children++;
        if (!inside(a_lo, a_hi, lo, hi)) w->bad++;
        if (!(child & EC_LEAF_BIT)) {
            if (child <= index || child >= w->l->count8) {
                w->bad++;
                continue;
            }
            uint32_t below = walk8(w, child, a_lo, a_hi);
            if (below > deepest) deepest = below;
            continue;
        }
        if ((child & ~EC_LEAF_BIT) >= w->l->block_count) {
            w->bad++;
            continue;
        }
        const ec_tri8 *b = &w->l->blocks[child & ~EC_LEAF_BIT];
        for (int slot = 0; slot < 8; slot++) {
            float v[3][3];
            for (int corner = 0; corner < 3; corner++)
                for (int axis = 0; axis < 3; axis++) v[corner][axis] = b->v[corner][axis][slot];
            const ec_box8 *boxes = w->l->boxes8 ? &w->l->boxes8[child & ~EC_LEAF_BIT] : NULL;
            ec_box box;
            for (int axis = 0; boxes && axis < 3; axis++) {
                box.lo[axis] = boxes->lo[axis][slot];
                box.hi[axis] = boxes->hi[axis][slot];
            }
            if (b->id[slot] != EC_NO_ID) {
                see(w, b->id[slot], (const float *[3]){v[0], v[1], v[2]}, boxes ? &box : NULL, a_lo, a_hi);
            } else {
                for (int c = 0; c < 9; c++) w->bad += v[c / 3][c % 3] != 0.0f;
            }
        }
    }
    return deepest + (children ? children - 1 : 0);
}

static void check_seen(walk *w, const char *layout, uint32_t node_count)
{
    uint32_t wrong = 0;
    const ec_bvh *bvh = &w->l->bvh;
    for (uint32_t i = 0; i < bvh->ref_count; i++) w->seen[bvh->order[i]] -= number_of(bvh->boxes ? &bvh->boxes[i] : NULL);
    for (uint32_t i = 0; i < w->m->triangle_count; i++) wrong += w->seen[i] != 0;
    CHECK_MSG(!wrong, "%s, %s: %u triangles without just the references of the tree", w->m->name, layout, wrong);
    CHECK_MSG(!w->bad, "%s, %s: %u things wrong", w->m->name, layout, w->bad);
    CHECK_MSG(w->visited == node_count, "%s, %s: %u of %u nodes", w->m->name, layout, w->visited, node_count);
    memset(w->seen, 0, w->m->triangle_count * sizeof *w->seen);
    w->bad = w->visited = 0;
}

static void check_invariants(const mesh *m, const layouts *l)
{
    const float all_lo[3] = {-INFINITY, -INFINITY, -INFINITY}, all_hi[3] = {INFINITY, INFINITY, INFINITY};
    walk w = {.m = m, .l = l, .seen = calloc(m->triangle_count + 1, sizeof *w.seen)};
    uint32_t stack2 = walk2(&w, 0, all_lo, all_hi);
    check_seen(&w, "binary", l->count2);
    CHECK_MSG(stack2 < 64, "%s: binary height %u", m->name, stack2);
    uint32_t stack8 = walk8(&w, 0, m->triangle_count ? all_lo : all_hi, m->triangle_count ? all_hi : all_lo);
    check_seen(&w, "8-wide", l->count8);
    CHECK_MSG(stack8 + 8 <= EC_BVH_STACK, "%s: 8-wide stack %u", m->name, stack8);
    free(w.seen);
}

static void test_single_leaf_roots(void)
{
    for (uint32_t count = 0; count <= 3; count++) {
        mesh m = mesh_make(&(mesh_kind){"single leaf", triangle_coincident, count});
        layouts l = make_layouts(&m);
        CHECK(l.count2 == 1 && l.nodes2[0].child[0] == (EC_LEAF_BIT | count) && l.nodes2[0].child[1] == EC_NO_CHILD);
        CHECK(l.count8 == 1 && l.nodes8[0].child[0] == EC_LEAF_BIT && l.nodes8[0].child[1] == EC_NO_CHILD);
        CHECK(l.block_count == 1 && l.blocks[0].id[count] == EC_NO_ID);
        free_layouts(&l);
        mesh_free(&m);
    }
}

static void test_invariants_and_thread_counts(void)
{
    int threads = omp_get_max_threads();
    for (size_t k = 0; k < MESH_KIND_COUNT; k++) {
        mesh m = mesh_make(&mesh_kinds[k]);
        omp_set_num_threads(1);
        layouts one = make_layouts(&m);
        omp_set_num_threads(3);
        layouts three = make_layouts(&m);
        CHECK_MSG(one.count2 == three.count2 && !memcmp(one.nodes2, three.nodes2, one.count2 * sizeof *one.nodes2) &&
                      !memcmp(one.triangles, three.triangles, one.triangle_count * sizeof *one.triangles) &&
                      (!one.boxes2 || !memcmp(one.boxes2, three.boxes2, one.triangle_count * sizeof *one.boxes2)),
                  "%s: binary", m.name);
        CHECK_MSG(one.count8 == three.count8 && !memcmp(one.nodes8, three.nodes8, one.count8 * sizeof *one.nodes8) &&
                      one.block_count == three.block_count &&
                      !memcmp(one.blocks, three.blocks, one.block_count * sizeof *one.blocks) &&
                      (!one.boxes8 || !memcmp(one.boxes8, three.boxes8, one.block_count * sizeof *one.boxes8)),
                  "%s: 8-wide", m.name);
        check_invariants(&m, &three);
        free_layouts(&one);
        free_layouts(&three);
        mesh_free(&m);
    }
    omp_set_num_threads(threads);
}

/* ---- rays ---- */

typedef struct ray {
    double o[3], d[3];
} ray;
typedef struct hit {
    double t;
    uint32_t id;
} hit;

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static void cross(const double *a, const double *b, double *c)
{
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Moeller and Trumbore 1997, in double. The closest hit is the smallest (t, id). */
static void hit_triangle(const ray *r, const float *a, const float *b, const float *c, uint32_t id, hit *h)
{
    double e1[3], e2[3], s[3], p[3], q[3];
    for (int k = 0; k < 3; k++) e1[k] = (double)b[k] - a[k], e2[k] = (double)c[k] - a[k], s[k] = r->o[k] - a[k];
    cross(r->d, e2, p);
    double det = dot(e1, p);
    if (det == 0.0) return;
    cross(s, e1, q);
    double u = dot(s, p) / det, v = dot(r->d, q) / det, t = dot(e2, q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || !(t > 0.0)) return;
    if (t < h->t || (t == h->t && id < h->id)) *h = (hit){t, id};
}

/* Slabs widened by far more than double rounding. */
static int hits_box(const ray *r, const float lo[3], const float hi[3], double t_max)
{
    double near = 0.0, far = t_max;
    for (int k = 0; k < 3; k++) {
        double margin = 1e-9 * (fabs(r->o[k]) + fmax(fabs((double)lo[k]), fabs((double)hi[k])));
        double a = (lo[k] - margin - r->o[k]) / r->d[k], b = (hi[k] + margin - r->o[k]) / r->d[k];
        near = fmax(near, fmin(a, b));
        far = fmin(far, fmax(a, b));
    }
    return near <= far * (1.0 + 1e-9);
}

static hit trace2(const layouts *l, const ray *r)
{
    hit h = {INFINITY, EC_NO_ID};
    uint32_t stack[EC_BVH_STACK], count = 0;
    stack[count++] = 0;
    while (count) {
        const ec_bvh2_node *node = &l->nodes2[stack[--count]];
        for (int side = 0; side < 2; side++) {
            uint32_t child = node->child[side];
            if (child == EC_NO_CHILD || !hits_box(r, node->lo[side], node->hi[side], h.t)) continue;
            if (!(child & EC_LEAF_BIT)) {
                stack[count++] = child;
                continue;
            }
            const ec_tri *t = &l->triangles[(child & ~EC_LEAF_BIT) >> 4];
            for (uint32_t i = 0; i < (child & 15); i++) hit_triangle(r, t[i].v0, t[i].v1, t[i].v2, t[i].id, &h);
        }
    }
    return h;
}

static hit trace8(const layouts *l, const ray *r)
{
    hit h = {INFINITY, EC_NO_ID};
    uint32_t stack[EC_BVH_STACK], count = 0;
    stack[count++] = 0;
    while (count) {
        const ec_bvh8_node *node = &l->nodes8[stack[--count]];
        for (int k = 0; k < 8; k++) {
            const float lo[3] = {node->bound[0][k], node->bound[2][k], node->bound[4][k]};
            const float hi[3] = {node->bound[1][k], node->bound[3][k], node->bound[5][k]};
            if (node->child[k] == EC_NO_CHILD || !hits_box(r, lo, hi, h.t)) continue;
            if (!(node->child[k] & EC_LEAF_BIT)) {
                stack[count++] = node->child[k];
                continue;
            }
            const ec_tri8 *b = &l->blocks[node->child[k] & ~EC_LEAF_BIT];
            for (int slot = 0; slot < 8 && b->id[slot] != EC_NO_ID; slot++) {
                float v[3][3];
                for (int c = 0; c < 9; c++) v[c / 3][c % 3] = b->v[c / 3][c % 3][slot];
                hit_triangle(r, v[0], v[1], v[2], b->id[slot], &h);
            }
        }
    }
    return h;
}

static hit trace_all(const mesh *m, const ray *r)
{
    hit h = {INFINITY, EC_NO_ID};
    for (uint32_t id = 0; id < m->triangle_count; id++) {
        const float *p = m->positions + 9 * (size_t)id;
        hit_triangle(r, p, p + 3, p + 6, id, &h);
    }
    return h;
}

/* Rays from anywhere in and around the mesh, towards a point of a triangle or anywhere. */
static ray make_ray(const mesh *m, uint32_t i)
{
    ray r;
    const float *p = m->positions + 9 * (size_t)(uint32_t)(mesh_random() * (float)m->triangle_count);
    const float *q = m->positions + 9 * (size_t)(uint32_t)(mesh_random() * (float)m->triangle_count);
    double u = mesh_random(), v = mesh_random();
    for (int k = 0; k < 3; k++) {
        double target = p[k] + 0.5 * u * ((double)p[3 + k] - p[k]) + 0.5 * v * ((double)p[6 + k] - p[k]);
        double spread = fabs((double)p[k]) + fabs((double)q[k]);
        r.o[k] = q[k] + (spread > 0.0 ? spread : 1.0) * (mesh_random() - 0.5); /* off the plane of a flat mesh */
        r.d[k] = i % 3 ? target - r.o[k] : mesh_random() - 0.5;
    }
    return r;
}

static void test_rays(void)
{
    for (size_t k = 0; k < MESH_KIND_COUNT; k++) {
        mesh_kind kind = mesh_kinds[k];
        if (kind.count > 2000) kind.count = 2000;
        mesh m = mesh_make(&kind);
        layouts l = make_layouts(&m);
        uint32_t hits = 0, wrong2 = 0, wrong8 = 0, rays = m.triangle_count ? 300 : 0;
        for (uint32_t i = 0; i < rays; i++) {
            ray r = make_ray(&m, i);
            hit truth = trace_all(&m, &r), h2 = trace2(&l, &r), h8 = trace8(&l, &r);
            hits += truth.id != EC_NO_ID;
            wrong2 += h2.id != truth.id || h2.t != truth.t;
            wrong8 += h8.id != truth.id || h8.t != truth.t;
        }
        CHECK_MSG(!wrong2 && !wrong8, "%s: %u binary, %u 8-wide of %u rays differ", m.name, wrong2, wrong8, rays);
        printf("%s: %u of %u rays hit\n", m.name, hits, rays);
        free_layouts(&l);
        mesh_free(&m);
    }
}

int main(void)
{
    test_single_leaf_roots();
    test_invariants_and_thread_counts();
    test_rays();
    TEST_END();
}
