#include "pipeline/session.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/random.h"
#include "pipeline/pipeline.h"

struct ec_session {
    ec_pipeline pipeline;
};

ec_result ec_session_open(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t largest, ec_session **session,
                          ec_render_stats *stats, ec_error *err)
{
    ec_session *s = calloc(1, sizeof *s);
    *session = s;
    *stats = (ec_render_stats){0};
    if (!s) return ec_fail(err, "out of memory for a pipeline");
    ec_result result = ec_pipeline_create(cl, scene, options, largest, &s->pipeline, stats, err);
    stats->device_bytes = cl->peak_allocated_bytes;
    if (result == EC_OK) return EC_OK;
    ec_session_close(s);
    *session = NULL;
    return result;
}

void ec_session_close(ec_session *session)
{
    if (!session) return;
    ec_pipeline_destroy(&session->pipeline);
    free(session);
}

uint32_t ec_session_largest(const ec_session *session) { return session->pipeline.wave; }

static ec_result set_batch(ec_pipeline *p, uint32_t samples, ec_error *err)
{
    if (p->params.batch == samples) return EC_OK;
    p->params.batch = samples;
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err);
}

static void drop_invalid(ec_session_batch *batch, uint64_t values)
{
    batch->invalid = 0;
    for (uint64_t i = 0; i < values; i++) {
        if (isfinite(batch->mean[i])) continue;
        batch->mean[i] = 0.0f;
        batch->invalid++;
    }
}

ec_result ec_session_take(ec_session *session, ec_session_batch *batch, ec_error *err)
{
    ec_pipeline *p = &session->pipeline;
    uint32_t pixels = p->params.width * p->params.height, per_wave = p->wave / batch->samples;
    double start = ec_now();
    batch->complete = false;
    EC_TRY(set_batch(p, batch->samples, err));
    for (uint32_t first = 0; first < pixels; first += per_wave) {
        if (batch->go_on && !batch->go_on(batch->user)) return ec_cl_finish(p->cl, err);
        uint32_t count = pixels - first < per_wave ? pixels - first : per_wave;
        EC_TRY(ec_pipeline_run_wave(p, batch->seed, first, count, false, err));
    }
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_BATCH_FILM], 0, (uint64_t)pixels * 12, batch->mean, err));
    batch->seconds = ec_now() - start;
    batch->complete = true;
    drop_invalid(batch, 3 * (uint64_t)pixels);
    return EC_OK;
}

ec_result ec_session_invalid(ec_session *session, uint64_t *samples, ec_error *err)
{
    uint32_t invalid[EC_STAGE_COUNT];
    EC_TRY(ec_pipeline_read_invalid(&session->pipeline, invalid, err));
    *samples = 0;
    for (int i = 0; i < EC_STAGE_COUNT; i++) *samples += invalid[i];
    return EC_OK;
}

uint32_t ec_session_seed(uint64_t seed, uint32_t stream, uint32_t index)
{
    uint64_t state = seed ^ UINT64_C(0x65636c6174);
    state = ec_random_bits(&state) ^ ((uint64_t)stream << 32 | index);
    return (uint32_t)(ec_random_bits(&state) >> 16);
}
