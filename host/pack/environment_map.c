/* Builds the tables of the environment map. Between the centres of four texels lies a patch, over which interpolated radiance is bilinear: its
 * probability follows its light, luminance times solid angle. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "base/luminance.h"
#include "pack/distribution.h"
#include "pack/pack.h"

#define PI 3.14159265358979323846

/* Returns the sine of the polar angle, this many rows below the upper pole. */
static double sine_at(double rows, uint32_t height)
{
    return sin(PI * rows / height);
}

/* The patches between the texel centres of rows y - 1 and y; those of rows 0 and height reach from the pole to the first centre. of_upper and
 * of_lower are integrals of the sine times the distance from the opposite edge. The sine is taken as linear in between, as kernels/lib/environment.h
 * samples and divides by it; its error is at most 0.13 (pi / height)^2 of it. */
typedef struct patch_row {
    const float *upper, *lower;
    double of_upper, of_lower;
    uint32_t width;
} patch_row;

static patch_row patch_row_of(const ec_environment *e, uint32_t y)
{
    const size_t values = 3 * (size_t)e->width;
    const double part = y == 0 || y == e->height ? 0.5 : 1;
    const double above = y == 0 ? 0 : sine_at(y - 0.5, e->height), below = y == e->height ? 0 : sine_at(y + 0.5, e->height);
    return (patch_row){e->rgb + values * (y > 0 ? y - 1 : 0), e->rgb + values * (y < e->height ? y : y - 1),
                       part * (above / 3 + below / 6), part * (above / 6 + below / 3), e->width};
}

/* Returns the integral over patch x of the interpolated luminance times the sine, in texels. It is positive wherever the map is. */
static double patch_weight(const patch_row *row, uint32_t x)
{
    const size_t left = 3 * (size_t)x, right = x + 1 < row->width ? left + 3 : 0;
    return 0.5 * (row->of_upper * (ec_luminance_of_floats(row->upper + left) + ec_luminance_of_floats(row->upper + right)) +
                  row->of_lower * (ec_luminance_of_floats(row->lower + left) + ec_luminance_of_floats(row->lower + right)));
}

/* Computes the weights of a row, and returns their sum. */
static double weigh_row(const ec_environment *e, uint32_t y, double *weights)
{
    const patch_row row = patch_row_of(e, y);
    double sum = 0;
    for (uint32_t x = 0; x < e->width; x++) sum += weights[x] = patch_weight(&row, x);
    return sum;
}

/* Sums in order, for any number of threads, as rounding depends on the order. */
typedef struct map_sums {
    double solid, rgb[3]; /* over all texels */
    double weight;        /* over all patches */
} map_sums;

static map_sums sum_up(const ec_environment *e, const double *weights)
{
    map_sums sums = {0};
    for (uint32_t y = 0; y < e->height; y++) {
        const double sine = sine_at(y + 0.5, e->height);
        const float *rgb = e->rgb + 3 * (size_t)y * e->width;
        for (uint32_t x = 0; x < e->width; x++) {
            for (int k = 0; k < 3; k++) sums.rgb[k] += sine * rgb[3 * (size_t)x + (size_t)k];
            sums.solid += sine;
        }
    }
    const size_t patches = weights ? (size_t)e->width * (e->height + 1) : 0;
    for (size_t i = 0; i < patches; i++) sums.weight += weights[i];
    return sums;
}

/* Copies the row of texels above a row of patches. */
static void copy_row(const ec_environment *e, uint32_t y, float *texels)
{
    const float *rgb = e->rgb + 3 * (size_t)e->width * (y > 0 ? y - 1 : 0);
    for (uint32_t x = 0; x < e->width; x++) {
        memcpy(texels + 4 * (size_t)x, rgb + 3 * (size_t)x, 3 * sizeof *rgb);
        texels[4 * (size_t)x + 3] = 0.0f;
    }
}

/* Builds a row's table, and its patches' scales: probability over integral, per solid angle, infinite only where the map is almost black. weights
 * become probabilities. The table of a black row is undefined, as it is never looked at. */
static void distribute_row(const ec_environment *e, uint32_t y, double *weights, double row_pmf, ec_distribution_entry *table, float *texels)
{
    const double per_solid_angle = (double)e->width * e->height / (2 * PI * PI);
    const patch_row row = patch_row_of(e, y);
    memset(table, 0, e->width * sizeof *table);
    if (!(row_pmf > 0.0)) return;
    ec_distribution_build(weights, e->width, table, weights);
    for (uint32_t x = 0; x < e->width; x++)
        if (weights[x] > 0.0) texels[4 * (size_t)x + 3] = (float)fmin(row_pmf * weights[x] / patch_weight(&row, x) * per_solid_angle, FLT_MAX);
}

static void mean_of(const map_sums *sums, float mean[3])
{
    for (int k = 0; k < 3; k++) mean[k] = (float)(sums->rgb[k] / sums->solid);
}

void ec_environment_mean(const ec_environment *e, float mean[3])
{
    const map_sums sums = sum_up(e, NULL);
    mean_of(&sums, mean);
}

void ec_packed_map_free(ec_packed_map *map)
{
    free(map->texels);
    free(map->table);
    *map = (ec_packed_map){0};
}

/* weights: one for each patch; rows, row_pmf: one for each row of patches. */
static void fill_map(const ec_environment *e, double *weights, double *rows, double *row_pmf, ec_packed_map *map)
{
    const size_t width = e->width;
    const uint32_t row_count = e->height + 1;
    const bool parallel = width * row_count > 1u << 14;
#pragma omp parallel for schedule(dynamic, 16) if (parallel)
    for (uint32_t y = 0; y < row_count; y++) {
        rows[y] = weigh_row(e, y, weights + y * width);
        copy_row(e, y, map->texels + 4 * y * width);
    }
    const map_sums sums = sum_up(e, weights);
    mean_of(&sums, map->mean);
    map->mean_luminance = sums.weight / sums.solid;
    if (!(sums.weight > 0.0)) {
        free(map->table);
        map->table = NULL; /* black: looked up, but never sampled */
        return;
    }
    ec_distribution_build(rows, row_count, map->table, row_pmf);
#pragma omp parallel for schedule(dynamic, 16) if (parallel)
    for (uint32_t y = 0; y < row_count; y++)
        distribute_row(e, y, weights + y * width, row_pmf[y], map->table + row_count + y * width, map->texels + 4 * y * width);
}

ec_result ec_pack_map(const ec_environment *e, ec_packed_map *map, ec_error *err)
{
    *map = (ec_packed_map){.width = e->width, .height = e->height};
    const size_t row_count = (size_t)e->height + 1, count = e->width * row_count;
    if (count > 1u << 26)
        return ec_fail(err, "the environment map has %u x %u pixels; at most 2^26 are supported; shrink it", e->width, e->height);
    EC_FREED double *weights = malloc(count * sizeof *weights);
    EC_FREED double *rows = malloc(2 * row_count * sizeof *rows);
    map->texels = malloc(4 * count * sizeof(float));
    map->table = malloc((count + row_count) * sizeof *map->table);
    if (!weights || !rows || !map->texels || !map->table) {
        ec_packed_map_free(map);
        return ec_fail(err, "out of memory for an environment map of %u x %u", e->width, e->height);
    }
    fill_map(e, weights, rows, rows + row_count, map);
    return EC_OK;
}

ec_result ec_pack_environment(const ec_scene *scene, ec_pack *pack, double *mean_luminance, ec_error *err)
{
    const ec_environment *e = &scene->environment;
    ec_packed_map map;
    *mean_luminance = 0.0;
    if (!scene->has_environment) return EC_OK;
    for (int k = 0; k < 3; k++) pack->environment_mean[k] = e->constant[k];
    if (!e->rgb) {
        *mean_luminance = ec_luminance_of_floats(e->constant);
        return EC_OK;
    }
    pack->environment_lent = e->packed != NULL;
    if (e->packed) map = *e->packed;
    else EC_TRY(ec_pack_map(e, &map, err));
    pack->environment_texels = map.texels;
    pack->environment_table = map.table;
    pack->environment_width = map.width;
    pack->environment_height = map.height;
    memcpy(pack->environment_mean, map.mean, sizeof map.mean);
    *mean_luminance = map.mean_luminance;
    return EC_OK;
}
