/* The environment map's table: a texel is as likely as the light that bilinear look-up gives it, times its solid angle. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pack/distribution.h"
#include "pack/pack.h"

static double luminance(const float *rgb)
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/* Its texels' solid angle goes by it. */
static double sine_of_row(const ec_environment *e, uint32_t y)
{
    return sin(3.14159265358979323846 * (y + 0.5) / e->height);
}

/* Luminances of a texel and of those above and below it. */
typedef struct column {
    double at[3];
} column;

static column column_of(const ec_environment *e, uint32_t x, uint32_t y)
{
    const uint32_t above = y > 0 ? y - 1 : 0, below = y + 1 < e->height ? y + 1 : y;
    return (column){{luminance(e->rgb + 3 * ((size_t)above * e->width + x)), luminance(e->rgb + 3 * ((size_t)y * e->width + x)),
                     luminance(e->rgb + 3 * ((size_t)below * e->width + x))}};
}

/* Means of the bilinear interpolant over the texels of a row, [1 6 1] / 8 along each axis, times the row's sine. Positive wherever the
 * map is. */
static void weigh_row(const ec_environment *e, uint32_t y, double *weights)
{
    static const double weight[3] = {0.125, 0.75, 0.125};
    const double sine = sine_of_row(e, y);
    column c[3] = {column_of(e, e->width - 1, y), column_of(e, 0, y)};
    for (uint32_t x = 0; x < e->width; x++) {
        double sum = 0.0;
        c[2] = column_of(e, x + 1 < e->width ? x + 1 : 0, y);
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++) sum += weight[i] * weight[j] * c[i].at[j];
        weights[x] = sum * sine;
        c[0] = c[1];
        c[1] = c[2];
    }
}

/* Over all texels. One after the other, whatever the number of threads: a sum's bits go by its order. */
typedef struct map_sums {
    double weight, solid, rgb[3];
} map_sums;

static map_sums sum_up(const ec_environment *e, const double *weights)
{
    map_sums sums = {0};
    for (uint32_t y = 0; y < e->height; y++) {
        const double sine = sine_of_row(e, y);
        const float *rgb = e->rgb + 3 * (size_t)y * e->width;
        const double *weight = weights ? weights + (size_t)y * e->width : NULL;
        for (uint32_t x = 0; x < e->width; x++) {
            for (int k = 0; k < 3; k++) sums.rgb[k] += sine * rgb[3 * (size_t)x + (size_t)k];
            if (weight) sums.weight += weight[x];
            sums.solid += sine;
        }
    }
    return sums;
}

/* Texels and weights of a row; dim texels keep a twentieth of their share by solid angle, so that a hot one cannot starve them. The row's
 * weight. */
static double finish_row(const ec_environment *e, uint32_t y, const map_sums *sums, double *weights, float *texels)
{
    const double sine = sine_of_row(e, y);
    const float *rgb = e->rgb + 3 * (size_t)y * e->width;
    double all = 0.0;
    for (uint32_t x = 0; x < e->width; x++) {
        memcpy(texels + 4 * (size_t)x, rgb + 3 * (size_t)x, 3 * sizeof *rgb);
        texels[4 * (size_t)x + 3] = 0.0f;
        if (weights[x] > 0.0) weights[x] = 0.95 * weights[x] / sums->weight + 0.05 * sine / sums->solid;
        all += weights[x];
    }
    return all;
}

/* A row's own table; weights become probabilities. Of a black row it says nothing: nobody looks there. */
static void distribute_row(uint32_t width, double *weights, double row_weight, double row_pmf,
                           ec_distribution_entry *table, float *texels)
{
    memset(table, 0, width * sizeof *table);
    if (!(row_weight > 0.0)) return;
    ec_distribution_build(weights, width, table, weights);
    for (uint32_t x = 0; x < width; x++) texels[4 * (size_t)x + 3] = (float)(row_pmf * weights[x]);
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

/* weights: as many as texels; rows, row_pmf: a row each. */
static void fill_map(const ec_environment *e, double *weights, double *rows, double *row_pmf, ec_packed_map *map)
{
    const size_t width = e->width;
    const bool parallel = width * e->height > 1u << 14;
#pragma omp parallel for schedule(dynamic, 16) if (parallel)
    for (uint32_t y = 0; y < e->height; y++) weigh_row(e, y, weights + y * width);
    const map_sums sums = sum_up(e, weights);
    mean_of(&sums, map->mean);
    map->mean_luminance = sums.weight / sums.solid;
#pragma omp parallel for schedule(dynamic, 16) if (parallel)
    for (uint32_t y = 0; y < e->height; y++) rows[y] = finish_row(e, y, &sums, weights + y * width, map->texels + 4 * y * width);
    if (!(sums.weight > 0.0)) {
        free(map->table);
        map->table = NULL; /* black: looked up, never sampled */
        return;
    }
    ec_distribution_build(rows, e->height, map->table, row_pmf);
#pragma omp parallel for schedule(dynamic, 16) if (parallel)
    for (uint32_t y = 0; y < e->height; y++)
        distribute_row(e->width, weights + y * width, rows[y], row_pmf[y], map->table + e->height + y * width,
                       map->texels + 4 * y * width);
}

ec_result ec_pack_map(const ec_environment *e, ec_packed_map *map, ec_error *err)
{
    *map = (ec_packed_map){.width = e->width, .height = e->height};
    size_t count = (size_t)e->width * e->height;
    if (count >= 1u << 26)
        return ec_fail(err, "the environment map has %u x %u pixels; at most 2^26 are handled: shrink it", e->width, e->height);
    double *weights = malloc(count * sizeof *weights), *rows = malloc(2 * (size_t)e->height * sizeof *rows);
    map->texels = malloc(4 * count * sizeof(float));
    map->table = malloc((count + e->height) * sizeof *map->table);
    ec_result result = EC_OK;
    if (weights && rows && map->texels && map->table) fill_map(e, weights, rows, rows + e->height, map);
    else result = ec_fail(err, "out of memory for an environment map of %u x %u", e->width, e->height);
    free(weights);
    free(rows);
    if (result != EC_OK) ec_packed_map_free(map);
    return result;
}

ec_result ec_pack_environment(const ec_scene *scene, ec_pack *pack, double *mean_luminance, ec_error *err)
{
    const ec_environment *e = &scene->environment;
    ec_packed_map map;
    *mean_luminance = 0.0;
    if (!scene->has_environment) return EC_OK;
    for (int k = 0; k < 3; k++) pack->environment_mean[k] = e->constant[k];
    if (!e->rgb) {
        *mean_luminance = luminance(e->constant);
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
