#include "jobs/write_outputs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"

ec_result ec_picture_create(ec_picture *picture, const ec_film *film, uint32_t rows, bool with_error, bool with_intervals, bool with_cut, ec_error *err)
{
    const uint32_t width = film->width;
    const ec_layers *layers = &film->layers;
    const size_t pixel_count = (size_t)width * rows;
    *picture = (ec_picture){.width = width, .height = rows, .layers = *layers};
    float **const planes[] = {&picture->rgb,   &picture->constants, &picture->stderr_rgb, &picture->stderr_y,
                              &picture->heavy, &picture->low,       &picture->high};
    static const size_t values[] = {3, 2, 3, 1, 1, 3, 3};
    bool made = (picture->room = malloc(ec_resolve_room(width, rows) * sizeof *picture->room)) != NULL;
    const int count = with_error && with_intervals ? 7 : with_error ? 5 : 2;
    for (int i = 0; made && i < count; i++) made = (*planes[i] = malloc(pixel_count * values[i] * sizeof(float))) != NULL;
    if (made && with_cut) made = (picture->clamped = malloc(pixel_count * 2 * sizeof(float))) != NULL;
    if (made && ec_film_feature_samples(film) > 0 && !ec_film_features_at(film, 0))
        made = (picture->features = malloc(pixel_count * EC_FILM_FEATURES * sizeof(float))) != NULL;
    if (made && layers->count) made = (picture->layer_values = malloc(pixel_count * EC_LAYER_PLANES * layers->count * sizeof(float))) != NULL;
    for (uint32_t k = 0; k < EC_MATTE_KINDS; k++)
        if (made && layers->mattes >> k & 1) made = (picture->mattes[k] = malloc(pixel_count * EC_MATTE_FLOATS * sizeof(float))) != NULL;
    if (made) return EC_OK;
    ec_picture_free(picture);
    return ec_fail(err, "out of memory for a picture of %ux%u pixels; try a smaller --size", width, rows);
}

static void fill_mattes(ec_picture *picture, const ec_film *film, uint64_t first)
{
    for (uint64_t i = 0; i < (uint64_t)film->width * picture->height; i++)
        for (uint32_t k = 0; k < EC_MATTE_KINDS; k++)
            if (picture->mattes[k])
                ec_matte_pixel(&film->matte, &film->layers, k, first + i, ec_film_samples(film, first + i), picture->mattes[k] + EC_MATTE_FLOATS * i);
}

void ec_picture_turn_to(ec_picture *picture, const ec_film *film, uint32_t first)
{
    const uint64_t before = (uint64_t)first * film->width;
    picture->aov = picture->features ? picture->features : ec_film_features_at(film, before);
    picture->clean = ec_film_clean_from(&film->clean, before);
}

void ec_picture_fill(ec_picture *picture, const ec_film *film, uint32_t first, uint32_t rows)
{
    const size_t pixel_count = (size_t)film->width * rows;
    const ec_planes planes = {.rgb = picture->rgb, .stderr_rgb = picture->stderr_rgb, .stderr_y = picture->stderr_y,
                              .samples = picture->constants, .samples_stride = 2, .clamped = picture->clamped,
                              .intervals = {picture->low, picture->high, picture->heavy}};
    picture->height = rows;
    if (picture->features) ec_film_features_of(film, EC_BOTH_HALVES, (uint64_t)first * film->width, pixel_count, picture->features);
    ec_picture_turn_to(picture, film, first);
    picture->heavy_count = ec_film_resolve_rows(film, first, rows, &planes, picture->room);
    if (picture->layer_values) ec_film_resolve_layers(film, first, rows, picture->rgb, picture->layer_values);
    if (film->layers.mattes) fill_mattes(picture, film, (uint64_t)first * film->width);
    for (size_t i = 0; i < pixel_count; i++) picture->constants[2 * i + 1] = 1;
}

ec_picture ec_picture_rows(const ec_picture *picture, uint32_t first, uint32_t rows)
{
    const size_t before = (size_t)first * picture->width;
    ec_picture here = {.width = picture->width, .height = rows, .rgb = picture->rgb + 3 * before, .constants = picture->constants + 2 * before,
                       .features = picture->features ? picture->features + EC_FILM_FEATURES * before : NULL};
    here.clean = ec_film_clean_from(&picture->clean, before);
    here.layers = picture->layers;
    if (picture->layer_values) here.layer_values = picture->layer_values + EC_LAYER_PLANES * picture->layers.count * before;
    for (uint32_t k = 0; k < EC_MATTE_KINDS; k++)
        if (picture->mattes[k]) here.mattes[k] = picture->mattes[k] + EC_MATTE_FLOATS * before;
    if (picture->clamped) here.clamped = picture->clamped + 2 * before;
    if (!picture->heavy) return here;
    here.stderr_rgb = picture->stderr_rgb + 3 * before;
    here.stderr_y = picture->stderr_y + before;
    here.low = picture->low ? picture->low + 3 * before : NULL;
    here.high = picture->high ? picture->high + 3 * before : NULL;
    here.heavy = picture->heavy + before;
    return here;
}

ec_result ec_picture_resolve(const ec_film *film, bool with_error, ec_picture *picture, ec_error *err)
{
    EC_TRY(ec_picture_create(picture, film, film->height, with_error && ec_film_replicates(film) >= 2, true, with_error && film->limit > 0, err));
    ec_picture_fill(picture, film, 0, film->height);
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
    free(picture->clamped);
    free(picture->features);
    free(picture->layer_values);
    for (uint32_t k = 0; k < EC_MATTE_KINDS; k++) free(picture->mattes[k]);
    free(picture->room);
    *picture = (ec_picture){0};
}

/* Returns a plane's floats, *stride per pixel; NULL: the picture has none. */
static const float *plane_of(const ec_picture *p, ec_plane plane, uint32_t *stride)
{
    if (plane >= EC_PLANE_LAYER) {
        const uint32_t layer = ec_layers_find(&p->layers, plane - EC_PLANE_LAYER);
        *stride = EC_LAYER_PLANES * p->layers.count;
        return layer && p->layer_values ? p->layer_values + EC_LAYER_PLANES * (layer - 1) : NULL;
    }
    if (plane >= EC_PLANE_MATTE && plane <= EC_PLANE_MATTE_END) {
        *stride = EC_MATTE_FLOATS;
        return p->mattes[plane - EC_PLANE_MATTE];
    }
    const struct { const float *data; uint32_t stride; } planes[] = {
        [EC_PLANE_RGB] = {p->rgb, 3},       [EC_PLANE_SAMPLES] = {p->constants, 2}, [EC_PLANE_STDERR] = {p->stderr_rgb, 3},
        [EC_PLANE_STDERR_Y] = {p->stderr_y, 1}, [EC_PLANE_LOW] = {p->low, 3},       [EC_PLANE_HIGH] = {p->high, 3},
        [EC_PLANE_HEAVY] = {p->heavy, 1},   [EC_PLANE_CLAMPED] = {p->clamped, 2},   [EC_PLANE_FEATURES] = {p->aov, EC_FILM_FEATURES},
        [EC_PLANE_DENOISED] = {p->clean.denoised, 3}, [EC_PLANE_BEST] = {p->clean.best, 3}, [EC_PLANE_DENOISED_STDERR] = {p->clean.error, 1},
    };
    *stride = planes[plane].stride;
    return planes[plane].data;
}

static void add_channel(ec_channel_list *channels, const ec_channel_row *row, const char *name, const float *data, uint32_t stride)
{
    channels->rows[channels->count] = row;
    channels->list[channels->count++] = (ec_channel){.name = name, .data = data, .stride = stride};
}

static void add_groups(const ec_picture *picture, ec_channel_list *channels)
{
    const ec_layers *layers = &picture->layers;
    const uint32_t stride = EC_LAYER_PLANES * layers->count, first = layers->count - layers->group_count;
    for (uint32_t g = 0; picture->layer_values && g < layers->group_count; g++)
        for (uint32_t i = 0; i < EC_GROUP_ROWS; i++) {
            const ec_channel_row *row = &ec_group_rows[i];
            char *name = channels->names[g][i];
            snprintf(name, sizeof channels->names[g][i], "light.%s.%s", layers->groups[g], row->name);
            add_channel(channels, row, name, picture->layer_values + EC_LAYER_PLANES * (first + g) + row->place, stride);
        }
}

static void add_matte(const ec_channel_row *row, ec_channel_list *channels, const float *data)
{
    for (uint32_t i = 0; i < EC_MATTE_FLOATS; i++) {
        char *name = channels->matte_names[row->plane - EC_PLANE_MATTE][i];
        snprintf(name, EC_MATTE_NAME, "%s%02u.%c", row->name, i / 4, "RGBA"[i % 4]);
        add_channel(channels, row, name, data + i, EC_MATTE_FLOATS);
    }
}

void ec_picture_channels(const ec_picture *picture, ec_channel_list *channels)
{
    channels->count = 0;
    for (uint32_t i = 0; i < EC_CHANNEL_ROWS; i++) {
        const ec_channel_row *row = &ec_channel_rows[i];
        const bool is_constant = row->plane == EC_PLANE_FEATURES && row->place == EC_FILM_ALPHA && !picture->aov;
        uint32_t stride;
        const float *data = plane_of(picture, is_constant ? EC_PLANE_SAMPLES : row->plane, &stride);
        if (data && ec_channel_is_matte(row)) add_matte(row, channels, data);
        else if (data) add_channel(channels, row, row->name, data + (is_constant ? 1 : row->place), stride);
    }
    add_groups(picture, channels);
}

/* Tells whether a channel is wanted; those of light groups always are. */
static bool is_in(ec_channel_set set, const ec_channel_row *row)
{
    return row->plane == ec_group_rows[0].plane || set >> (row - ec_channel_rows) & 1;
}

void ec_channels_choose(ec_channel_list *channels, ec_channel_set set, bool wide_errors)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < channels->count; i++) {
        const ec_channel_row *row = channels->rows[i];
        const bool is_error = row->plane == EC_PLANE_STDERR || row->plane == EC_PLANE_STDERR_Y || (row->plane >= EC_PLANE_LAYER && row->place >= 3);
        if (!is_in(set, row)) continue;
        channels->rows[count] = row;
        channels->list[count] = channels->list[i];
        channels->list[count++].type = is_error && wide_errors ? EC_CHANNEL_FLOAT : row->type;
    }
    channels->count = count;
}

ec_result ec_picture_write_exr(const char *path, const ec_picture *picture, const ec_picture_style *style, ec_error *err)
{
    ec_channel_list channels;
    ec_picture_channels(picture, &channels);
    const ec_exr_part part = {.channels = channels.list, .channel_count = channels.count, .attributes = style->attributes,
                              .attribute_count = style->attribute_count};
    if (style->job) return ec_store_write(path, style->job, style->film, style->past, &part, err);
    return ec_exr_write(path, picture->width, picture->height, channels.list, channels.count, style->attributes,
                        style->attribute_count, err);
}

ec_raster ec_picture_raster(const ec_format *format, const ec_picture_style *style, uint32_t width, uint32_t height)
{
    const bool has_alpha = format->has_alpha && style->screen.background.kind == EC_BACKDROP_TRANSPARENT;
    return (ec_raster){width, height, has_alpha ? 4 : 3, format->is_linear ? 32 : format->has_16_bits && style->deep ? 16 : 8};
}

void ec_picture_pixels(const ec_picture *p, const ec_picture_style *style, const ec_raster *to, void *out)
{
    const uint64_t count = (uint64_t)p->width * p->height;
    const float *rgb = p->clean.best ? p->clean.best : p->rgb;
    const float *alpha = p->aov ? p->aov + EC_FILM_ALPHA : p->constants + 1; /* 1 if there are no first hits */
    if (to->bits == 32) memcpy(out, rgb, 3 * sizeof *rgb * count);
    else ec_screen_pixels(&style->screen, rgb, alpha, p->aov ? EC_FILM_FEATURES : 2, (uint64_t)p->first * p->width, count, to, out);
}

static ec_result write_pixels(const char *path, const ec_format *format, const ec_picture *picture, const ec_picture_style *style, ec_error *err)
{
    const ec_raster raster = ec_picture_raster(format, style, picture->width, picture->height);
    EC_FREED void *pixels = malloc((size_t)picture->width * picture->height * ec_raster_pixel_bytes(&raster));
    void *rows;
    if (!pixels) return ec_fail(err, "out of memory for '%s'", path);
    ec_picture_pixels(picture, style, &raster, pixels);
    EC_TRY(format->begin(&rows, path, &raster, NULL, err));
    if (format->put(rows, pixels, picture->height, err) == EC_OK) return format->end(rows, err);
    format->abort(rows);
    return EC_FAILED;
}

void ec_output_settle(ec_output *output)
{
    char absolute[PATH_MAX];
    if (realpath(output->path, absolute)) snprintf(output->path, sizeof output->path, "%s", absolute);
}

ec_result ec_outputs_write(ec_outputs *outputs, const ec_picture *picture, const ec_picture_style *style, ec_error *err)
{
    ec_result result = EC_OK;
    for (int i = 0; i < outputs->count; i++) {
        ec_output *output = &outputs->file[i];
        ec_error *first = result == EC_OK ? err : NULL; /* the first failure is reported */
        const ec_format *format = ec_output_format(output);
        ec_result written = format ? write_pixels(output->path, format, picture, style, first) : ec_picture_write_exr(output->path, picture, style, first);
        if (written != EC_OK) {
            result = written;
            continue;
        }
        ec_output_settle(output);
    }
    return result;
}
