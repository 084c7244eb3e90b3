/* Takes batches on one device, wave by wave, light paths first. */
#include "device/device_source.h"

#include <math.h>

#include "base/clock.h"
#include "device/adaptive.h"
#include "device/fold.h"
#include "device/help.h"
#include "device/lamp_edges.h"
#include "device/light_batch.h"
#include "device/tiers.h"

#define FEATURE_BYTES (4ull * EC_AOV_FIELDS)
#define BATCH_BYTES (4ull * EC_BATCH_FIELDS)

/* The first wave is smaller, so that there is something to show at once; but not where waves are that small anyway. */
#define FIRST_SHARE 8
#define FIRST_PATHS 16384

static uint64_t pixels_of(const ec_device_source *s) { return (uint64_t)s->pipeline.params.width * s->rows; }

static uint64_t positions_of(const ec_device_source *s) { return ec_order_positions(pixels_of(s), s->replicates); }

/* Unmaps the films: nobody reads them any more, and kernels may write them. */
static ec_result take_back(ec_device_source *s, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    EC_TRY(ec_buffer_unmap(p->cl, p->buffers[EC_ARG_BATCH_FILM], &s->base.mean, err));
    return ec_buffer_unmap(p->cl, p->buffers[EC_ARG_FEATURE_FILM], &s->base.features, err);
}

static ec_result turn_to(ec_batch_source *source, uint32_t first_row, uint32_t rows, ec_error *err)
{
    ec_device_source *s = (ec_device_source *)source;
    ec_pipeline *p = &s->pipeline;
    s->rows = rows;
    EC_TRY(take_back(s, err));
    EC_TRY(ec_pipeline_fit_films(p, pixels_of(s), positions_of(s), err));
    p->params.film_row = first_row;
    p->params.film_rows = rows;
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err);
}

static ec_result end_features(ec_batch_source *source, ec_error *err)
{
    ec_pipeline *p = &((ec_device_source *)source)->pipeline;
    cl_mem *film = &p->buffers[EC_ARG_FEATURE_FILM];
    if (!*film) return EC_OK;
    EC_TRY(ec_buffer_unmap(p->cl, *film, &source->features, err));
    EC_TRY(ec_cl_finish(p->cl, err));
    ec_buffer_release(p->cl, film);
    return EC_OK;
}

static ec_result upload_list(ec_device_source *s, const ec_batch_order *order, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    cl_mem *list = &p->buffers[EC_ARG_PIXEL_LIST];
    const uint64_t slack = 64; /* lanes past the last sample read too */
    if (order->light == EC_LIGHT_ALONE) return EC_OK; /* the next pass has a list again */
    if (!order->list) {
        ec_buffer_release(p->cl, list); /* that of a pilot */
        return EC_OK;
    }
    const uint64_t entry = 4 * EC_LIST_WORDS;
    if (!*list) EC_TRY(ec_buffer_create(p->cl, "pixel list", (positions_of(s) + slack) * entry, NULL, list, err));
    return ec_buffer_write(p->cl, *list, entry * order->done, entry * (order->count - order->done), order->list + EC_LIST_WORDS * order->done, err);
}

/* Writes to the device what of the batch is there already. */
static ec_result prepare(ec_device_source *s, const ec_batch_order *order, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    EC_TRY(take_back(s, err));
    if (order->before) EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_BATCH_FILM], 0, BATCH_BYTES * order->done, order->before, err));
    if (!order->features_before || !order->feature_sets) return EC_OK;
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_FEATURE_FILM], 0, FEATURE_BYTES * order->done, order->features_before, err);
}

/* Shows the batch to the host. If the order has no room for it, it stays where it is: a processor's films are the host's memory. */
static ec_result show(ec_device_source *s, const ec_batch_order *order, bool writes, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    const cl_mem batch = p->buffers[EC_ARG_BATCH_FILM], features = p->buffers[EC_ARG_FEATURE_FILM];
    const uint64_t first = order->done, count = order->count - first;
    EC_TRY(take_back(s, err));
    if (order->into) EC_TRY(ec_buffer_read(p->cl, batch, BATCH_BYTES * first, BATCH_BYTES * count, order->into, err));
    else EC_TRY(ec_buffer_map(p->cl, batch, BATCH_BYTES * order->count, writes, &s->base.mean, err));
    if (order->layers) {
        const uint64_t bytes = EC_LAYER_BYTES * p->params.layer_count;
        EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_LAYER_FILM], bytes * first, bytes * count, order->layers + bytes / 4 * first, err));
    }
    if (!order->feature_sets) return EC_OK;
    if (order->features_into) return ec_buffer_read(p->cl, features, FEATURE_BYTES * first, FEATURE_BYTES * count, order->features_into, err);
    return ec_buffer_map(p->cl, features, FEATURE_BYTES * order->count, writes, &s->base.features, err);
}

static ec_result tell(ec_device_source *s, const ec_batch_order *order, bool writes, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    EC_TRY(ec_buffer_read_later(p->cl, p->buffers[EC_ARG_INVALID], sizeof s->base.invalid, s->base.invalid, err));
    EC_TRY(show(s, order, writes, err)); /* waits */
    s->base.rays = p->rays;
    s->base.clocked_seconds = p->clocked_seconds;
    s->base.clocked_rays = p->clocked_rays;
    s->base.invalid[EC_STAGE_ACCUMULATE] += s->unfit;
    return EC_OK;
}

static ec_result look(ec_batch_source *source, const ec_batch_order *order, ec_error *err)
{
    return tell((ec_device_source *)source, order, false, err);
}

/* Marks the pixels of a first batch, given up before pixel `number`, that are missing in the rows of tiles that are begun, from which nobody goes on. */
static void mark_unreached(ec_device_source *s, const ec_batch_order *order, uint32_t number)
{
    const ec_params *params = &s->pipeline.params;
    const uint32_t row = EC_TILE_ROWS * params->width, before = params->film_row * params->width;
    const uint64_t begun = ((uint64_t)number + row - 1) / row * row;
    s->base.reached = begun < order->count ? (uint32_t)begun : order->count;
    for (; number < s->base.reached; number++)
        s->base.mean[(uint64_t)EC_BATCH_FIELDS * (ec_pixel_place(params, before + number) - before)] = EC_NOT_REACHED;
}

/* Sets which samples the kernels take; *numbers: by how much pixel numbers of the replicate exceed those of the picture (kernels/lib/film.h). */
static ec_result choose_samples(ec_device_source *s, const ec_batch_order *order, uint32_t *numbers, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    ec_params *params = &p->params;
    const ec_batch_range range = ec_schedule_batch(s->replicates, order->index);
    const uint32_t samples = order->list ? order->samples : range.samples - order->cut, first = order->list ? 0 : (uint32_t)range.first;
    *numbers = order->list ? 0 : range.replicate * params->width * params->height + params->film_row * params->width;
    const uint32_t is_apart = order->light == EC_LIGHT_APART;
    s->base.least = p->room / samples;
    if (params->batch == samples && params->first_sample == first && params->limit == order->limit && params->light_apart == is_apart) return EC_OK;
    params->light_apart = is_apart;
    params->batch = samples;
    params->first_sample = first;
    params->limit = order->limit;
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof *params, params, err);
}

static bool goes_on(void *user)
{
    const ec_batch_order *order = user;
    return order->go_on(order->user, order->done);
}

/* Compiles in place of rendering for as long as that pays. Returns false if the order is given up. */
static bool help(ec_device_source *s, const ec_batch_order *order, uint32_t reached)
{
    const double samples = order->left - (double)(reached - order->done) * s->pipeline.params.batch;
    while (s->has_shown && ec_help_compile(&s->pipeline, fmin(samples / s->first_rate, order->until - ec_now())))
        if (!order->go_on(order->user, reached)) return false;
    return true;
}

/* Runs a wave. The first one is timed, and has ended when this function returns. */
static ec_result run_wave(ec_device_source *s, const ec_batch_order *order, uint32_t first, uint32_t count, uint32_t seed, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    const double start = ec_now();
    if (order->light == EC_LIGHT_ALONE) EC_TRY(ec_pipeline_show_light(p, first, count, err));
    else EC_TRY(ec_pipeline_run_wave(p, seed, first, count, order->feature_sets > 0, err));
    if (s->has_begun) return EC_OK;
    EC_TRY(ec_cl_finish(p->cl, err));
    s->has_begun = true;
    s->first_rate = (double)count * p->params.batch / (ec_now() - start + 1e-9);
    return EC_OK;
}

static ec_result take_batch(ec_batch_source *source, const ec_batch_order *order, bool *complete, ec_error *err)
{
    ec_device_source *s = (ec_device_source *)source;
    ec_pipeline *p = &s->pipeline;
    const uint32_t seed = ec_render_seed(s->seed);
    uint32_t before;
    *complete = true;
    s->mattes.met.count = 0;
    s->base.batches = 1;
    EC_TRY(choose_samples(s, order, &before, err));
    EC_TRY(upload_list(s, order, err));
    EC_TRY(prepare(s, order, err));
    uint32_t reached = order->done;
    const uint32_t light_seed = ec_light_path_seed(seed, ec_schedule_batch(s->replicates, order->index).replicate);
    if (order->light != EC_LIGHT_APART) EC_TRY(ec_light_batch_run(p, light_seed, goes_on, (void *)order, complete, err));
    while (reached < order->count && *complete && (*complete = help(s, order, reached))) {
        EC_TRY(take_back(s, err));
        EC_TRY(ec_tiers_step(p, err));
        uint32_t count = p->wave / p->params.batch;
        if (!s->has_begun && p->wave > FIRST_PATHS) count = (count + FIRST_SHARE - 1) / FIRST_SHARE;
        if (count > order->count - reached) count = order->count - reached;
        if (order->light != EC_LIGHT_ALONE) EC_TRY(ec_lamp_edges_prepare(p, order->list, before + reached, &count, err));
        EC_TRY(run_wave(s, order, before + reached, count, seed, err));
        if (order->matte) EC_TRY(ec_mattes_read(&s->mattes, p, order->list != NULL, reached, count, err));
        reached += count;
        s->has_shown |= order->left > 0;
        *complete = order->go_on(order->user, reached) || reached == order->count;
    }
    EC_TRY(tell(s, order, !*complete, err));
    if (order->matte) EC_TRY(ec_mattes_tell(&s->mattes, order->matte, err));
    if (!*complete && order->index == 0 && !order->into) mark_unreached(s, order, reached);
    return EC_OK;
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
    if (s->pipeline.cl) (void)take_back(s, NULL);
    s->base.mean = s->base.features = NULL;
    ec_pipeline_destroy(&s->pipeline);
    ec_sums_destroy(&s->base.sums);
    ec_mattes_free(&s->mattes);
}

ec_result ec_device_source_open(ec_cl *cl, const ec_payload *payload, ec_payload *spent, uint64_t seed, ec_device_source *s,
                                ec_render_stats *stats, ec_error *err)
{
    *s = (ec_device_source){.base = {.take = take, .look = look, .turn_to = turn_to, .end_features = end_features, .close = close_device},
                            .seed = seed,
                            .replicates = payload->head.replicates};
    EC_TRY(ec_pipeline_create(cl, payload, spent, &s->pipeline, stats, err));
    return ec_lamp_edges_find(&s->pipeline, err);
}
