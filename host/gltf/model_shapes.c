/* Makes quads, boxes and spheres. */
#include <math.h>
#include <stdlib.h>

#include "base/vec3.h"
#include "gltf/model.h"

void ec_model_quad(ec_model *m, int32_t material, const double at[3], const double u[3], const double v[3])
{
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    static const float uv[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    float positions[12];
    for (int k = 0; k < 3; k++) {
        positions[k] = (float)at[k];
        positions[3 + k] = (float)(at[k] + u[k]);
        positions[6 + k] = (float)(at[k] + u[k] + v[k]);
        positions[9 + k] = (float)(at[k] + v[k]);
    }
    ec_model_add(m, material, &(ec_model_mesh){.vertex_count = 4, .index_count = 6, .positions = positions, .uv = uv, .indices = order});
}

void ec_model_box(ec_model *m, int32_t material, const double low[3], const double high[3], bool inwards)
{
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        double u[3] = {0}, v[3] = {0}, at[3] = {low[0], low[1], low[2]};
        u[a] = high[a] - low[a], v[b] = high[b] - low[b];
        ec_model_quad(m, material, at, inwards ? u : v, inwards ? v : u);
        at[k] = high[k];
        ec_model_quad(m, material, at, inwards ? v : u, inwards ? u : v);
    }
}

/* Computes point (i, j) on the unit sphere of an octahedron's face whose sides have n parts. Equal inputs give equal bits, so that faces meet without
 * cracks. */
static void point_on_face(int face, int i, int j, int n, double p[3])
{
    double s[3] = {(double)(n - i - j) / n, (double)i / n, (double)j / n};
    ec_normalize(s);
    for (int k = 0; k < 3; k++) p[k] = face >> k & 1 ? -s[k] : s[k];
}

void ec_model_sphere(ec_model *m, int32_t material, const double center[3], double radius, int levels, bool smooth)
{
    int n = 1 << levels;
    uint32_t per_face = (uint32_t)(n + 1) * (uint32_t)(n + 2) / 2, used = 0, corners = 0;
    float *positions = malloc((size_t)8 * per_face * 3 * sizeof *positions),
          *normals = malloc((size_t)8 * per_face * 3 * sizeof *normals);
    uint32_t *indices = malloc((size_t)8 * (size_t)n * (size_t)n * 3 * sizeof *indices);
    if (positions && normals && indices) {
        for (int face = 0; face < 8; face++) {
            uint32_t first = used;
            bool mirrored = (face ^ face >> 1 ^ face >> 2) & 1;
            for (int j = 0; j <= n; j++)
                for (int i = 0; i + j <= n; i++, used++) {
                    double p[3];
                    point_on_face(face, i, j, n, p);
                    for (int k = 0; k < 3; k++) {
                        normals[3 * used + k] = (float)p[k];
                        positions[3 * used + k] = (float)(center[k] + radius * p[k]);
                    }
                }
            for (int j = 0, row = 0; j < n; row += n + 1 - j, j++)
                for (int i = 0; i + j < n; i++) {
                    uint32_t a = first + (uint32_t)(row + i), b = a + 1, c = a + (uint32_t)(n + 1 - j), d = c + 1;
                    uint32_t up[3] = {a, b, c}, down[3] = {b, d, c};
                    for (int t = 0; t < (i + j + 1 < n ? 2 : 1); t++)
                        for (int k = 0; k < 3; k++) indices[corners++] = (t ? down : up)[mirrored ? 2 - k : k];
                }
        }
    }
    /* Without memory the mesh has no vertices, and ec_model_scene fails for lack of triangles or of memory. */
    ec_model_add(m, material, &(ec_model_mesh){.vertex_count = used, .index_count = corners, .positions = positions,
                                               .normals = smooth ? normals : NULL, .indices = indices});
    free(positions);
    free(normals);
    free(indices);
}
