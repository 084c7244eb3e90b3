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

/* Mean of the bilinear interpolant over a texel: [1 6 1] / 8 along each axis. Positive wherever the map is. */
static double texel_mean(const ec_environment *e, uint32_t x, uint32_t y)
{
    static const double weight[3] = {0.125, 0.75, 0.125};
    double sum = 0.0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            uint32_t xi = (x + e->width + (uint32_t)i) % e->width;
            int64_t yj = (int64_t)y + j;
            yj = yj < 0 ? 0 : (yj >= e->height ? e->height - 1 : yj);
            sum += weight[i + 1] * weight[j + 1] * luminance(e->rgb + 3 * ((size_t)yj * e->width + xi));
        }
    return sum;
}

/* Dim texels keep a twentieth of their share by solid angle, so that a hot one cannot starve them. */
static ec_result build_table(const ec_environment *e, double *weights, double sum, double solid, ec_packed_map *map, ec_error *err)
{
    const uint32_t width = e->width, height = e->height;
    double *rows = calloc(height, sizeof *rows), *row_pmf = malloc(height * sizeof *row_pmf), *pmf = malloc(width * sizeof *pmf);
    ec_distribution_entry *table = map->table;
    bool has_memory = rows && row_pmf && pmf;
    for (size_t i = 0; has_memory && i < (size_t)width * height; i++) {
        double sine = sine_of_row(e, (uint32_t)(i / width));
        if (weights[i] > 0.0) weights[i] = 0.95 * weights[i] / sum + 0.05 * sine / solid;
        rows[i / width] += weights[i];
    }
    if (has_memory) ec_distribution_build(rows, height, table, row_pmf);
    for (uint32_t y = 0; has_memory && y < height; y++) {
        ec_distribution_entry *row = table + height + (size_t)y * width;
        memset(row, 0, width * sizeof *row); /* of a black row; nobody looks there */
        if (!(rows[y] > 0.0)) continue;
        ec_distribution_build(weights + (size_t)y * width, width, row, pmf);
        for (uint32_t x = 0; x < width; x++) map->texels[4 * ((size_t)y * width + x) + 3] = (float)(row_pmf[y] * pmf[x]);
    }
    free(rows);
    free(row_pmf);
    free(pmf);
    return has_memory ? EC_OK : ec_fail(err, "out of memory for an environment map of %u x %u", width, height);
}

void ec_environment_mean(const ec_environment *e, float mean[3])
{
    double sum[3] = {0.0}, solid = 0.0;
    for (size_t i = 0; i < (size_t)e->width * e->height; i++) {
        double sine = sine_of_row(e, (uint32_t)(i / e->width));
        for (int k = 0; k < 3; k++) sum[k] += sine * e->rgb[3 * i + k];
        solid += sine;
    }
    for (int k = 0; k < 3; k++) mean[k] = (float)(sum[k] / solid);
}

void ec_packed_map_free(ec_packed_map *map)
{
    free(map->texels);
    free(map->table);
    *map = (ec_packed_map){0};
}

ec_result ec_pack_map(const ec_environment *e, ec_packed_map *map, ec_error *err)
{
    *map = (ec_packed_map){.width = e->width, .height = e->height};
    size_t count = (size_t)e->width * e->height;
    if (count >= 1u << 26)
        return ec_fail(err, "the environment map has %u x %u pixels; at most 2^26 are handled: shrink it", e->width, e->height);
    double *weights = malloc(count * sizeof *weights);
    map->texels = malloc(4 * count * sizeof(float));
    map->table = malloc((count + e->height) * sizeof *map->table);
    ec_result result = EC_OK;
    if (!weights || !map->texels || !map->table) {
        result = ec_fail(err, "out of memory for an environment map of %u x %u", e->width, e->height);
        goto cleanup;
    }
    double sum = 0.0, solid = 0.0;
    for (uint32_t y = 0; y < e->height; y++) {
        double sine = sine_of_row(e, y);
        for (uint32_t x = 0; x < e->width; x++) {
            size_t i = (size_t)y * e->width + x;
            weights[i] = texel_mean(e, x, y) * sine;
            for (int k = 0; k < 3; k++) map->texels[4 * i + k] = e->rgb[3 * i + k];
            map->texels[4 * i + 3] = 0.0f;
            sum += weights[i];
            solid += sine;
        }
    }
    ec_environment_mean(e, map->mean);
    if (sum > 0.0) {
        map->mean_luminance = sum / solid;
        result = build_table(e, weights, sum, solid, map, err);
    } else {
        free(map->table);
        map->table = NULL; /* black: looked up, never sampled */
    }
cleanup:
    free(weights);
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
