/* tier: quick */
/* Meshes that could make a builder explode. The memory of every structure must grow linearly with the triangles. The stack is so small that
 * a recursion as deep as the mesh is large would overflow it. The test counts memory, not time, so that no machine is too slow. A quadratic
 * build of the largest mesh would take 10^10 steps and end in ctest's timeout. */
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"
#include "support/test.h"

enum { MANY = 100000, FEW = 20000, STACK = 512 * 1024, ENTRIES_MOST = 64 };

typedef void corner_function(uint32_t triangle, uint32_t count, float p[9]);

static void coincident(uint32_t t, uint32_t n, float p[9])
{
    (void)t, (void)n;
    memcpy(p, (const float[9]){0, 0, 0, 1, 0, 0.5f, 0, 1, 0}, 9 * sizeof *p);
}

/* All triangles have the same centre: no plane and no centroid separates them. */
static void concentric(uint32_t t, uint32_t n, float p[9])
{
    float r = (float)(t + 1) / (float)n;
    memcpy(p, (const float[9]){-r, -r, -r, r, r, r, r, -r, 0}, 9 * sizeof *p);
}

/* All triangles contain one line, and are rotated about it. */
static void fan(uint32_t t, uint32_t n, float p[9])
{
    float angle = 6.2831853f * (float)t / (float)n;
    memcpy(p, (const float[9]){0, 0, -1, 0, 0, 1, cosf(angle), sinf(angle), 0}, 9 * sizeof *p);
}

/* Diagonal needles with an aspect ratio of 1e8, whose boxes all overlap. */
static void needles(uint32_t t, uint32_t n, float p[9])
{
    float at = (float)t / (float)n;
    memcpy(p, (const float[9]){at, 0, 0, 1 - at, 1, 1, at + 1e-8f, 1e-8f, 0}, 9 * sizeof *p);
}

/* Each distance is half of the previous one: all magnitudes of float at once. */
static void halving(uint32_t t, uint32_t n, float p[9])
{
    (void)n;
    float size = ldexpf(1, -(int)(t % 100));
    memcpy(p, (const float[9]){size, 0, 0, 2 * size, 0, 0, size, size, 0}, 9 * sizeof *p);
}

/* Most triangles are in a speck, and one is as large as a stadium around it. */
static void stadium(uint32_t t, uint32_t n, float p[9])
{
    float at = (float)t / (float)n * 1e-4f, reach = t ? 1e-6f : 1e4f;
    memcpy(p, (const float[9]){at, at, at, at + reach, at, at, at, at + reach, at}, 9 * sizeof *p);
}

typedef struct job {
    const char *name;
    corner_function *corner;
    ec_accel_stats stats[EC_ACCEL_COUNT];
    uint32_t count, max_depth;
} job;

static void *build_all(void *argument)
{
    job *j = argument;
    float *positions = malloc(j->count * 9 * sizeof *positions);
    uint32_t *indices = malloc(j->count * 3 * sizeof *indices);
    ec_accel_input input = {.positions = positions, .indices = indices, .triangle_count = j->count, .threads = 1};
    for (uint32_t t = 0; t < j->count; t++) j->corner(t, j->count, positions + 9 * (size_t)t);
    for (uint32_t i = 0; i < 3 * j->count; i++) indices[i] = i;
    for (uint32_t which = 0; which < EC_ACCEL_COUNT; which++) {
        if (which == ec_accel_find("none")) continue;
        ec_accel accel;
        ec_error err;
        CHECK_OK(ec_accel_build(which, &input, &accel, &err), err);
        j->stats[which] = accel.stats;
        ec_accel_free(&accel);
    }
    j->max_depth = input.bvh_stats.max_depth;
    ec_accel_input_free(&input);
    free(positions);
    free(indices);
    return NULL;
}

static job build_on_a_small_stack(const char *name, corner_function *corner, uint32_t count)
{
    job j = {.name = name, .corner = corner, .count = count};
    pthread_attr_t attributes;
    pthread_t thread;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, STACK);
    CHECK(pthread_create(&thread, &attributes, build_all, &j) == 0 && pthread_join(thread, NULL) == 0);
    pthread_attr_destroy(&attributes);
    return j;
}

static void grows_no_faster_than_the_mesh(const char *name, corner_function *corner)
{
    job few = build_on_a_small_stack(name, corner, FEW), many = build_on_a_small_stack(name, corner, MANY);
    CHECK_MSG(many.max_depth <= 64, "%s: a tree %u deep", name, many.max_depth);
    for (uint32_t which = 0; which < EC_ACCEL_COUNT; which++) {
        const ec_accel_stats *s = &few.stats[which], *m = &many.stats[which];
        if (!m->bytes) continue;
        printf("%-10s %-6s %9llu references, %9llu nodes, %6.1f MB\n", name, ec_accels[which].name, (unsigned long long)m->references,
               (unsigned long long)m->nodes, (double)m->bytes / 1e6);
        CHECK_MSG(m->references <= (uint64_t)ENTRIES_MOST * MANY, "%s: %llu references", name, (unsigned long long)m->references);
        CHECK_MSG((double)m->bytes <= 2.0 * MANY / FEW * (double)s->bytes, "%s in %s: %llu bytes for %d triangles, %llu for %d", name,
                  ec_accels[which].name, (unsigned long long)s->bytes, FEW, (unsigned long long)m->bytes, MANY);
    }
}

int main(void)
{
    grows_no_faster_than_the_mesh("coincident", coincident);
    grows_no_faster_than_the_mesh("concentric", concentric);
    grows_no_faster_than_the_mesh("fan", fan);
    grows_no_faster_than_the_mesh("needles", needles);
    grows_no_faster_than_the_mesh("halving", halving);
    grows_no_faster_than_the_mesh("stadium", stadium);
    TEST_END();
}
