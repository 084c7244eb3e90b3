#include "cli/write_outputs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { AOV_STRIDE = 8, AOV_ALBEDO = 0, AOV_NORMAL = 3, AOV_DEPTH = 6, AOV_ALPHA = 7 };

ec_result ec_picture_resolve(const ec_film *film, ec_picture *picture, ec_error *err)
{
    size_t pixel_count = (size_t)film->width * film->height;
    picture->width = film->width;
    picture->height = film->height;
    picture->aov = film->aov;
    picture->rgb = malloc(pixel_count * 3 * sizeof(float));
    picture->stderr_rgb = malloc(pixel_count * 3 * sizeof(float));
    picture->constants = malloc(pixel_count * 2 * sizeof(float));
    if (!picture->rgb || !picture->stderr_rgb || !picture->constants)
        return ec_fail(err, "out of memory for a picture of %ux%u pixels; try a smaller --size", film->width, film->height);
    ec_film_resolve(film, picture->rgb, picture->stderr_rgb);
    float samples = (float)((double)film->batch_count * film->samples_per_batch);
    for (size_t i = 0; i < pixel_count; i++) {
        picture->constants[2 * i] = film->unsampled && film->unsampled[i] ? 0.0f : samples;
        picture->constants[2 * i + 1] = 1;
    }
    return EC_OK;
}

void ec_picture_free(ec_picture *picture)
{
    free(picture->rgb);
    free(picture->stderr_rgb);
    free(picture->constants);
    *picture = (ec_picture){0};
}

/* Up to 15 channels; without first-hit features only the first eight. */
static uint32_t list_channels(const ec_picture *picture, ec_channel channels[15])
{
    const float *rgb = picture->rgb, *error = picture->stderr_rgb, *aov = picture->aov;
    const ec_channel always[] = {
        {"R", rgb, 3},
        {"G", rgb + 1, 3},
        {"B", rgb + 2, 3},
        {"stderr.R", error, 3},
        {"stderr.G", error + 1, 3},
        {"stderr.B", error + 2, 3},
        {"samples", picture->constants, 2},
        {"A", picture->constants + 1, 2},
    };
    memcpy(channels, always, sizeof always);
    if (!aov) return 8;
    const ec_channel first_hit[] = {
        {"A", aov + AOV_ALPHA, AOV_STRIDE},
        {"albedo.R", aov + AOV_ALBEDO, AOV_STRIDE},
        {"albedo.G", aov + AOV_ALBEDO + 1, AOV_STRIDE},
        {"albedo.B", aov + AOV_ALBEDO + 2, AOV_STRIDE},
        {"normal.X", aov + AOV_NORMAL, AOV_STRIDE},
        {"normal.Y", aov + AOV_NORMAL + 1, AOV_STRIDE},
        {"normal.Z", aov + AOV_NORMAL + 2, AOV_STRIDE},
        {"depth.Z", aov + AOV_DEPTH, AOV_STRIDE},
    };
    memcpy(channels + 7, first_hit, sizeof first_hit);
    return 15;
}

static ec_result write_exr(const char *path, const ec_picture *picture, const ec_picture_style *style, ec_error *err)
{
    ec_channel channels[15];
    uint32_t count = list_channels(picture, channels);
    return ec_exr_write(path, picture->width, picture->height, channels, count, style->attributes,
                        style->attribute_count, err);
}

static ec_result write_png(const char *path, const ec_picture *picture, const ec_picture_style *style, ec_error *err)
{
    size_t pixel_count = (size_t)picture->width * picture->height;
    uint8_t *bytes = malloc(pixel_count * 3);
    if (!bytes) return ec_fail(err, "out of memory for '%s'", path);
    ec_tonemap_rgb(picture->rgb, bytes, pixel_count, style->exposure, style->tonemap);
    ec_result result = ec_png_write(path, picture->width, picture->height, bytes, err);
    free(bytes);
    return result;
}

ec_result ec_outputs_write(ec_outputs *outputs, const ec_picture *picture, const ec_picture_style *style, ec_error *err)
{
    ec_result result = EC_OK;
    for (int i = 0; i < outputs->count; i++) {
        ec_output *output = &outputs->file[i];
        ec_error *first = result == EC_OK ? err : NULL; /* the first failure is told */
        ec_result written = output->kind == EC_OUTPUT_PNG ? write_png(output->path, picture, style, first)
                                                          : write_exr(output->path, picture, style, first);
        if (written != EC_OK) {
            result = written;
            continue;
        }
        char absolute[PATH_MAX];
        if (realpath(output->path, absolute)) snprintf(output->path, sizeof output->path, "%s", absolute);
    }
    return result;
}
