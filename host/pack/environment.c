/* The environment map's table: a texel is as likely as the light that bilinear look-up gives it, times its solid angle. */
#include <math.h>
#include <stdlib.h>

#include "pack/alias.h"
#include "pack/pack.h"

static double luminance(const float *rgb)
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
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

ec_result ec_pack_environment(const ec_scene *scene, ec_pack *pack, double *mean_luminance, ec_error *err)
{
    const ec_environment *e = &scene->environment;
    *mean_luminance = 0.0;
    if (!scene->has_environment) return EC_OK;
    for (int k = 0; k < 3; k++) pack->environment_mean[k] = e->constant[k];
    if (!e->rgb) {
        *mean_luminance = luminance(e->constant);
        return EC_OK;
    }
    size_t count = (size_t)e->width * e->height;
    if (count >= 1u << 26)
        return ec_fail(err, "the environment map has %u x %u pixels; at most 2^26 are handled: shrink it", e->width, e->height);
    double *weights = malloc(count * sizeof *weights), *pmf = malloc(count * sizeof *pmf);
    pack->environment_texels = malloc(4 * count * sizeof(float));
    pack->environment_alias = malloc(count * sizeof *pack->environment_alias);
    ec_result result = EC_OK;
    if (!weights || !pmf || !pack->environment_texels || !pack->environment_alias) {
        result = ec_fail(err, "out of memory for an environment map of %u x %u", e->width, e->height);
        goto cleanup;
    }
    double sum = 0.0, solid = 0.0, mean[3] = {0.0};
    for (uint32_t y = 0; y < e->height; y++) {
        double sine = sin(3.14159265358979323846 * (y + 0.5) / e->height);
        for (uint32_t x = 0; x < e->width; x++) {
            double w = texel_mean(e, x, y) * sine;
            weights[(size_t)y * e->width + x] = w;
            for (int k = 0; k < 3; k++) mean[k] += sine * e->rgb[3 * ((size_t)y * e->width + x) + k];
            sum += w;
            solid += sine;
        }
    }
    for (int k = 0; k < 3; k++) pack->environment_mean[k] = (float)(mean[k] / solid);
    if (!(sum > 0.0)) {
        free(pack->environment_alias);
        pack->environment_alias = NULL; /* black: looked up, never sampled */
    } else {
        *mean_luminance = sum / solid;
        /* Dim texels keep a twentieth of their share by solid angle, so that a hot one cannot starve them. */
        for (size_t i = 0; i < count; i++) {
            double sine = sin(3.14159265358979323846 * ((double)(i / e->width) + 0.5) / e->height);
            if (weights[i] > 0.0) weights[i] = 0.95 * weights[i] / sum + 0.05 * sine / solid;
        }
        result = ec_alias_build(weights, (uint32_t)count, pack->environment_alias, pmf, err);
    }
    if (result == EC_OK) {
        for (size_t i = 0; i < count; i++) {
            for (int k = 0; k < 3; k++) pack->environment_texels[4 * i + k] = e->rgb[3 * i + k];
            pack->environment_texels[4 * i + 3] = sum > 0.0 ? (float)pmf[i] : 0.0f;
        }
        pack->environment_width = e->width;
        pack->environment_height = e->height;
    }
cleanup:
    free(weights);
    free(pmf);
    return result;
}
