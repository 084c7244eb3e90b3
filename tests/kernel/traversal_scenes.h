/* Every accelerator against the 8-wide BVH, bit by bit in triangle, barycentrics and t, on many rays in whole scenes. */
#ifndef EC_TESTS_KERNEL_TRAVERSAL_SCENES_H
#define EC_TESTS_KERNEL_TRAVERSAL_SCENES_H

#include <unistd.h>

#include "kernel/traversal_run.h"
#include "gltf/reader.h"

/* The triangles of a glTF file. */
static inline set set_scene(const char *name, const char *path)
{
    ec_error err = {0};
    ec_scene *scene = NULL;
    CHECK_OK(ec_scene_load(path, &scene, NULL, &err), err);
    set s = set_make(name, scene ? scene->triangle_count : 0, 0.0f);
    for (size_t i = 0; i < 3 * (size_t)s.triangles; i++) memcpy(s.vertices + 3 * i, scene->positions + 3 * (size_t)scene->indices[i], 12);
    if (scene) ec_scene_free(scene);
    set_finish(&s);
    s.size = s.scene_max;
    return s;
}

/* A surface over a grid of rows and columns of points, two triangles a cell, written from triangle `first` on. */
typedef void surface_point(double u, double v, float *p);
static inline void add_surface(set *s, uint32_t first, uint32_t rows, uint32_t columns, surface_point *point)
{
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t k = 0; k < columns; k++) {
            float *p = s->vertices + 9 * (size_t)(first + 2 * (i * columns + k));
            const uint32_t corners[6][2] = {{i, k}, {i + 1, k}, {i, k + 1}, {i + 1, k}, {i + 1, k + 1}, {i, k + 1}};
            for (int c = 0; c < 6; c++) point((double)corners[c][0] / rows, (double)(corners[c][1] % columns) / columns, p + 3 * c);
        }
}

static inline void bumpy_sphere(double u, double v, float *p)
{
    double a = 3.141592653589793 * u, b = 6.283185307179586 * v, r = 1.0 + 0.03 * sin(40 * a) * sin(40 * b);
    p[0] = (float)(r * sin(a) * cos(b));
    p[1] = (float)(r * cos(a));
    p[2] = (float)(r * sin(a) * sin(b));
}
static inline set set_million(void)
{
    set s = set_make("a million triangles", 2 * 707 * 708, 1.0f);
    add_surface(&s, 0, 707, 708, bumpy_sphere);
    return s;
}

/* A rotated pot, 30 cm wide and 20 high, in the middle of an oval of stands 300 m long: 7200 triangles in the pot and 480 in the rest, a
 * teapot in a stadium. */
static inline void pot(double u, double v, float *p)
{
    static const double radius[] = {0, 0.08, 0.085, 0.12, 0.15, 0.148, 0.12, 0.08, 0.09, 0.06, 0.02, 0.025, 0};
    static const double height[] = {0, 0, 0.01, 0.03, 0.07, 0.1, 0.14, 0.15, 0.155, 0.17, 0.18, 0.195, 0.2};
    double at = 12 * u, angle = 6.283185307179586 * v;
    int i = at < 11 ? (int)at : 11;
    double f = at - i, r = (1 - f) * radius[i] + f * radius[i + 1];
    p[0] = (float)(r * cos(angle));
    p[1] = (float)((1 - f) * height[i] + f * height[i + 1]);
    p[2] = (float)(r * sin(angle));
}
static inline void stands(double u, double v, float *p)
{
    double angle = 6.283185307179586 * v, out = 1 + 0.5 * u;
    p[0] = (float)(100 * out * cos(angle));
    p[1] = (float)(-1 + 40 * u * u);
    p[2] = (float)(60 * out * sin(angle));
}
static inline set set_stadium(void)
{
    set s = set_make("a teapot in a stadium", 2 * (60 * 60 + 4 * 60), 150.0f);
    add_surface(&s, 0, 60, 60, pot);
    add_surface(&s, 2 * 60 * 60, 4, 60, stands);
    return s;
}

/* Coplanar triangles, each four times. */
static inline set set_coplanar_duplicates(uint32_t n)
{
    set s = set_coplanar(n, 1);
    s.name = "coplanar duplicates";
    for (uint32_t i = n / 4; i < n / 4 * 4; i++) memcpy(s.vertices + 9 * i, s.vertices + 9 * (i % (n / 4)), 36);
    return s;
}

static inline void check_rays(set s, uint32_t rays)
{
    const uint32_t most = 1u << 20, wave = rays < most ? rays : most;
    ec_accel accels[EC_ACCEL_COUNT];
    float *paths = malloc(4 * EC_PATH_FIELDS * (size_t)wave), *hits = malloc(4 * EC_HIT_PROBE_FIELDS * (size_t)wave);
    float *expected = malloc(4 * EC_HIT_PROBE_FIELDS * (size_t)wave);
    const tracer *reference = tracers;
    while (reference->accel != ec_accel_find("bvh8")) reference++;
    uint64_t hit = 0;
    set_finish(&s);
    bool good = build_accels(&s, accels);
    for (uint32_t done = 0; good && done < rays; done += wave) {
        uint32_t count = rays - done < wave ? rays - done : wave;
        memset(paths, 0, 4 * EC_PATH_FIELDS * (size_t)wave);
        memset(hits, 0, 4 * EC_HIT_PROBE_FIELDS * (size_t)wave);
        make_rays(&s, paths, wave, EC_PATH_FIELDS, EC_PATH_PRIM, true);
        good = intersect(&s, reference, &accels[reference->accel], wave, count, paths, expected);
        for (uint32_t i = 0; good && i < tracer_count; i++) {
            const tracer *t = &tracers[i];
            if (t == reference || !accels[t->accel].buffers[0].data) continue;
            good = intersect(&s, t, &accels[t->accel], wave, count, paths, hits);
            uint32_t found = good ? same_hits(&s, paths, wave, count, hits, expected, t->label, reference->label) : 0;
            if (t->accel == ec_accel_find("kdtree")) hit += found;
        }
    }
    printf("%s: %u triangles, %.1f %% of %u rays hit\n", s.name, s.triangles, 100.0 * (double)hit / rays, rays);
    fflush(stdout);
    CHECK_MSG(hit > rays / 20, "%s: only %llu rays hit", s.name, (unsigned long long)hit);
    free_accels(accels);
    free(paths);
    free(hits);
    free(expected);
    free(s.vertices);
}

static inline int check_scenes(uint32_t rays)
{
    int open = open_tracers(false);
    if (open) return open;
    const char *sponza = ECLAT_SHARED "/assets/classic/gltf/sponza-dabrovic/sponza-dabrovic.gltf";
    check_rays(set_scene("cornell-box", ECLAT_SOURCE_DIR "/scenes/cornell-box/cornell-box.gltf"), rays);
    if (access(sponza, R_OK) == 0) check_rays(set_scene("sponza-dabrovic", sponza), rays);
    else printf("sponza-dabrovic is not there: left out\n");
    check_rays(set_million(), rays);
    check_rays(set_stadium(), rays);
    check_rays(set_slivers(20000), rays);
    check_rays(set_tilted(3000), rays);
    check_rays(set_coplanar_duplicates(3000), rays);
    check_rays(set_blocks(20000), rays);
    check_rays(set_fan(10000), rays);
    close_tracers();
    TEST_END();
}

#endif
