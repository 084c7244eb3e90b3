#include "device/device_source.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "device/fold.h"
#include "device/tiers.h"

#define FEATURE_BYTES (4ull * EC_AOV_FIELDS)
#define BATCH_BYTES (4ull * EC_BATCH_FIELDS)

/* Seeds that differ in one bit must give numbers that differ in every bit. */
uint32_t ec_render_seed(uint64_t seed) { return (uint32_t)(ec_random_mix(seed * EC_RANDOM_STEP + 1) >> 16); }

static uint64_t pixels_of(const ec_device_source *s) { return (uint64_t)s->pipeline.params.width * s->rows; }

static uint64_t positions_of(const ec_device_source *s) { return ec_order_positions(pixels_of(s), s->replicates); }

static ec_result turn_to(ec_batch_source *source, uint32_t first_row, uint32_t rows, ec_error *err)
{
    ec_device_source *s = (ec_device_source *)source;
    ec_pipeline *p = &s->pipeline;
    const float not_reached = EC_NOT_REACHED;
    if (rows != s->rows) free(s->own), s->own = NULL;
    s->rows = rows;
    EC_TRY(ec_pipeline_fit_films(p, pixels_of(s), positions_of(s), err));
    p->params.film_row = first_row;
    EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err));
    return ec_buffer_fill(p->cl, p->buffers[EC_ARG_BATCH_FILM], 0, pixels_of(s) * BATCH_BYTES, &not_reached, err);
}

static ec_result upload_list(ec_device_source *s, const ec_batch_order *order, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    cl_mem *list = &p->buffers[EC_ARG_PIXEL_LIST];
    const uint64_t slack = 64; /* lanes past the last sample look too */
    if (!order->list) {
        ec_buffer_release(p->cl, list); /* of a pilot */
        return EC_OK;
    }
    const uint64_t entry = 4 * EC_LIST_WORDS;
    if (!*list) EC_TRY(ec_buffer_create(p->cl, "pixel list", (positions_of(s) + slack) * entry, NULL, list, err));
    return ec_buffer_write(p->cl, *list, entry * order->done, entry * (order->count - order->done), order->list + EC_LIST_WORDS * order->done, err);
}

/* Where positions from `first` on go on the host: what an order brings is room for its own. */
static float *place_of(const ec_device_source *s, const ec_batch_order *order, uint64_t first)
{
    return order->into ? order->into + EC_BATCH_FIELDS * (first - order->done) : s->own + EC_BATCH_FIELDS * first;
}

/* Where the batch goes on the host, and what of it is there. */
static ec_result prepare(ec_device_source *s, const ec_batch_order *order, ec_error *err)
{
    if (!order->into && !s->own) s->own = malloc(positions_of(s) * BATCH_BYTES);
    s->base.mean = s->own;
    if (!order->into && !s->own) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)pixels_of(s));
    if (order->before) memcpy(s->base.mean, order->before, BATCH_BYTES * order->count);
    return EC_OK;
}

static ec_result look(ec_batch_source *source, const ec_batch_order *order, ec_error *err)
{
    ec_device_source *s = (ec_device_source *)source;
    ec_pipeline *p = &s->pipeline;
    const uint64_t first = order->done;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_BATCH_FILM], BATCH_BYTES * first, BATCH_BYTES * (order->count - first),
                          place_of(s, order, first), err));
    s->base.rays = p->rays;
    s->base.clocked_seconds = p->clocked_seconds;
    s->base.clocked_rays = p->clocked_rays;
    if (order->aov)
        EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_FEATURE_FILM], FEATURE_BYTES * first, FEATURE_BYTES * (order->count - first),
                              order->aov + EC_AOV_FIELDS * first, err));
    EC_TRY(ec_pipeline_read_invalid(p, s->base.invalid, err));
    s->base.invalid[EC_STAGE_ACCUMULATE] += s->unfit;
    return EC_OK;
}

/* Which samples the kernels take; and the numbers that pixels of the replicate have beyond those of the picture (kernels/lib/film.h). */
static ec_result choose_samples(ec_device_source *s, const ec_batch_order *order, uint32_t *numbers, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    ec_params *params = &p->params;
    const ec_batch_range range = ec_schedule_batch(s->replicates, order->index);
    const uint32_t samples = order->list ? order->samples : range.samples - order->cut, first = order->list ? 0 : (uint32_t)range.first;
    *numbers = order->list ? 0 : range.replicate * params->width * params->height + params->film_row * params->width;
    s->base.least = p->room / samples;
    if (params->batch == samples && params->first_sample == first && params->limit == order->limit) return EC_OK;
    params->batch = samples;
    params->first_sample = first;
    params->limit = order->limit;
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof *params, params, err);
}

static ec_result take_batch(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err)
{
    ec_device_source *s = (ec_device_source *)source;
    ec_pipeline *p = &s->pipeline;
    const uint32_t seed = ec_render_seed(s->seed);
    uint32_t before;
    *complete = true;
    s->base.batches = 1;
    EC_TRY(choose_samples(s, order, &before, err));
    EC_TRY(upload_list(s, order, err));
    EC_TRY(prepare(s, order, err));
    for (uint32_t first = order->done, count; first < order->count && *complete; first += count) {
        EC_TRY(ec_tiers_step(p, err));
        count = p->wave / p->params.batch;
        if (count > order->count - first) count = order->count - first;
        EC_TRY(ec_pipeline_run_wave(p, seed, before + first, count, order->aov != NULL, err));
        if (!s->has_begun) EC_TRY(ec_cl_finish(p->cl, err));
        s->has_begun = true;
        *complete = order->go_on(order->user, first + count) || first + count >= order->count;
    }
    return look(source, order, err);
}

static ec_result take(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err)
{
    ec_device_source *s = (ec_device_source *)source;
    const uint32_t before = s->unfit;
    if (order->batches <= 1) return take_batch(source, order, complete, err);
    const ec_fold_parts one_by_one = {.batches = 1, .take = take_batch, .want_room = true};
    EC_TRY(ec_fold_block(source, order, s->replicates, &one_by_one, &s->unfit, complete, err));
    source->invalid[EC_STAGE_ACCUMULATE] += s->unfit - before;
    return EC_OK;
}

static void close_device(ec_batch_source *source)
{
    ec_device_source *s = (ec_device_source *)source;
    ec_pipeline_destroy(&s->pipeline);
    ec_sums_destroy(&s->base.sums);
    free(s->own);
    s->own = s->base.mean = NULL;
}

ec_result ec_device_source_open(ec_cl *cl, const ec_cargo *cargo, ec_cargo *spent, uint64_t seed, ec_device_source *s,
                                ec_render_stats *stats, ec_error *err)
{
    *s = (ec_device_source){.base = {.take = take, .look = look, .turn_to = turn_to, .close = close_device},
                            .seed = seed,
                            .replicates = cargo->head.replicates};
    return ec_pipeline_create(cl, cargo, spent, &s->pipeline, stats, err);
}
