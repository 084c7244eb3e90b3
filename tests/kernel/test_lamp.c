/* tiers: quick, long */
/* Triangles as lamps, against double precision: solid angle, the mapping from random numbers to points, densities that agree from both
 * sides, and no NaN where a point touches its lamp. (Distributions: test_chi2_lights.c.) */
#include "kernel/kernel_reference.h"

static float points[3 * N], corners[9 * N], u[2 * N], out[10 * N];

static void cross(const double *a, const double *b, double *c)
{
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double length(const double *a) { return sqrt(dot(a, a)); }

/* van Oosterom and Strackee 1983. condition: the factor by which rounding errors of the corners grow. */
static double solid_angle(const double *a, const double *b, const double *c, double *condition)
{
    double n[3], e1[3], e2[3], la = length(a), lb = length(b), lc = length(c);
    for (int k = 0; k < 3; k++) e1[k] = b[k] - a[k], e2[k] = c[k] - a[k];
    cross(e1, e2, n);
    double d = fabs(dot(a, n)) / (la * lb * lc), e = 1 + dot(a, b) / (la * lb) + dot(b, c) / (lb * lc) + dot(c, a) / (lc * la);
    *condition = la * length(e1) * length(e2) / fabs(dot(a, n)) + 1 / sqrt(d * d + e * e);
    return 2 * atan2(d, e);
}

typedef struct lamp {
    double v[3][3], p[3], seen[3][3], area, solid_angle, condition;
} lamp;

static lamp lamp_of(uint32_t i)
{
    lamp l;
    double e1[3], e2[3], normal[3];
    for (uint32_t k = 0; k < 3; k++) {
        l.p[k] = points[k * N + i];
        for (uint32_t c = 0; c < 3; c++) l.v[c][k] = corners[(3 * c + k) * N + i], l.seen[c][k] = l.v[c][k] - l.p[k];
        e1[k] = l.v[1][k] - l.v[0][k];
        e2[k] = l.v[2][k] - l.v[0][k];
    }
    cross(e1, e2, normal);
    l.area = length(normal) / 2;
    l.solid_angle = solid_angle(l.seen[0], l.seen[1], l.seen[2], &l.condition);
    return l;
}

static void set(uint32_t i, const double *p, const double *v0, const double *v1, const double *v2)
{
    for (uint32_t k = 0; k < 3; k++) {
        points[k * N + i] = (float)p[k];
        corners[k * N + i] = (float)v0[k];
        corners[(3 + k) * N + i] = (float)v1[k];
        corners[(6 + k) * N + i] = (float)v2[k];
    }
}

static bool run(void)
{
    for (uint32_t i = 0; i < 2 * N; i++) u[i] = (float)(test_random_u64() >> 40) * 0x1p-24f;
    u[0] = u[1] = u[N] = u[N + 2] = 0.0f;
    u[2] = u[3] = u[N + 1] = u[N + 3] = 0x1.fffffep-1f;
    return RUN_ALL("lamps", 4, SCALAR(n), IN(points, 3 * N), IN(corners, 9 * N), IN(u, 2 * N), OUT(out, 10 * N));
}

/* Holds for every lamp: the sample is a point of it; if it can be sampled it has a density; the density is never NaN. */
static void check_sound(uint32_t i, const char *name)
{
    float b1 = out[N + i], b2 = out[2 * N + i], pdf = out[3 * N + i], found = out[4 * N + i];
    CHECK_MSG(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1.000001f, "%s %u: barycentrics %g, %g", name, i, (double)b1, (double)b2);
    if (out[5 * N + i] != 0)
        CHECK_MSG(pdf > 0 && isfinite(pdf), "%s %u: sampled with density %g", name, i, (double)pdf);
    CHECK_MSG(out[5 * N + i] != 0 || !(found > 0 && isfinite(found)) || out[6 * N + i] == 0, "%s %u: never sampled, found with density %g", name, i, (double)found);
    if (out[6 * N + i] != 0) CHECK_MSG(found >= 0 && isfinite(found), "%s %u: found with density %g", name, i, (double)found);
}

/* Lamps with edges up to `size` at distance 1, randomly rotated. Each term has four roundings relative to 1. */
static void check_lamps(double size)
{
    for (uint32_t i = 0; i < N; i++) {
        double p[3], v[3][3], towards[3];
        for (int k = 0; k < 3; k++) p[k] = test_random_in(-1, 1), towards[k] = test_random_in(-1, 1);
        double scale = 1 / length(towards);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) v[c][k] = p[k] + towards[k] * scale + size / 2 * test_random_in(-1, 1);
        set(i, p, v[0], v[1], v[2]);
    }
    if (!run()) return;
    double worst = 0, worst_ratio = 0, worst_pdf = 0, worst_map = 0;
    uint32_t near = 0;
    for (uint32_t i = 0; i < N && test_failures < 8; i++) {
        lamp l = lamp_of(i);
        double error = fabs(out[i] / l.solid_angle - 1), bound = 4 * U * l.condition + 2e-6;
        CHECK_MSG(error < bound, "lamp %u of %g: solid angle %g, not %g: off by %g", i, size, (double)out[i], l.solid_angle, error);
        if (l.condition < 1000) worst = fmax(worst, error);
        worst_ratio = fmax(worst_ratio, error / bound);
        check_sound(i, "lamp");
        double b1 = out[N + i], b2 = out[2 * N + i], b0 = 1 - b1 - b2, pdf = out[3 * N + i], found = out[4 * N + i];
        bool is_near = out[6 * N + i] != 0;
        near += is_near;
        double w[3], e1[3], e2[3], normal[3];
        for (uint32_t k = 0; k < 3; k++) w[k] = out[(7 + k) * N + i], e1[k] = l.v[1][k] - l.v[0][k], e2[k] = l.v[2][k] - l.v[0][k];
        cross(e1, e2, normal);
        double want = is_near ? 1 / l.solid_angle : pow(length(w), 3) / (fabs(dot(w, normal)) / 2);
        if (l.condition < 1000) worst_pdf = fmax(worst_pdf, fabs(pdf / want - 1));
        CHECK_MSG(is_near ? pdf == found : fabs(found / pdf - 1) < 1e-6 * l.condition, "lamp %u: density %.9g, found again %.9g", i, pdf, found);
        /* The mapping: u1 is the share of the solid angle up to the arc through the point, u2 that of 1 - cosine along the arc. */
        double m[3], q[3], condition, share = b0 + b2;
        if (share < 1e-3) continue; /* at the corner b the arc is undefined */
        for (int k = 0; k < 3; k++) {
            m[k] = (b0 * l.seen[0][k] + b2 * l.seen[2][k]) / share;
            q[k] = b0 * l.seen[0][k] + b1 * l.seen[1][k] + b2 * l.seen[2][k];
        }
        double lb = length(l.seen[1]), whole[3], part[3];
        for (int k = 0; k < 3; k++) whole[k] = m[k] / length(m) - l.seen[1][k] / lb, part[k] = q[k] / length(q) - l.seen[1][k] / lb;
        double u1 = solid_angle(l.seen[0], l.seen[1], m, &condition) / l.solid_angle, u2 = dot(part, part) / dot(whole, whole);
        double off = fmax(fabs(u1 - u[i]), fabs(u2 - u[N + i])), most = 64 * U * l.condition / share + 1e-5;
        CHECK_MSG(off < most || dot(whole, whole) == 0, "lamp %u of %g: (%g, %g) went where (%g, %g) belongs", i, size, (double)u[i], (double)u[N + i], u1, u2);
        if (l.condition < 1000 && share > 0.1) worst_map = fmax(worst_map, off);
    }
    printf("lamps of %g: %u near; solid angle off by %.1e (%.2f of its bound), density by %.1e, map by %.1e\n", size, near, worst,
           worst_ratio, worst_pdf, worst_map);
    CHECK(worst < 1e-3 && worst_pdf < 1e-3);
}

/* Points that touch the lamp: at a corner, on an edge, on its face, in its plane beside it; and 1e-2 to 1e-9 above these. */
static void check_touching(void)
{
    for (uint32_t i = 0; i < N; i++) {
        double v[3][3], p[3], b[3], normal[3], e1[3], e2[3], h = i / 4 % 9 == 8 ? 0 : pow(10, -2.0 - i / 4 % 9);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) v[c][k] = i % 3 == 0 ? (double)test_random_in(-1, 1) : (float)floor(8 * test_random_in(-1, 1));
        for (int k = 0; k < 3; k++) b[k] = test_random_in(0.1, 1);
        if (i % 4 < 2) b[i / 8 % 3] = 0;
        if (i % 4 == 0) b[(i / 8 + 1) % 3] = 0;
        if (i % 4 == 3) b[i / 8 % 3] *= -0.5;
        double sum = b[0] + b[1] + b[2];
        for (int k = 0; k < 3; k++) e1[k] = v[1][k] - v[0][k], e2[k] = v[2][k] - v[0][k];
        cross(e1, e2, normal);
        double scale = length(normal);
        for (int k = 0; k < 3; k++) {
            p[k] = (b[0] * v[0][k] + b[1] * v[1][k] + b[2] * v[2][k]) / sum;
            if (scale > 0) p[k] += h * normal[k] / scale;
        }
        set(i, p, v[0], v[1], v[2]);
    }
    if (!run()) return;
    for (uint32_t i = 0; i < N && test_failures < 8; i++)
        if (lamp_of(i).area > 0) check_sound(i, "touching");
}

/* Sizes of 1e-6 and 1e6 times the distance: a point, and half of the view. */
static void check_extremes(void)
{
    for (uint32_t i = 0; i < N; i++) {
        double size = i % 2 ? 1e6 : 1e-6, p[3], v[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        for (int k = 0; k < 3; k++) p[k] = test_random_in(-1, 1) * 1e-3 - (k == 1);
        for (int c = 0; c < 3; c++) {
            double turn = 2 * pi * (c + test_random_in(-0.1, 0.1)) / 3;
            v[c][0] = size * cos(turn), v[c][2] = size * sin(turn);
        }
        set(i, p, v[0], v[1], v[2]);
    }
    if (!run()) return;
    double worst[2] = {0, 0};
    for (uint32_t i = 0; i < N && test_failures < 8; i++) {
        lamp l = lamp_of(i);
        check_sound(i, "extreme");
        CHECK(out[6 * N + i] == (i % 2 ? 1.0f : 0.0f) && out[5 * N + i] == 1.0f);
        worst[i % 2] = fmax(worst[i % 2], fabs(out[3 * N + i] * l.solid_angle - 1));
    }
    printf("lamps of 1e-6 and 1e6: density times solid angle off by %.1e, %.1e\n", worst[0], worst[1]);
    CHECK(worst[0] < 5e-6 && worst[1] < 5e-6); /* at 1e-6 of the distance, densities differ by 3e-6 */
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (int i = 0; i < kernel_widths(&cl); i++) programs[i] = kernel_build(&cl, "lamp", lane_widths[i], "-DFEATURES=EC_FEATURE_AREA_LIGHTS");
    if (!test_failures) {
        static const double sizes[] = {4, 1, 0.1, 0.01};
        for (int i = 0; i < 4; i++) check_lamps(sizes[i]);
        check_touching();
        check_extremes();
    }
    for (int i = 0; i < kernel_widths(&cl); i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    ec_cl_close(&cl);
    TEST_END();
}
