#include "rare/look.h"

#include <stdlib.h>
#include <string.h>

#include "base/luminance.h"

#define SEED 0x2545f491u /* any, but no render's: seeds are mixed (device_source.c) */

uint32_t ec_look_paths(const ec_pipeline *p, uint32_t most)
{
    const uint64_t pixels = (uint64_t)p->params.width * p->params.height;
    return (uint32_t)(pixels * EC_LOOK_PIXEL < most ? pixels * EC_LOOK_PIXEL : most);
}

uint32_t ec_look_accel(const ec_pipeline *p)
{
    uint32_t accel = EC_ACCEL_COUNT - 1;
    while (!(p->kernels.accels >> accel & 1)) accel--;
    return accel;
}

ec_result ec_look_luminance(const ec_look *look, float *rgb, float *luminance, ec_error *err)
{
    const ec_pipeline *p = look->p;
    const uint32_t count = look->count, fields = p->params.apart ? 6 : 3;
    EC_TRY(ec_buffer_read_rows(p->cl, p->buffers[EC_ARG_RADIANCE], 4ull * p->wave, 4ull * count, fields, rgb, err));
    for (uint32_t i = 0; i < count; i++) {
        double sum = 0;
        for (uint32_t f = 0; f < fields; f += 3) {
            const float *r = rgb + (size_t)f * count + i;
            sum += ec_luminance((double[3]){r[0], r[count], r[2 * (size_t)count]});
        }
        luminance[i] = (float)sum;
    }
    return EC_OK;
}

/* Traces one bounce: the counters of bounce 0 say how many paths each part of the queue holds, and at the end how many are left. */
static ec_result bounce(ec_look *look, uint32_t *scalars, uint32_t number, ec_error *err)
{
    ec_pipeline *p = look->p;
    ec_counters *counters = &p->counters;
    EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_COUNTERS], 0, ec_counters_clear(counters, 1), counters, err));
    scalars[EC_ARG_BOUNCE] = number;
    ec_pipeline_swap_queues(p, number);
    EC_TRY(ec_pipeline_launch_trace(p, 0, ec_look_accel(p), scalars, err));
    if (look->met) EC_TRY(look->met(look->user, number, err));
    EC_TRY(ec_pipeline_launch(p, EC_SHADE, scalars, err));
    if (look->shaded) EC_TRY(look->shaded(look->user, number, err));
    if (look->samples_light && p->params.light_count) EC_TRY(ec_pipeline_launch_trace(p, 1, ec_look_accel(p), scalars, err));
    if (look->lit) EC_TRY(look->lit(look->user, number, err));
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, ec_counters_bytes(1), counters, err));
    memcpy(counters->at[0].rays, counters->at[1].rays, sizeof counters->at[0].rays);
    return EC_OK;
}

static ec_result trace_wave(ec_look *look, ec_error *err)
{
    ec_pipeline *p = look->p;
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {[EC_ARG_SEED] = SEED, [EC_ARG_PATH_COUNT] = look->count, [EC_ARG_PIXEL_COUNT] = look->count,
                                             [EC_ARG_TRIANGLE_COUNT] = p->triangle_count};
    EC_TRY(ec_buffer_write(p->cl, look->pixels, 0, 4ull * EC_LIST_WORDS * look->count, look->list + (size_t)EC_LIST_WORDS * look->first, err));
    ec_pipeline_swap_queues(p, 0);
    EC_TRY(ec_pipeline_launch(p, EC_GENERATE, scalars, err));
    ec_pipeline_fill_parts(p, look->count);
    for (uint32_t b = 0; b < look->bounces && ec_pipeline_total(p->counters.at[0].rays); b++) EC_TRY(bounce(look, scalars, b, err));
    return EC_OK;
}

static ec_result trace_all(ec_look *look, ec_error *err)
{
    const uint32_t wave = look->p->wave, part = look->p->params.part;
    for (look->first = 0; look->first < look->paths; look->first += look->count) {
        const uint32_t left = look->paths - look->first;
        look->count = left < wave ? left : wave;
        look->stride = (look->count + part - 1) / part * part;
        EC_TRY(trace_wave(look, err));
    }
    return EC_OK;
}

/* Lists the paths' pixels, evenly over the numbers of pixels, which lie tile by tile, `each` samples of a pixel; the next round over them takes their
 * next samples. */
static void list_paths(const ec_look *look)
{
    const uint64_t pixels = (uint64_t)look->p->params.width * look->p->params.height, each = look->each, group = each * look->replicates, places = look->paths / group;
    for (uint64_t i = 0; i < look->paths; i++) {
        const uint64_t at = i / group, pixel = pixels < places ? at % pixels : at * pixels / places;
        look->list[EC_LIST_WORDS * i] = (uint32_t)(pixel + i % group / each * pixels);
        look->list[EC_LIST_WORDS * i + 1] = (uint32_t)((pixels < places ? at / pixels * each : 0) + i % each);
    }
}

/* Traces paths as one sample a pixel, and no part of a batch. Shading counts values that are not finite; those counts are restored. */
static ec_result trace_apart(ec_look *look, ec_error *err)
{
    ec_pipeline *p = look->p;
    const ec_params params = p->params;
    const cl_mem list = p->buffers[EC_ARG_PIXEL_LIST], aov = p->buffers[EC_ARG_AOV];
    uint32_t invalid[EC_STAGE_COUNT];
    const uint64_t bytes = 4ull * EC_LIST_WORDS * look->paths, slack = 64 * 4 * EC_LIST_WORDS; /* lanes past the last path look too */
    EC_TRY(ec_pipeline_read_invalid(p, invalid, err));
    EC_TRY(ec_buffer_create(p->cl, "pixel list", bytes + slack, NULL, &look->pixels, err));
    p->params.batch = 1;
    p->params.first_sample = 0;
    p->params.film_row = 0;
    p->buffers[EC_ARG_PIXEL_LIST] = look->pixels;
    p->buffers[EC_ARG_AOV] = NULL;
    ec_result result = ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err);
    if (result == EC_OK) result = trace_all(look, err);
    p->params = params;
    p->buffers[EC_ARG_PIXEL_LIST] = list;
    p->buffers[EC_ARG_AOV] = aov;
    if (result == EC_OK) result = ec_buffer_write(p->cl, p->buffers[EC_ARG_INVALID], 0, sizeof invalid, invalid, err);
    if (result == EC_OK) result = ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof params, &params, err);
    if (result == EC_OK) result = ec_cl_finish(p->cl, err);
    ec_buffer_release(p->cl, &look->pixels);
    return result;
}

ec_result ec_look_trace(ec_look *look, ec_error *err)
{
    look->list = malloc(4ull * EC_LIST_WORDS * look->paths);
    if (!look->list) return ec_fail(err, "out of memory for %u paths", look->paths);
    list_paths(look);
    const ec_result result = trace_apart(look, err);
    free(look->list);
    look->list = NULL;
    return result;
}
