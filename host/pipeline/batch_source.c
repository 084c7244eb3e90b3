#include "pipeline/batch_source.h"

#include <stdlib.h>

#include "base/random.h"

/* They must differ in every bit. */
uint32_t ec_render_batch_seed(uint64_t seed, uint32_t batch)
{
    return (uint32_t)(ec_random_mix(seed * EC_RANDOM_STEP + batch + 1) >> 16);
}

static uint64_t pixels_of(const ec_batch_source *s) { return (uint64_t)s->pipeline.params.width * s->rows; }

ec_result ec_batch_source_open(ec_cl *cl, ec_cargo *cargo, uint64_t seed, ec_batch_source *s, ec_render_stats *stats, ec_error *err)
{
    *s = (ec_batch_source){.seed = seed};
    return ec_pipeline_create(cl, cargo, cargo, &s->pipeline, stats, err);
}

ec_result ec_batch_source_turn_to(ec_batch_source *s, uint32_t first_row, uint32_t rows, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    s->rows = rows;
    const uint64_t pixels = pixels_of(s);
    EC_TRY(ec_pipeline_fit_films(p, pixels, err));
    float *mean = realloc(s->mean, pixels * 12);
    if (!mean) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)pixels);
    s->mean = mean;
    for (uint64_t i = 0; i < 3 * pixels; i++) s->mean[i] = EC_NOT_REACHED;
    p->params.film_row = first_row;
    EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err));
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_BATCH_FILM], 0, pixels * 12, s->mean, err);
}

void ec_batch_source_close(ec_batch_source *s)
{
    ec_pipeline_destroy(&s->pipeline);
    free(s->mean);
    s->mean = NULL;
}

static ec_result upload_list(ec_batch_source *s, const ec_batch_order *order, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    cl_mem *list = &p->buffers[EC_ARG_PIXEL_LIST];
    const uint64_t slack = 64; /* lanes past the last sample look too */
    if (!order->list) return EC_OK;
    if (!*list) EC_TRY(ec_buffer_create(p->cl, "pixel list", (pixels_of(s) + slack) * 4, NULL, list, err));
    return ec_buffer_write(p->cl, *list, 0, (uint64_t)order->count * 4, order->list, err);
}

ec_result ec_batch_source_look(ec_batch_source *s, const ec_batch_order *order, ec_error *err)
{
    EC_TRY(ec_buffer_read(s->pipeline.cl, s->pipeline.buffers[EC_ARG_BATCH_FILM], 0, (uint64_t)order->count * 12, s->mean, err));
    return ec_pipeline_read_invalid(&s->pipeline, s->invalid, err);
}

ec_result ec_batch_source_take(ec_batch_source *s, const ec_batch_order *order, bool *complete, ec_error *err)
{
    ec_pipeline *p = &s->pipeline;
    uint32_t per_wave = p->wave / p->params.batch, seed = ec_render_batch_seed(s->seed, order->index);
    const uint32_t before = order->list ? 0 : p->params.film_row * p->params.width; /* numbers of pixels above: rows of whole tiles */
    *complete = true;
    EC_TRY(upload_list(s, order, err));
    if (order->done) EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_BATCH_FILM], 0, (uint64_t)order->count * 12, s->mean, err));
    for (uint32_t first = order->done; first < order->count && *complete; first += per_wave) {
        uint32_t count = order->count - first < per_wave ? order->count - first : per_wave;
        EC_TRY(ec_pipeline_run_wave(p, seed, before + first, count, order->with_features, err));
        if (!s->has_begun) EC_TRY(ec_cl_finish(p->cl, err));
        s->has_begun = true;
        *complete = order->go_on(order->user, first + count) || first + count >= order->count;
    }
    return ec_batch_source_look(s, order, err);
}

ec_result ec_batch_source_features(ec_batch_source *s, float **aov, ec_error *err)
{
    uint64_t pixels = pixels_of(s);
    *aov = malloc(pixels * EC_AOV_FIELDS * sizeof(float));
    if (!*aov) return ec_fail(err, "out of memory for the first-hit features");
    ec_result result = ec_buffer_read(s->pipeline.cl, s->pipeline.buffers[EC_ARG_FEATURE_FILM], 0, pixels * EC_AOV_FIELDS * 4, *aov, err);
    if (result == EC_OK) return EC_OK;
    free(*aov);
    *aov = NULL;
    return result;
}
