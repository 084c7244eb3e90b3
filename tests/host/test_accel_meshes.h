/* Easy meshes, and meshes that break builders. Each triangle has its own three vertices. */
#ifndef EC_TESTS_HOST_TEST_ACCEL_MESHES_H
#define EC_TESTS_HOST_TEST_ACCEL_MESHES_H

#include <stdint.h>

#include "support/test.h"

typedef struct mesh {
    const char *name;
    float *positions;
    uint32_t *indices;
    uint32_t triangle_count;
} mesh;

static uint32_t mesh_random_state = 1;

static inline float mesh_random(void) /* [0, 1) */
{
    mesh_random_state ^= mesh_random_state << 13;
    mesh_random_state ^= mesh_random_state >> 17;
    mesh_random_state ^= mesh_random_state << 5;
    return (float)(mesh_random_state >> 8) * (1.0f / 16777216.0f);
}

/* Writes the nine coordinates of triangle i of n. */
typedef void mesh_triangle(uint32_t i, uint32_t n, float *p);

static inline void triangle_small(uint32_t i, uint32_t n, float *p)
{
    (void)i;
    float at[3] = {mesh_random(), mesh_random(), mesh_random()}, size = 2.0f / cbrtf((float)n + 1.0f);
    for (int k = 0; k < 9; k++) p[k] = at[k % 3] + size * (mesh_random() - 0.5f);
}

static inline void triangle_sliver(uint32_t i, uint32_t n, float *p)
{
    (void)i, (void)n;
    for (int k = 0; k < 6; k++) p[k] = mesh_random();
    for (int k = 0; k < 3; k++) p[6 + k] = p[k] + 1e-6f * mesh_random();
}

static inline void triangle_coplanar(uint32_t i, uint32_t n, float *p)
{
    triangle_small(i, n, p);
    p[1] = p[4] = p[7] = 0.25f;
}

static inline void triangle_coincident(uint32_t i, uint32_t n, float *p)
{
    static const float same[9] = {-1, -2, 3, 4, 5, -6, 7, -8, 9};
    (void)i, (void)n;
    memcpy(p, same, sizeof same);
}

/* One centre, many sizes: centroids do not help. Mirrored, so that the centres agree to the last bit. */
static inline void triangle_concentric(uint32_t i, uint32_t n, float *p)
{
    float size = (float)(i + 1) / (float)n;
    const float corners[9] = {-size, -size, -size, size, size, size, size, -size, 0};
    memcpy(p, corners, sizeof corners);
}

static inline void triangle_point(uint32_t i, uint32_t n, float *p)
{
    (void)n;
    for (int k = 0; k < 9; k++) p[k] = (float)(i % 7);
}

static inline void triangle_line_up(uint32_t i, uint32_t n, float *p)
{
    (void)n;
    const float corners[9] = {(float)i, 0, 0, (float)i + 0.5f, 0, 0, (float)i + 0.25f, 1, 0};
    memcpy(p, corners, sizeof corners);
}

static inline void scale_triangle(float *p, float by)
{
    for (int k = 0; k < 9; k++) p[k] *= by;
}

static inline void triangle_huge(uint32_t i, uint32_t n, float *p)
{
    triangle_small(i, n, p);
    scale_triangle(p, 1e30f);
}

static inline void triangle_tiny(uint32_t i, uint32_t n, float *p)
{
    triangle_small(i, n, p);
    scale_triangle(p, 1e-30f);
}

static inline void triangle_largest(uint32_t i, uint32_t n, float *p) /* edges of boxes overflow */
{
    (void)i, (void)n;
    for (int k = 0; k < 9; k++) p[k] = (mesh_random() < 0.5f ? -3e38f : 3e38f) * mesh_random();
}

static inline void triangle_denormal(uint32_t i, uint32_t n, float *p)
{
    triangle_small(i, n, p);
    scale_triangle(p, 1e-42f);
}

/* Distances over the whole range of floats: every plane cuts off only the outermost few, so SAH trees become very deep. */
static inline void triangle_exponential(uint32_t i, uint32_t n, float *p)
{
    float at = exp2f(-120.0f + 240.0f * (float)i / (float)n);
    for (int k = 0; k < 9; k++) p[k] = at * (1.0f + 0.01f * (float)(k % 4));
}

/* Boxes whose lower corners are 0 or -0, which compare equal. */
static inline void triangle_signed_zero(uint32_t i, uint32_t n, float *p)
{
    triangle_small(i, n, p);
    for (int k = 0; k < 9; k++) p[k] = i % 3 ? fabsf(p[k]) : i % 2 ? -0.0f : 0.0f;
}

/* Every tenth triangle is long, thin and diagonal, with small triangles all along it. Unless it is cut, the tree is poor. */
static inline void triangle_beam(uint32_t i, uint32_t n, float *p)
{
    triangle_small(i, n, p);
    if (i % 10) return;
    for (int k = 0; k < 6; k++) p[k] = mesh_random();
    for (int k = 0; k < 3; k++) p[6 + k] = p[k] + 0.02f * mesh_random();
}

/* The twelve axis-parallel triangles of a cube's sides, and a few large ones inside, among small ones. */
static inline void triangle_room(uint32_t i, uint32_t n, float *p)
{
    triangle_small(i, n, p);
    if (i >= 64) return;
    int axis = (int)(i / 4 % 3), side = (int)(i / 2 % 2), half = (int)(i % 2);
    for (int corner = 0; corner < 3; corner++) {
        int along = corner == 1 || (half && corner == 0), across = corner == 2 || (half && corner == 0);
        p[3 * corner + axis] = i < 12 ? (float)side : (float)i / 64.0f;
        p[3 * corner + (axis + 1) % 3] = (float)along;
        p[3 * corner + (axis + 2) % 3] = (float)across;
    }
}

typedef struct mesh_kind {
    const char *name;
    mesh_triangle *triangle;
    uint32_t count;
} mesh_kind;

static const mesh_kind mesh_kinds[] = {
    {"none", triangle_small, 0},
    {"one", triangle_small, 1},
    {"two", triangle_small, 2},
    {"a leaf", triangle_small, 8},
    {"a leaf and one", triangle_small, 9},
    {"a sweep", triangle_small, 64},
    {"a sweep and one", triangle_small, 65},
    {"small", triangle_small, 5000},
    {"several chunks", triangle_small, 70000},
    {"slivers", triangle_sliver, 3000},
    {"coplanar", triangle_coplanar, 3000},
    {"coincident", triangle_coincident, 70000},
    {"concentric", triangle_concentric, 10000},
    {"points", triangle_point, 1000},
    {"line-up", triangle_line_up, 20000},
    {"huge", triangle_huge, 2000},
    {"tiny", triangle_tiny, 2000},
    {"largest", triangle_largest, 2000},
    {"denormal", triangle_denormal, 2000},
    {"exponential", triangle_exponential, 4000},
    {"signed zeros", triangle_signed_zero, 70000},
    {"beams", triangle_beam, 4000},
    {"many beams", triangle_beam, 70000},
    {"room", triangle_room, 4000},
};
#define MESH_KIND_COUNT (sizeof mesh_kinds / sizeof mesh_kinds[0])

static inline mesh mesh_make(const mesh_kind *kind)
{
    mesh m = {.name = kind->name, .triangle_count = kind->count};
    m.positions = malloc((kind->count + 1) * 9 * sizeof *m.positions);
    m.indices = malloc((kind->count + 1) * 3 * sizeof *m.indices);
    mesh_random_state = 12345;
    for (uint32_t i = 0; i < kind->count; i++) kind->triangle(i, kind->count, m.positions + 9 * (size_t)i);
    for (uint32_t i = 0; i < 3 * kind->count; i++) m.indices[i] = i;
    return m;
}

static inline void mesh_free(mesh *m)
{
    free(m->positions);
    free(m->indices);
}

#endif
