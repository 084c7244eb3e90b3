#include "gltf/cube.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec3.h"
#include "gltf/gltf.h"

enum { WIDTH_MOST = 4096 };

/* The middle of each face, and the directions in which its columns and rows advance. */
static const struct {
    double middle[3], right[3], down[3];
} frames[6] = {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
               {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};

void ec_cube_free(ec_cube *cube)
{
    for (int f = 0; f < 6; f++) free(cube->face[f]);
    *cube = (ec_cube){0};
}

/* Returns the face that direction d (of any length) meets, and where on it: *right and *down are -1 to 1. */
static int meet(const double d[3], double *right, double *down)
{
    int axis = fabs(d[0]) >= fabs(d[1]) ? 0 : 1;
    if (fabs(d[2]) > fabs(d[axis])) axis = 2;
    int f = 2 * axis + (d[axis] < 0);
    *right = ec_dot(d, frames[f].right) / fabs(d[axis]);
    *down = ec_dot(d, frames[f].down) / fabs(d[axis]);
    return f;
}

static int64_t nearest(double at, int64_t size)
{
    int64_t i = (int64_t)floor((at + 1) / 2 * (double)size);
    return i < 0 ? 0 : i >= size ? size - 1 : i;
}

/* Reads pixel (x, y) of a face; either coordinate may be one beyond the edge, where the neighbouring face is read. At a corner, where only three
 * pixels meet, their mean stands for the fourth, so that all three faces interpolate to the same value there. */
static void texel(const ec_cube *cube, int f, int64_t x, int64_t y, double rgb[3])
{
    int64_t size = cube->size, in_x = x < 0 ? 0 : x >= size ? size - 1 : x, in_y = y < 0 ? 0 : y >= size ? size - 1 : y;
    if (in_x != x && in_y != y) {
        double own[3], beside[3], below[3];
        texel(cube, f, in_x, in_y, own);
        texel(cube, f, x, in_y, beside);
        texel(cube, f, in_x, y, below);
        for (int k = 0; k < 3; k++) rgb[k] = (own[k] + beside[k] + below[k]) / 3;
        return;
    }
    if (in_x != x || in_y != y) { /* a quarter of a pixel beyond the edge the neighbour's pixels still lie beside this one's */
        double right = (2 * (double)in_x + 1) / (double)size - 1, down = (2 * (double)in_y + 1) / (double)size - 1, d[3];
        if (in_x != x) right = copysign(1 + 0.5 / (double)size, right + (x < 0 ? -1 : 1));
        if (in_y != y) down = copysign(1 + 0.5 / (double)size, down + (y < 0 ? -1 : 1));
        for (int k = 0; k < 3; k++) d[k] = frames[f].middle[k] + right * frames[f].right[k] + down * frames[f].down[k];
        f = meet(d, &right, &down);
        in_x = nearest(right, size);
        in_y = nearest(down, size);
    }
    const float *at = cube->face[f] + 3 * (in_y * size + in_x);
    for (int k = 0; k < 3; k++) rgb[k] = at[k];
}

static void add_bilinear(const ec_cube *cube, const double d[3], double sum[3])
{
    double right, down, four[4][3];
    int f = meet(d, &right, &down);
    double x = (right + 1) / 2 * cube->size - 0.5, y = (down + 1) / 2 * cube->size - 0.5, fx = x - floor(x), fy = y - floor(y);
    for (int i = 0; i < 4; i++) texel(cube, f, (int64_t)floor(x) + i % 2, (int64_t)floor(y) + i / 2, four[i]);
    for (int k = 0; k < 3; k++)
        sum[k] += (1 - fy) * ((1 - fx) * four[0][k] + fx * four[1][k]) + fy * ((1 - fx) * four[2][k] + fx * four[3][k]);
}

void ec_cube_unroll(const ec_cube *cube, uint32_t width, uint32_t height, uint32_t samples, float *rgb)
{
#pragma omp parallel for schedule(dynamic, 16)
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            double sum[3] = {0};
            for (uint32_t i = 0; i < samples * samples; i++) {
                double u = (x + (i % samples + 0.5) / samples) / width, v = (y + (i / samples + 0.5) / samples) / height;
                double phi = 2 * M_PI * (u - 0.5), theta = M_PI * v;
                double d[3] = {sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)};
                add_bilinear(cube, d, sum);
            }
            for (int k = 0; k < 3; k++) rgb[3 * ((size_t)y * width + x) + (size_t)k] = (float)(sum[k] / (samples * samples));
        }
}

static bool is_uniform(const ec_cube *cube)
{
    size_t values = 3 * (size_t)cube->size * cube->size;
    for (int f = 0; f < 6; f++)
        for (size_t i = 0; i < values; i++)
            if (cube->face[f][i] != cube->face[0][i % 3]) return false;
    return true;
}

static void turn(const double rotation[4], ec_environment *e)
{
    static const double nowhere[3] = {0}, as_is[3] = {1, 1, 1};
    double matrix[16];
    ec_gltf_compose(nowhere, rotation, as_is, matrix);
    for (int i = 0; i < 9; i++) {
        e->turn[i] = (float)matrix[4 * (i % 3) + i / 3];
        if (e->turn[i] != (i % 4 == 0)) e->turned = true;
    }
}

ec_result ec_cube_environment(const ec_cube *cube, const double rotation[4], ec_environment *e, ec_error *err)
{
    if (is_uniform(cube)) {
        memcpy(e->constant, cube->face[0], sizeof e->constant);
        return EC_OK;
    }
    uint32_t wanted = 4 * cube->size < 8 ? 8 : 4 * cube->size;
    e->width = wanted < WIDTH_MOST ? wanted : WIDTH_MOST;
    e->height = e->width / 2;
    e->rgb = malloc(3 * (size_t)e->width * e->height * sizeof *e->rgb);
    if (!e->rgb) return ec_fail(err, "out of memory for an environment of %u x %u pixels", e->width, e->height);
    ec_cube_unroll(cube, e->width, e->height, 2 * (wanted / e->width), e->rgb);
    turn(rotation, e);
    return EC_OK;
}
