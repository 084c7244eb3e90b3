#include "cli/write_outputs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/frame_job.h"
#include "film/interval.h"

enum { AOV_STRIDE = 8, AOV_ALBEDO = 0, AOV_NORMAL = 3, AOV_DEPTH = 6, AOV_ALPHA = 7 };

static ec_result resolve_error(const ec_film *film, ec_picture *picture)
{
    size_t pixel_count = (size_t)film->width * film->height;
    picture->stderr_rgb = malloc(pixel_count * 3 * sizeof(float));
    picture->stderr_y = malloc(pixel_count * sizeof(float));
    picture->low = malloc(pixel_count * 3 * sizeof(float));
    picture->high = malloc(pixel_count * 3 * sizeof(float));
    picture->heavy = malloc(pixel_count * sizeof(float));
    if (!picture->stderr_rgb || !picture->stderr_y || !picture->low || !picture->high || !picture->heavy) return EC_FAILED;
    ec_film_resolve(film, NULL, picture->stderr_rgb);
    ec_film_resolve_luminance_error(film, picture->stderr_y);
    picture->heavy_count = ec_film_intervals(film, picture->low, picture->high, picture->heavy);
    return EC_OK;
}

ec_result ec_picture_resolve(const ec_film *film, bool with_error, ec_picture *picture, ec_error *err)
{
    size_t pixel_count = (size_t)film->width * film->height;
    picture->width = film->width;
    picture->height = film->height;
    picture->aov = film->aov;
    picture->rgb = malloc(pixel_count * 3 * sizeof(float));
    picture->constants = malloc(pixel_count * 2 * sizeof(float));
    if (!picture->rgb || !picture->constants || (with_error && film->batch_count >= 2 && resolve_error(film, picture) != EC_OK))
        return ec_fail(err, "out of memory for a picture of %ux%u pixels; try a smaller --size", film->width, film->height);
    ec_film_resolve(film, picture->rgb, NULL);
    for (size_t i = 0; i < pixel_count; i++) {
        float samples = (float)((double)ec_film_batches(film, i) * film->samples_per_batch);
        picture->constants[2 * i] = film->unsampled && film->unsampled[i] ? 0.0f : samples;
        picture->constants[2 * i + 1] = 1;
    }
    return EC_OK;
}

void ec_picture_free(ec_picture *picture)
{
    free(picture->rgb);
    free(picture->stderr_rgb);
    free(picture->stderr_y);
    free(picture->low);
    free(picture->high);
    free(picture->heavy);
    free(picture->constants);
    *picture = (ec_picture){0};
}

enum { CHANNELS_MAX = 26 };

typedef struct channel_list {
    ec_channel list[CHANNELS_MAX];
    uint32_t count;
} channel_list;

static void add_channels(channel_list *channels, const float *data, uint32_t stride, uint32_t count, const char *const *names)
{
    for (uint32_t i = 0; i < count; i++) channels->list[channels->count++] = (ec_channel){.name = names[i], .data = data + i, .stride = stride};
}

/* Layers by name, so that every viewer groups them. No error and no first hit: no such channels. */
static void list_channels(const ec_picture *picture, channel_list *channels)
{
    static const char *const colour[] = {"R", "G", "B"}, *const error[] = {"stderr.R", "stderr.G", "stderr.B"},
                             *const low[] = {"low95.R", "low95.G", "low95.B"}, *const high[] = {"high95.R", "high95.G", "high95.B"},
                             *const error_y[] = {"stderr.Y"}, *const heavy[] = {"heavy"}, *const samples[] = {"samples"},
                             *const alpha[] = {"A"}, *const albedo[] = {"albedo.R", "albedo.G", "albedo.B"},
                             *const normal[] = {"normal.X", "normal.Y", "normal.Z"}, *const depth[] = {"depth.Z"};
    add_channels(channels, picture->rgb, 3, 3, colour);
    add_channels(channels, picture->constants, 2, 1, samples);
    if (picture->stderr_rgb) {
        add_channels(channels, picture->stderr_rgb, 3, 3, error);
        add_channels(channels, picture->stderr_y, 1, 1, error_y);
        add_channels(channels, picture->low, 3, 3, low);
        add_channels(channels, picture->high, 3, 3, high);
        add_channels(channels, picture->heavy, 1, 1, heavy);
    }
    const float *aov = picture->aov;
    if (!aov) {
        add_channels(channels, picture->constants + 1, 2, 1, alpha);
        return;
    }
    add_channels(channels, aov + AOV_ALPHA, AOV_STRIDE, 1, alpha);
    add_channels(channels, aov + AOV_ALBEDO, AOV_STRIDE, 3, albedo);
    add_channels(channels, aov + AOV_NORMAL, AOV_STRIDE, 3, normal);
    add_channels(channels, aov + AOV_DEPTH, AOV_STRIDE, 1, depth);
}

ec_result ec_picture_write_exr(const char *path, const ec_picture *picture, const ec_picture_style *style, ec_error *err)
{
    channel_list channels = {.count = 0};
    list_channels(picture, &channels);
    const ec_exr_part part = {.channels = channels.list, .channel_count = channels.count, .attributes = style->attributes,
                              .attribute_count = style->attribute_count};
    if (style->job) return ec_store_write(path, style->job, style->film, style->past, &part, err);
    return ec_exr_write(path, picture->width, picture->height, channels.list, channels.count, style->attributes,
                        style->attribute_count, err);
}

static ec_result write_png(const char *path, const ec_picture *picture, const ec_picture_style *style, ec_error *err)
{
    size_t pixel_count = (size_t)picture->width * picture->height;
    uint8_t *bytes = malloc(pixel_count * 3);
    if (!bytes) return ec_fail(err, "out of memory for '%s'", path);
    ec_tonemap_rgb(picture->rgb, bytes, pixel_count, style->exposure, style->tonemap);
    ec_result result = ec_png_write_text(path, picture->width, picture->height, bytes, EC_FRAME_ATTRIBUTE, style->frame_job, err);
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
                                                          : ec_picture_write_exr(output->path, picture, style, first);
        if (written != EC_OK) {
            result = written;
            continue;
        }
        char absolute[PATH_MAX];
        if (realpath(output->path, absolute)) snprintf(output->path, sizeof output->path, "%s", absolute);
    }
    return result;
}
