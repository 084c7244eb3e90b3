/* tier: quick */
/* A triangle cut by a plane: the boxes of its parts against points calculated by hand, and in whole numbers, where nothing is rounded. They
 * must contain the exact parts, and be larger by a few ulps only. */
#include <float.h>

#include "accel/build_internal.h"
#include "test_accel_meshes.h"

/* For an edge with ends of size |a| + |b|: 4 FLT_EPSILON of margin, and as much for the rounding errors that it covers. */
#define ULPS 8.0

static ec_v4 vertex(double x, double y, double z) { return (ec_v4){(float)x, (float)y, (float)z, 0.0f}; }

static ec_box4 box_of(const ec_v4 v[3])
{
    ec_box4 box = ec_box4_empty();
    for (int k = 0; k < 3; k++) ec_box4_grow(&box, v[k], v[k]);
    return box;
}

/* ---- by hand ----
 * A (0, 0, 0), B (3, 1, 0), C (0, 2, 1), and the plane x = 1. On AB, a third of the way: (1, 1/3, 0). On BC, two thirds of the way:
 * (1, 1 + 2/3, 2/3). None of the three fractions is a float. The part below is A, C and these two points: x 0 to 1, y 0 to 2,
 * z 0 to 1. The part above is B and they: x 1 to 3, y 1/3 to 5/3, z 0 to 2/3. In thirds: */
static const double corners[3][3] = {{0, 0, 0}, {3, 1, 0}, {0, 2, 1}};
static const double thirds[2][2][3] = {{{0, 0, 0}, {3, 6, 3}}, {{3, 1, 0}, {9, 5, 2}}};
/* |a| + |b| along each axis, for the longer of the two cut edges. */
static const double sizes[3] = {3, 3, 1};

/* The example with its axis k as axis order[k], mirrored where sign is -1, and with its vertices in another order. */
static void check_hand(const int order[3], const double sign[3], int first, int step)
{
    ec_v4 v[3];
    ec_box4 part[2];
    for (int k = 0; k < 3; k++) {
        const double *corner = corners[(first + step * k) % 3];
        v[k] = ec_v4_all(0.0f);
        for (int axis = 0; axis < 3; axis++) v[k][order[axis]] = (float)(sign[axis] * corner[axis]) + 0.0f;
    }
    ec_box4 box = box_of(v);
    ec_triangle_cut(v, &box, order[0], (float)sign[0], part);
    for (int side = 0; side < 2; side++)
        for (int axis = 0; axis < 3; axis++) {
            const ec_box4 *got = &part[sign[0] < 0 ? 1 - side : side];
            double lo = got->lo[order[axis]], hi = got->hi[order[axis]], slack = ULPS * FLT_EPSILON * sizes[axis];
            double below = sign[axis] < 0 ? -hi : lo, above = sign[axis] < 0 ? -lo : hi;
            /* Three times a float is exact in double. */
            CHECK_MSG(3.0 * below <= thirds[side][0][axis] && 3.0 * above >= thirds[side][1][axis], "side %d, axis %d: %.9g to %.9g lose some",
                      side, axis, below, above);
            CHECK_MSG(below >= thirds[side][0][axis] / 3.0 - slack && above <= thirds[side][1][axis] / 3.0 + slack,
                      "side %d, axis %d: %.9g to %.9g are too many", side, axis, below, above);
        }
    /* On the plane itself, and where vertices are the ends, nothing is rounded. */
    CHECK(part[0].hi[order[0]] == (float)sign[0] && part[1].lo[order[0]] == (float)sign[0]);
    for (int axis = 0; axis < 3; axis++) {
        const ec_box4 *whole = &part[sign[0] < 0]; /* the part with A and C */
        CHECK(axis == 0 || (whole->lo[order[axis]] == box.lo[order[axis]] && whole->hi[order[axis]] == box.hi[order[axis]]));
    }
}

static void test_by_hand(void)
{
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int o = 0; o < 6; o++)
        for (int s = 0; s < 8; s++) {
            const double sign[3] = {s & 1 ? -1 : 1, s & 2 ? -1 : 1, s & 4 ? -1 : 1};
            for (int first = 0; first < 3; first++)
                for (int step = 1; step <= 2; step++) check_hand(orders[o], sign, first, step);
        }
}

static void check_exactly(const ec_box4 *got, const double lo[3], const double hi[3], const char *what)
{
    for (int axis = 0; axis < 3; axis++)
        CHECK_MSG(got->lo[axis] == (float)lo[axis] && got->hi[axis] == (float)hi[axis], "%s, axis %d: %.9g to %.9g, expected %g to %g", what, axis,
                  (double)got->lo[axis], (double)got->hi[axis], lo[axis], hi[axis]);
}

static int is_empty(const ec_box4 *box) { return box->lo[0] > box->hi[0] || box->lo[1] > box->hi[1] || box->lo[2] > box->hi[2]; }

/* This triangle where no edge is cut between its ends, or where the box is already that of a part. */
static void test_at_vertices(void)
{
    const ec_v4 v[3] = {vertex(0, 0, 0), vertex(3, 1, 0), vertex(0, 2, 1)};
    const ec_box4 whole = box_of(v), quarter = {vertex(0, 0.5, 0), vertex(2, 1.5, 1)};
    ec_box4 part[2];
    ec_triangle_cut(v, &whole, 0, 0.0f, part); /* the edge AC is in the plane */
    check_exactly(&part[0], (double[3]){0, 0, 0}, (double[3]){0, 2, 1}, "AC below");
    check_exactly(&part[1], (double[3]){0, 0, 0}, (double[3]){3, 2, 1}, "all above");
    ec_triangle_cut(v, &whole, 0, 3.0f, part); /* B */
    check_exactly(&part[0], (double[3]){0, 0, 0}, (double[3]){3, 2, 1}, "all below");
    check_exactly(&part[1], (double[3]){3, 1, 0}, (double[3]){3, 1, 0}, "B above");
    ec_triangle_cut(v, &whole, 0, 4.0f, part);
    check_exactly(&part[0], (double[3]){0, 0, 0}, (double[3]){3, 2, 1}, "all below, nothing above");
    CHECK(is_empty(&part[1]));
    /* The middle of AC is (0, 1, 1/2); on BC the point is B itself, since B is at y = 1. */
    ec_triangle_cut(v, &whole, 1, 1.0f, part);
    check_exactly(&part[1], (double[3]){0, 1, 0}, (double[3]){3, 2, 1}, "above B");
    CHECK(part[0].lo[2] == 0.0f && part[0].hi[2] >= 0.5f && part[0].hi[2] <= 0.5f + (float)ULPS * FLT_EPSILON);
    ec_triangle_cut(v, &quarter, 0, 1.0f, part); /* never outside the given box: of y = 1/3 to 5/3, 1/2 to 3/2 is left */
    CHECK(part[1].lo[0] == 1.0f && part[1].hi[0] == 2.0f && part[1].lo[1] == 0.5f && part[1].hi[1] == 1.5f);
    CHECK(part[0].lo[0] == 0.0f && part[0].hi[0] == 1.0f && part[0].lo[1] == 0.5f && part[0].hi[1] == 1.5f);
}

/* ---- in whole numbers ----
 * Corners and plane are whole numbers. Where an edge is cut, the point is a fraction of two whole numbers below 2^23, and a float times its
 * denominator is exact in double. */
typedef struct exact {
    double lo[3], hi[3], size[3];
    int points;
} exact;

static void add_point(exact *e, const ec_box4 *got, const double up[3], double down, int side, uint32_t *lost)
{
    for (int axis = 0; axis < 3; axis++) {
        *lost += got->lo[axis] * down > up[axis] || got->hi[axis] * down < up[axis];
        e[side].lo[axis] = fmin(e[side].lo[axis], up[axis] / down);
        e[side].hi[axis] = fmax(e[side].hi[axis], up[axis] / down);
    }
    e[side].points++;
}

static void test_in_whole_numbers(void)
{
    uint32_t lost = 0, loose = 0, cut = 0;
    for (int i = 0; i < 200000; i++) {
        double p[3][3], at = floor(2000 * (double)mesh_random()) - 1000;
        ec_v4 v[3];
        for (int k = 0; k < 3; k++) {
            for (int axis = 0; axis < 3; axis++) p[k][axis] = floor((i % 5 ? 2000.0 : 20.0) * (double)mesh_random()) - (i % 5 ? 1000.0 : 10.0);
            v[k] = vertex(p[k][0], p[k][1], p[k][2]);
        }
        ec_box4 box = box_of(v), part[2];
        int axis = i % 3;
        if (i % 5 == 0) at = floor(at / 100);
        ec_triangle_cut(v, &box, axis, (float)at, part);
        exact e[2];
        for (int side = 0; side < 2; side++)
            e[side] = (exact){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, {0, 0, 0}, 0};
        for (int k = 0; k < 3; k++) {
            const double *a = p[k], *b = p[(k + 1) % 3];
            if (a[axis] <= at) add_point(e, &part[0], a, 1.0, 0, &lost);
            if (a[axis] >= at) add_point(e, &part[1], a, 1.0, 1, &lost);
            if ((a[axis] - at) * (b[axis] - at) >= 0) continue;
            double down = fabs(b[axis] - a[axis]), along = fabs(at - a[axis]), up[3];
            for (int c = 0; c < 3; c++) up[c] = a[c] * down + (b[c] - a[c]) * along;
            for (int side = 0; side < 2; side++) {
                add_point(e, &part[side], up, down, side, &lost);
                for (int c = 0; c < 3; c++) e[side].size[c] = fmax(e[side].size[c], fabs(a[c]) + fabs(b[c]));
            }
            cut++;
        }
        for (int side = 0; side < 2; side++) {
            if (!e[side].points) loose += !is_empty(&part[side]);
            for (int c = 0; c < 3 && e[side].points; c++) {
                double slack = c == axis ? 0.0 : ULPS * FLT_EPSILON * e[side].size[c] + FLT_MIN;
                loose += part[side].lo[c] < e[side].lo[c] - slack || part[side].hi[c] > e[side].hi[c] + slack;
            }
        }
    }
    CHECK_MSG(cut > 100000, "%u edges cut", cut);
    CHECK_MSG(!lost, "%u sides of boxes leave out a point of %u edges cut", lost, cut);
    CHECK_MSG(!loose, "%u sides of boxes are too large", loose);
}

int main(void)
{
    test_by_hand();
    test_at_vertices();
    test_in_whole_numbers();
    TEST_END();
}
