/* Makes thumbnails, and data URIs of those of a study. */
#include "cost/cost_internal.h"

#include <stdlib.h>
#include <string.h>

#include "image/error_map.h"
#include "image/image.h"
#include "report/page.h"

enum { WIDTH_MOST = 192 }; /* width of a thumbnail */

/* Keeps every step-th pixel unchanged, as means would hide the noise that is to be seen. */
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

uint8_t *ec_cost_stage(const ec_render_options *o, const float *rgb)
{
    const thumbnail t = thumbnail_of(o);
    const uint64_t pixels = (uint64_t)t.width * t.height;
    float *small = ec_cost_shrink(o, rgb);
    uint8_t *bytes = malloc(3 * pixels);
    if (small && bytes) ec_tonemap_rgb(small, bytes, pixels, 0, EC_TONEMAP_NEUTRAL);
    else free(bytes), bytes = NULL;
    free(small);
    return bytes;
}

/* Adds a picture. to: an object, or an array, for which key is NULL. */
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

static uint32_t count_stages(const ec_cost_study *study)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < study->row_count; i++)
        for (uint32_t k = 0; k < study->rows[i].point_count; k++) count += study->rows[i].stages[k] != NULL;
    return count;
}

/* Adds the stages of one row, every step-th pixel. */
static ec_result add_row_stages(const ec_cost_row *row, uint32_t width, const thumbnail *t, uint8_t *bytes, cJSON *to, ec_error *err)
{
    for (uint32_t k = 0; k < row->point_count; k++) {
        if (!row->stages[k]) {
            cJSON_AddItemToArray(to, cJSON_CreateNull());
            continue;
        }
        for (uint32_t y = 0; y < t->height; y++)
            for (uint32_t x = 0; x < t->width; x++)
                memcpy(bytes + 3 * ((size_t)y * t->width + x), row->stages[k] + 3 * t->step * ((size_t)y * width + x), 3);
        EC_TRY(add(to, NULL, t, bytes, err));
    }
    return EC_OK;
}

static ec_result add_stages(const ec_cost_study *study, const thumbnail *full, uint8_t *bytes, cJSON *to, ec_error *err)
{
    const uint64_t count = count_stages(study);
    thumbnail t = {full->width, full->height, 1};
    while (count * t.width * t.height > EC_COST_STAGE_PIXELS && t.width > 1 && t.height > 1) {
        t.step++;
        t.width = (full->width + t.step - 1) / t.step, t.height = (full->height + t.step - 1) / t.step;
    }
    for (uint32_t i = 0; i < study->row_count; i++)
        if (study->rows[i].point_count)
            EC_TRY(add_row_stages(&study->rows[i], full->width, &t, bytes, cJSON_AddArrayToObject(to, study->rows[i].rung.id), err));
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
    if (result == EC_OK) result = add_stages(study, &t, bytes, cJSON_AddObjectToObject(*images, "stages"), err);
    free(reference);
    free(bytes);
    return result;
}
