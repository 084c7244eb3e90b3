/* tiers: quick, long */
/* Ray-triangle intersection against double precision; every lane width must give the same bits. */
#include "kernel/kernel_reference.h"

static float rays[6 * N], triangles[9 * N], hits[4 * N];

static void cross(const double *a, const double *b, double *c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

typedef struct exact_hit {
    double t, b1, b2, inside; /* inside: the smallest barycentric coordinate, < 0 outside */
    double cosine;            /* between ray and normal */
    bool parallel, front;
} exact_hit;

/* Moeller and Trumbore 1997 in double, with the float inputs. */
static exact_hit exact_intersection(uint32_t i)
{
    double o[3], d[3], e1[3], e2[3], s[3], p[3], q[3], normal[3];
    for (uint32_t k = 0; k < 3; k++) {
        double v0 = triangles[k * N + i];
        o[k] = rays[k * N + i];
        d[k] = rays[(3 + k) * N + i];
        e1[k] = triangles[(3 + k) * N + i] - v0;
        e2[k] = triangles[(6 + k) * N + i] - v0;
        s[k] = o[k] - v0;
    }
    cross(d, e2, p);
    cross(s, e1, q);
    cross(e1, e2, normal);
    double det = dot(e1, p);
    exact_hit h = {.parallel = det == 0, .front = dot(normal, d) < 0};
    h.cosine = fabs(dot(normal, d)) / sqrt(dot(normal, normal) * dot(d, d));
    if (h.parallel) return h;
    h.b1 = dot(s, p) / det;
    h.b2 = dot(d, q) / det;
    h.t = dot(e2, q) / det;
    h.inside = fmin(fmin(h.b1, h.b2), 1 - h.b1 - h.b2);
    return h;
}

/* Triangles of edge `size` about points up to `position`; rays hit them at cosines of about `cosine`. */
static void make_intersections(double size, double position, double cosine)
{
    for (uint32_t i = 0; i < N; i++) {
        double at[3], v[9], e1[3], e2[3], normal[3], length;
        for (int k = 0; k < 3; k++) at[k] = position * test_random_in(-1, 1);
        for (int k = 0; k < 9; k++) v[k] = at[k % 3] + size * test_random_in(-1, 1);
        for (int k = 0; k < 3; k++) e1[k] = v[3 + k] - v[k], e2[k] = v[6 + k] - v[k];
        cross(e1, e2, normal);
        length = sqrt(dot(normal, normal));
        double b1 = test_random_in(-0.2, 1.2), b2 = test_random_in(-0.2, 1.2) * (1 - b1), tangent[3], side = i % 2 ? -1 : 1, distance;
        double edge = sqrt(dot(e1, e1)), d[3];
        distance = size * pow(10, test_random_in(-1, 2));
        double c = cosine > 0 ? cosine : test_random_in(0.05, 1), r = sqrt(1 - c * c);
        cross(normal, e1, tangent);
        double angle = test_random_in(-pi, pi);
        for (int k = 0; k < 3; k++) d[k] = r * (cos(angle) * e1[k] / edge + sin(angle) * tangent[k] / (length * edge)) + c * side * normal[k] / length;
        for (uint32_t k = 0; k < 3; k++) {
            rays[k * N + i] = (float)(v[k] + b1 * e1[k] + b2 * e2[k] - distance * d[k]);
            rays[(3 + k) * N + i] = (float)(d[k] * (i % 3 ? 1.0 : distance)); /* also lengths other than 1 */
        }
        for (uint32_t k = 0; k < 9; k++) triangles[k * N + i] = (float)v[k];
    }
}

static void check_intersections(double size, double position, double cosine)
{
    static double worst_t;
    make_intersections(size, position, cosine);
    float scene_max = 0;
    for (uint32_t i = 0; i < 9 * N; i++) scene_max = fmaxf(scene_max, fabsf(triangles[i]));
    if (!RUN_ALL("intersection_of", 4, SCALAR(n), SCALAR(scene_max), IN(rays, 6 * N), IN(triangles, 9 * N), OUT(hits, 4 * N))) return;
    uint32_t hit = 0, decided = 0;
    for (uint32_t i = 0; i < N && test_failures < 8; i++) {
        exact_hit e = exact_intersection(i);
        if (e.parallel) continue;
        double reach = 0, e1[3], e2[3], normal[3], longest = 0, length = 0;
        for (uint32_t k = 0; k < 3; k++) {
            double o = rays[k * N + i], a = triangles[k * N + i], b = triangles[(3 + k) * N + i], c = triangles[(6 + k) * N + i];
            reach = fmax(reach, fmax(fabs(a - o), fmax(fabs(b - o), fabs(c - o))));
            e1[k] = b - a, e2[k] = c - a;
            longest += (b - a) * (b - a) + (c - b) * (c - b) + (a - c) * (a - c);
            length += (double)rays[(3 + k) * N + i] * rays[(3 + k) * N + i];
        }
        length = sqrt(length);
        longest = sqrt(longest);
        cross(e1, e2, normal);
        double area2 = sqrt(dot(normal, normal));
        /* The vertices in the ray's frame have an error of about 8 u of their distance. Along the triangle that is 1 / cosine times as
         * much; in barycentrics it is divided by the smallest height. */
        double slack = 8 * U * reach / e.cosine * longest / fmax(area2, 1e-300) + 8 * U;
        double t = hits[i];
        bool got = t >= 0.0f;
        hit += got;
        double t_slack = (8 * U * reach / e.cosine) / length + 8 * U * fabs(e.t);
        if (e.inside > 4 * slack && e.t > 4 * t_slack + 16 * U * reach / length) {
            decided++;
            CHECK_MSG(got, "size %g position %g cosine %g, %u: a miss; barycentrics %g %g, t %g, slack %g", size, position, e.cosine, i, e.b1, e.b2, e.t, slack);
        }
        if (e.inside < -4 * slack || e.t < -4 * t_slack) {
            decided++;
            CHECK_MSG(!got, "size %g position %g cosine %g, %u: a hit; barycentrics %g %g, t %g, slack %g", size, position, e.cosine, i, e.b1, e.b2, e.t, slack);
        }
        if (!got) continue;
        CHECK_MSG(fabs(t - e.t) <= 4 * t_slack, "size %g position %g cosine %g, %u: t %.9g, double gives %.9g (+- %.2g)", size, position, e.cosine, i, t, e.t, t_slack);
        worst_t = fmax(worst_t, fabs(t - e.t) / t_slack);
        CHECK_MSG(fabs(hits[N + i] - e.b1) <= 4 * slack && fabs(hits[2 * N + i] - e.b2) <= 4 * slack,
                  "size %g position %g cosine %g, %u: barycentrics %.9g %.9g, double gives %.9g %.9g (+- %.2g)", size, position, e.cosine, i,
                  (double)hits[N + i], (double)hits[2 * N + i], e.b1, e.b2, slack);
        CHECK_MSG((hits[3 * N + i] == 1.0f) == e.front || e.cosine < 1e-5, "size %g, %u: front %g", size, i, (double)hits[3 * N + i]);
    }
    CHECK_MSG(hit > N / 8 && decided > (cosine > 0 ? N / 8 : N / 2), "size %g position %g cosine %g: %u hits, %u decided", size, position, cosine, hit, decided);
    if (cosine > 0) printf("intersection: cosine %g, error of t %.2f times 8 u reach / cosine so far\n", cosine, worst_t);
}

static void intersections_are_right(void)
{
    static const double sizes[4] = {1e-3, 1, 30, 1e3}, positions[4] = {0, 1, 30, 1e3};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++)
            if (positions[k] <= 1e4 * sizes[i]) check_intersections(sizes[i], positions[k], 0);
    for (double cosine = 0.1; cosine > 3e-5; cosine *= 0.1) check_intersections(1, 0, cosine);
}

/* A triangle without a normal or an area is never hit, and gives no NaN. */
static void degenerate_triangles_are_missed(void)
{
    make_intersections(1, 1, 0);
    for (uint32_t i = 0; i < N; i++)
        for (uint32_t k = 0; k < 3; k++) {
            if (i % 3 == 0) triangles[(6 + k) * N + i] = triangles[k * N + i];                /* two equal corners */
            if (i % 3 == 1) triangles[(3 + k) * N + i] = triangles[(6 + k) * N + i] = triangles[k * N + i];
            if (i % 3 == 2) triangles[(3 + k) * N + i] = triangles[(6 + k) * N + i] = rays[k * N + i]; /* at the origin */
        }
    const float scene_max = 1000.0f;
    if (!RUN_ALL("intersection_of", 4, SCALAR(n), SCALAR(scene_max), IN(rays, 6 * N), IN(triangles, 9 * N), OUT(hits, 4 * N))) return;
    for (uint32_t i = 0; i < 4 * N; i++) CHECK_MSG(hits[i] == (i < N ? -1.0f : 0.0f), "%u: %g", i % N, (double)hits[i]);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    for (int i = 0; i < kernel_widths(&cl); i++) programs[i] = kernel_build(&cl, "ray", lane_widths[i], NULL);
    if (!test_failures) {
        intersections_are_right();
        degenerate_triangles_are_missed();
    }
    for (int i = 0; i < kernel_widths(&cl); i++)
        if (programs[i]) clReleaseProgram(programs[i]);
    ec_cl_close(&cl);
    TEST_END();
}
