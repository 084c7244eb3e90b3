/* Triangles for bench_build: generated, or read from a file. */
#ifndef EC_BENCH_BUILD_MESH_H
#define EC_BENCH_BUILD_MESH_H

#include <stdint.h>

typedef struct bench_mesh {
    float *positions;
    uint32_t *indices;
    uint32_t vertex_count, triangle_count;
} bench_mesh;

/* what: a number of spheres, or a path that ends in .obj or .ply. 0 on failure. */
int bench_mesh_open(const char *what, bench_mesh *mesh);
void bench_mesh_free(bench_mesh *mesh);

#endif
