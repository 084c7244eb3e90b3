/* tier: quick */
/* The binary tree: its invariants on easy and hostile meshes, equal bits for any number of threads, and its cost. */
#include "accel/bvh.h"
#include "support/bvh_check.h"
#include "test_accel_meshes.h"

static void check_promises(const mesh *m, const ec_bvh *bvh, const ec_bvh_stats *stats)
{
    ec_error err;
    CHECK_MSG(bvh_check(bvh, m->positions, m->indices, &err) == EC_OK, "%s: %s", m->name, err.text);
    CHECK_MSG(stats->max_depth < 64, "%s: depth %u", m->name, stats->max_depth);
    CHECK_MSG(stats->node_count == 2 * stats->leaf_count - 1, "%s", m->name);
    CHECK_MSG(stats->leaf_fill <= 1.0 && (stats->leaf_fill > 0.1 || m->triangle_count < 2), "%s: fill %g", m->name, stats->leaf_fill);
}

/* -0 would make the bits of equal boxes differ, depending on the order in which threads finish. */
static void test_no_negative_zeros(void)
{
    ec_error err;
    mesh m = mesh_make(&(mesh_kind){"signed zeros", triangle_signed_zero, 70000});
    ec_bvh bvh;
    CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 0, &bvh, NULL, &err), err);
    uint32_t zeros = 0, negative = 0;
    for (uint32_t i = 0; i < bvh.node_count; i++)
        for (int axis = 0; axis < 3; axis++) {
            zeros += bvh.nodes[i].lo[axis] == 0.0f;
            negative += bvh.nodes[i].lo[axis] == 0.0f && signbit(bvh.nodes[i].lo[axis]);
        }
    CHECK(zeros > 0);
    CHECK_MSG(!negative, "%u of %u zeros are negative", negative, zeros);
    ec_bvh_free(&bvh);
    mesh_free(&m);
}

/* The loader should drop such vertices. If it does not, the tree is poor but complete. */
static void test_not_numbers(void)
{
    ec_error err;
    mesh m = mesh_make(&(mesh_kind){"not numbers", triangle_small, 3000});
    for (uint32_t i = 0; i < 9 * m.triangle_count; i += 7)
        m.positions[i] = i % 3 == 0 ? NAN : i % 3 == 1 ? INFINITY : -INFINITY;
    ec_bvh bvh;
    CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 0, &bvh, NULL, &err), err);
    CHECK_OK(bvh_check(&bvh, m.positions, m.indices, &err), err);
    ec_bvh_free(&bvh);
    mesh_free(&m);
}

static void test_promises_and_thread_counts(void)
{
    ec_error err;
    for (size_t k = 0; k < MESH_KIND_COUNT; k++) {
        mesh m = mesh_make(&mesh_kinds[k]);
        ec_bvh one, other;
        CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 1, &one, NULL, &err), err);
        for (uint32_t threads = 2; threads <= 5; threads += 3) {
            ec_bvh_stats stats;
            CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, threads, &other, &stats, &err), err);
            int same = one.node_count == other.node_count &&
                       !memcmp(one.nodes, other.nodes, one.node_count * sizeof *one.nodes) &&
                       one.ref_count == other.ref_count && !one.boxes == !other.boxes &&
                       !memcmp(one.order, other.order, one.ref_count * sizeof *one.order) &&
                       (!one.boxes || !memcmp(one.boxes, other.boxes, one.ref_count * sizeof *one.boxes));
            CHECK_MSG(same, "%s: %u threads build another tree than one", m.name, threads);
            if (threads == 5) check_promises(&m, &other, &stats);
            ec_bvh_free(&other);
        }
        ec_bvh_free(&one);
        mesh_free(&m);
    }
}

static int is_in(const ec_box *box, const double p[3], double slack)
{
    for (int axis = 0; axis < 3; axis++)
        if (p[axis] < box->lo[axis] - slack || p[axis] > box->hi[axis] + slack) return 0;
    return 1;
}

/* Every point of a triangle is in one of its parts: inner points, and points on its edges and corners. */
static void check_coverage(const mesh *m, const ec_bvh *bvh)
{
    uint32_t *first = calloc(m->triangle_count + 2, sizeof *first), *refs = malloc(bvh->ref_count * sizeof *refs);
    for (uint32_t i = 0; i < bvh->ref_count; i++) first[bvh->order[i] + 2]++;
    for (uint32_t id = 0; id < m->triangle_count; id++) first[id + 2] += first[id + 1];
    for (uint32_t i = 0; i < bvh->ref_count; i++) refs[first[bvh->order[i] + 1]++] = i;
    uint32_t lost = 0, most = 0;
    for (uint32_t id = 0; id < m->triangle_count; id++) {
        uint32_t count = first[id + 1] - first[id];
        if (count > most) most = count;
        for (int k = 0; count > 1 && k < 200; k++) {
            double a = k % 3 ? mesh_random() : k % 2, b = k % 5 < 2 ? 0.0 : (1.0 - a) * mesh_random(), p[3];
            const float *v = m->positions + 9 * (size_t)id;
            for (int axis = 0; axis < 3; axis++) p[axis] = (1.0 - a - b) * v[axis] + a * v[3 + axis] + b * v[6 + axis];
            int found = 0; /* a few roundings of the point itself, in double */
            for (uint32_t i = first[id]; i < first[id + 1] && !found; i++) found = is_in(&bvh->boxes[refs[i]], p, 1e-14);
            lost += !found;
        }
    }
    printf("%s: %u references of %u triangles, at most %u of one\n", m->name, bvh->ref_count, m->triangle_count, most);
    CHECK_MSG(!lost, "%s: %u points lie in no box of their triangle", m->name, lost);
    CHECK_MSG(most > 2, "%s: %u references of one triangle at most: nothing to see", m->name, most);
    free(first);
    free(refs);
}

static void test_cuts(void)
{
    ec_error err;
    const mesh_kind cut[] = {{"beams", triangle_beam, 4000}, {"many beams", triangle_beam, 70000},
                             {"room", triangle_room, 4000}};
    const mesh_kind whole[] = {{"small", triangle_small, 5000}, {"line-up", triangle_line_up, 20000},
                               {"few beams", triangle_beam, 1000}};
    for (int k = 0; k < 3; k++) {
        mesh m = mesh_make(&cut[k]);
        ec_bvh bvh;
        ec_bvh_stats stats;
        CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 0, &bvh, &stats, &err), err);
        CHECK(bvh.boxes && bvh.ref_count == stats.ref_count);
        CHECK_MSG(bvh.ref_count > m.triangle_count && bvh.ref_count <= 1.3 * m.triangle_count, "%s: %u", m.name, bvh.ref_count);
        if (bvh.boxes) check_coverage(&m, &bvh);
        ec_bvh_free(&bvh);
        mesh_free(&m);
    }
    for (int k = 0; k < 3; k++) { /* cutting gains nothing, or too little */
        mesh m = mesh_make(&whole[k]);
        ec_bvh bvh;
        CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 0, &bvh, NULL, &err), err);
        CHECK_MSG(!bvh.boxes && bvh.ref_count == m.triangle_count, "%s: %u references", m.name, bvh.ref_count);
        ec_bvh_free(&bvh);
        mesh_free(&m);
    }
}

/* The checker must find errors. */
static void test_check_sees_damage(void)
{
    ec_error err;
    mesh m = mesh_make(&(mesh_kind){"small", triangle_small, 500});
    ec_bvh bvh;
    CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 0, &bvh, NULL, &err), err);

    uint32_t leaf = bvh.node_count - 1; /* the last node is a leaf */
    uint32_t *ids = bvh.order + bvh.nodes[leaf].first, id = ids[0];
    CHECK(bvh.nodes[leaf].count >= 2);
    ids[0] = ids[1];
    CHECK(bvh_check(&bvh, m.positions, m.indices, &err) == EC_FAILED && strstr(err.text, "held already"));
    ids[0] = id;

    float hi = bvh.nodes[leaf].hi[1];
    bvh.nodes[leaf].hi[1] = nextafterf(hi, -1e9f);
    CHECK(bvh_check(&bvh, m.positions, m.indices, &err) == EC_FAILED && strstr(err.text, "sticks out of BVH leaf"));
    bvh.nodes[leaf].hi[1] = hi;

    float lo = bvh.nodes[0].lo[0];
    bvh.nodes[0].lo[0] = nextafterf(lo, 1e9f);
    CHECK(bvh_check(&bvh, m.positions, m.indices, &err) == EC_FAILED && strstr(err.text, "its parent"));
    bvh.nodes[0].lo[0] = lo;

    bvh.nodes[leaf].count--;
    CHECK(bvh_check(&bvh, m.positions, m.indices, &err) == EC_FAILED);
    bvh.nodes[leaf].count++;
    CHECK_OK(bvh_check(&bvh, m.positions, m.indices, &err), err);
    ec_bvh_free(&bvh);
    mesh_free(&m);

    m = mesh_make(&(mesh_kind){"beams", triangle_beam, 4000});
    CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 0, &bvh, NULL, &err), err);
    CHECK_OK(bvh_check(&bvh, m.positions, m.indices, &err), err);
    for (uint32_t i = 0; bvh.boxes && i < bvh.ref_count; i++) {
        float hi_0 = bvh.boxes[i].hi[0];
        if (bvh.order[i] % 10) continue;
        for (int k = 0; k < 3; k++) bvh.boxes[i].hi[0] = nextafterf(bvh.boxes[i].hi[0], -1.0f);
        if (bvh_check(&bvh, m.positions, m.indices, &err) != EC_OK) break; /* the part with the far end */
        bvh.boxes[i].hi[0] = hi_0;
    }
    CHECK(strstr(err.text, "does not hold all of triangle"));
    ec_bvh_free(&bvh);
    mesh_free(&m);
}

/* A reference that tests every plane between neighbours, with the builder's costs: 1 for a visit, 2 for a block of 8. */
typedef struct reference {
    float (*lo)[3], (*hi)[3];
    int axis;
} reference;
static const reference *compared;

static int by_centroid(const void *a, const void *b)
{
    uint32_t i = *(const uint32_t *)a, k = *(const uint32_t *)b;
    float x = compared->lo[i][compared->axis] + compared->hi[i][compared->axis];
    float y = compared->lo[k][compared->axis] + compared->hi[k][compared->axis];
    return x < y ? -1 : x > y ? 1 : i < k ? -1 : 1;
}

static double area_of(const reference *r, const uint32_t *ids, uint32_t count)
{
    double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};
    for (uint32_t i = 0; i < count; i++)
        for (int axis = 0; axis < 3; axis++) {
            lo[axis] = fmin(lo[axis], r->lo[ids[i]][axis]);
            hi[axis] = fmax(hi[axis], r->hi[ids[i]][axis]);
        }
    double x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x * y + y * z + z * x;
}

static double reference_cost(reference *r, uint32_t *ids, uint32_t count)
{
    double area = area_of(r, ids, count), best = 1e300;
    int best_axis = 0;
    uint32_t best_left = 0;
    compared = r;
    for (r->axis = 0; r->axis < 3; r->axis++) {
        qsort(ids, count, sizeof *ids, by_centroid);
        for (uint32_t left = 1; left < count; left++) {
            double cost = 2.0 * ((left + 7) / 8) * area_of(r, ids, left) +
                          2.0 * ((count - left + 7) / 8) * area_of(r, ids + left, count - left);
            if (cost < best) best = cost, best_axis = r->axis, best_left = left;
        }
    }
    if (count <= 8 && best + area >= 2.0 * area) return 2.0 * area;
    r->axis = best_axis;
    qsort(ids, count, sizeof *ids, by_centroid);
    return area + reference_cost(r, ids, best_left) + reference_cost(r, ids + best_left, count - best_left);
}

static void test_cost(void)
{
    ec_error err;
    mesh_triangle *kinds[] = {triangle_small, triangle_sliver, triangle_line_up};
    for (int kind = 0; kind < 3; kind++) {
        mesh m = mesh_make(&(mesh_kind){"cost", kinds[kind], 600});
        ec_bvh bvh;
        ec_bvh_stats stats;
        CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 0, &bvh, &stats, &err), err);
        reference r = {malloc(m.triangle_count * sizeof *r.lo), malloc(m.triangle_count * sizeof *r.hi), 0};
        uint32_t *ids = malloc(m.triangle_count * sizeof *ids);
        for (uint32_t i = 0; i < m.triangle_count; i++) {
            ids[i] = i;
            const float *p = m.positions + 9 * (size_t)i;
            for (int axis = 0; axis < 3; axis++) {
                r.lo[i][axis] = fminf(p[axis], fminf(p[3 + axis], p[6 + axis]));
                r.hi[i][axis] = fmaxf(p[axis], fmaxf(p[3 + axis], p[6 + axis]));
            }
        }
        double root = area_of(&r, ids, m.triangle_count), cost = reference_cost(&r, ids, m.triangle_count) / root;
        printf("mesh %d: cost %.3f, of a full sweep %.3f\n", kind, stats.sah_cost, cost);
        CHECK_MSG(stats.sah_cost <= 1.1 * cost, "%g against %g", stats.sah_cost, cost);
        CHECK_MSG(stats.sah_cost >= 0.8 * cost, "%g against %g: measured wrongly?", stats.sah_cost, cost);
        free(r.lo);
        free(r.hi);
        free(ids);
        ec_bvh_free(&bvh);
        mesh_free(&m);
    }
}

int main(void)
{
    test_no_negative_zeros();
    test_not_numbers();
    test_promises_and_thread_counts();
    test_cuts();
    test_check_sees_damage();
    test_cost();
    ec_bvh_free(NULL);
    TEST_END();
}
