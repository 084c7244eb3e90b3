/* tier: quick */
/* Closed surfaces from inside, through every accelerator: no ray may leave, especially at vertices and edges. */
#include "kernel/traversal_run.h"

typedef struct sphere {
    float *points;
    uint32_t *corners;
    uint32_t point_count, triangle_count;
} sphere;

static uint32_t sphere_point(sphere *s, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    float *p = s->points + 3 * s->point_count;
    p[0] = (float)(x / length);
    p[1] = (float)(y / length);
    p[2] = (float)(z / length);
    for (uint32_t i = 0; i < s->point_count; i++) /* few enough for testing all */
        if (memcmp(s->points + 3 * i, p, 3 * sizeof *p) == 0) return i;
    return s->point_count++;
}

/* An octahedron, each triangle divided into four `levels` times. */
static sphere sphere_make(int levels)
{
    static const uint32_t faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    sphere s = {malloc(3 * 8192 * sizeof(float)), malloc(24 * sizeof(uint32_t)), 0, 8};
    for (int axis = 0; axis < 3; axis++)
        for (int side = 1; side >= -1; side -= 2) sphere_point(&s, axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0);
    memcpy(s.corners, faces, sizeof faces);
    for (int level = 0; level < levels; level++) {
        uint32_t *finer = malloc(12 * s.triangle_count * sizeof *finer);
        for (uint32_t t = 0; t < s.triangle_count; t++) {
            const uint32_t *c = s.corners + 3 * t;
            uint32_t m[3];
            for (int k = 0; k < 3; k++) {
                const float *a = s.points + 3 * c[k], *b = s.points + 3 * c[(k + 1) % 3];
                m[k] = sphere_point(&s, (double)a[0] + b[0], (double)a[1] + b[1], (double)a[2] + b[2]);
            }
            const uint32_t four[12] = {c[0], m[0], m[2], m[0], c[1], m[1], m[2], m[1], c[2], m[0], m[1], m[2]};
            memcpy(finer + 12 * t, four, sizeof four);
        }
        free(s.corners);
        s.corners = finer;
        s.triangle_count *= 4;
    }
    return s;
}

#define SPHERE_RAYS 65536u

/* Rays from inside towards vertices, edges and other points: none may leave. */
static void check_sphere(const sphere *shape, float scale, const float at[3], const float stretch[3], const char *name)
{
    set s = set_make(name, shape->triangle_count, scale);
    for (uint32_t i = 0; i < 3 * s.triangles; i++)
        for (int k = 0; k < 3; k++) s.vertices[3 * i + k] = at[k] + scale * stretch[k] * shape->points[3 * shape->corners[i] + k];
    set_finish(&s);
    ec_accel accels[EC_ACCEL_COUNT];
    float *paths = calloc(EC_PATH_FIELDS * SPHERE_RAYS, sizeof *paths), *hits = calloc(EC_HIT_PROBE_FIELDS * SPHERE_RAYS, sizeof *hits);
    uint32_t *words = (uint32_t *)paths;
    for (uint32_t i = 0; i < SPHERE_RAYS; i++) {
        const float *v = s.vertices + 9 * random_below(s.triangles);
        float a = random_float(0, 1), b = random_float(0, 1 - a), o[3], d[3];
        if (i % 5 < 2) a = b = 0.0f;
        else if (i % 5 < 4) b = 0.0f;
        if (i % 7 == 0) a = 0.5f * (float)(i % 5 > 1);
        for (int k = 0; k < 3; k++) {
            o[k] = at[k] + scale * stretch[k] * (i % 11 == 0 ? 0.0f : random_float(-0.55, 0.55));
            d[k] = v[k] + a * (v[3 + k] - v[k]) + b * (v[6 + k] - v[k]) - o[k];
            if (i % 13 == 0 && k != (int)(i / 13 % 3)) { /* along an axis, through vertices on the equators */
                o[k] = i % 2 ? at[k] : v[k] * 0.5f + at[k] * 0.5f;
                d[k] = i % 4 < 2 ? 0.0f : -0.0f;
            }
        }
        float length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(length > 0.0f)) d[0] = length = 1.0f;
        for (uint32_t k = 0; k < 3; k++) {
            paths[k * SPHERE_RAYS + i] = o[k];
            paths[(3 + k) * SPHERE_RAYS + i] = d[k] / length;
        }
        words[EC_PATH_PRIM * SPHERE_RAYS + i] = EC_NO_ID;
    }
    if (build_accels(&s, accels))
        for (uint32_t k = 0; k < tracer_count; k++) {
            const tracer *t = &tracers[k];
            if (!accels[t->accel].buffers[0].data) continue;
            if (!intersect(&s, t, &accels[t->accel], SPHERE_RAYS, SPHERE_RAYS, paths, hits)) continue;
            uint32_t leaks = 0, first = 0;
            for (uint32_t i = 0; i < SPHERE_RAYS; i++)
                if (((const uint32_t *)hits)[i] == EC_NO_ID && !leaks++) first = i;
            if (leaks) print_ray(&s, paths, SPHERE_RAYS, first, EC_NO_ID);
            CHECK_MSG(leaks == 0, "%s, %s: %u of %u rays leave a closed surface", name, t->label, leaks, SPHERE_RAYS);
        }
    free_accels(accels);
    free(paths);
    free(hits);
    free(s.vertices);
}

static void closed_surfaces_have_no_cracks(void)
{
    sphere shape = sphere_make(4);
    CHECK(shape.triangle_count == 2048 && shape.point_count == 1026); /* closed: Euler's V - F / 2 = 2 */
    static const float here[3] = {0, 0, 0}, there[3] = {700.0f, -300.0f, 1.0f / 3}, round[3] = {1, 1, 1}, flat[3] = {1, 1e-4f, 1};
    check_sphere(&shape, 1.0f, here, round, "sphere");
    check_sphere(&shape, 1.0f, there, round, "sphere far away");
    check_sphere(&shape, 1e-6f, here, round, "tiny sphere");
    check_sphere(&shape, 1e6f, here, round, "huge sphere");
    check_sphere(&shape, 1.0f, here, flat, "flat ellipsoid");
    free(shape.points);
    free(shape.corners);
}

int main(void)
{
    int open = open_tracers(false);
    if (open) return open;
    closed_surfaces_have_no_cracks();
    close_tracers();
    TEST_END();
}
