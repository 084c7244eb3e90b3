/* Thumbnails, and those of a study as data URIs. */
#include "cost/cost_internal.h"

#include <stdlib.h>
#include <string.h>

#include "image/error_map.h"
#include "image/image.h"
#include "report/page.h"

enum { WIDTH_MOST = 192 }; /* of a thumbnail */

/* Every step-th pixel as it is: means of several would hide the noise that is to be seen. */
typedef struct thumbnail {
    uint32_t width, height, step;
} thumbnail;

static thumbnail thumbnail_of(const ec_render_options *o)
{
    uint32_t step = (o->width + WIDTH_MOST - 1) / WIDTH_MOST;
    return (thumbnail){(o->width + step - 1) / step, (o->height + step - 1) / step, step};
}

float *ec_cost_shrink(const ec_render_options *o, const float *rgb)
{
    thumbnail t = thumbnail_of(o);
    float *small = malloc(3 * sizeof *small * t.width * t.height);
    for (uint32_t y = 0; small && y < t.height; y++)
        for (uint32_t x = 0; x < t.width; x++)
            memcpy(small + 3 * ((size_t)y * t.width + x),
                   rgb + 3 * ((size_t)y * t.step * o->width + (size_t)x * t.step), 3 * sizeof *rgb);
    return small;
}

/* to: an object or an array; key: NULL for an array */
static ec_result add(cJSON *to, const char *key, const thumbnail *t, const uint8_t *rgb, ec_error *err)
{
    cJSON *text = NULL;
    EC_TRY(ec_page_picture(t->width, t->height, rgb, &text, err));
    if (key)
        cJSON_AddItemToObject(to, key, text);
    else
        cJSON_AddItemToArray(to, text);
    return EC_OK;
}

static ec_result add_all(const ec_cost_study *study, const thumbnail *t, const float *reference, uint8_t *bytes,
                         cJSON *to, ec_error *err)
{
    uint64_t pixels = (uint64_t)t->width * t->height;
    ec_tonemap_rgb(reference, bytes, pixels, 0, EC_TONEMAP_NEUTRAL);
    EC_TRY(add(to, "reference", t, bytes, err));
    for (uint32_t i = 0; i < study->row_count; i++) {
        const ec_cost_row *row = &study->rows[i];
        if (!row->picture) continue;
        cJSON *pair = cJSON_AddArrayToObject(to, row->rung.id);
        ec_tonemap_rgb(row->picture, bytes, pixels, 0, EC_TONEMAP_NEUTRAL);
        EC_TRY(add(pair, NULL, t, bytes, err));
        ec_error_map(row->picture, reference, pixels, bytes);
        EC_TRY(add(pair, NULL, t, bytes, err));
    }
    return EC_OK;
}

ec_result ec_cost_pictures(const ec_cost_study *study, cJSON **images, ec_error *err)
{
    *images = cJSON_CreateObject();
    if (!study->reference.rgb) return EC_OK;
    thumbnail t = thumbnail_of(&study->options);
    float *reference = ec_cost_shrink(&study->options, study->reference.rgb);
    uint8_t *bytes = malloc(3 * (size_t)t.width * t.height);
    ec_result result = reference && bytes ? add_all(study, &t, reference, bytes, *images, err)
                                          : ec_fail(err, "out of memory for the pictures of a report");
    free(reference);
    free(bytes);
    return result;
}
