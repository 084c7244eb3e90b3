/* The path tracer's bounce loop. A wave's paths go generate → (intersect → shade → connect)* → accumulate; the host looks at
 * the queues only every EC_SEGMENT bounces. */
#include <string.h>

#include "base/clock.h"
#include "pipeline/pipeline.h"

/* Tries each traversal at each of the first bounces, then keeps the faster. Hits are the same, so only time is at stake. The
 * best of three counts (after one that may compile), since other programs can only slow a trial down. Rays only lose
 * coherence from bounce to bounce: packets are tried where they have won the bounce before. */
#define TRIALS 4
static ec_trace choose_trace(const ec_pipeline *p, int connect, uint32_t bounce, bool *is_trial)
{
    *is_trial = false;
    if (!p->has_trace[EC_TRACE_BVH8]) return EC_TRACE_PACKET;
    if (!p->has_trace[EC_TRACE_PACKET]) return EC_TRACE_BVH8;
    for (uint32_t b = 0; b <= bounce && b < EC_TUNED_BOUNCES; b++) {
        const uint32_t *trials = p->tuning[connect][b].trials;
        const double *rate = p->tuning[connect][b].best_rate;
        for (int t = 0; t < EC_TRACE_COUNT; t++) {
            if (trials[t] >= TRIALS) continue;
            *is_trial = b == bounce;
            return *is_trial ? (ec_trace)t : EC_TRACE_BVH8;
        }
        if (rate[EC_TRACE_BVH8] > rate[EC_TRACE_PACKET]) return EC_TRACE_BVH8;
    }
    return EC_TRACE_PACKET;
}

static uint64_t total(const uint32_t *parts)
{
    uint64_t sum = 0;
    for (int k = 0; k < EC_PARTS; k++) sum += parts[k * EC_PART_STRIDE];
    return sum;
}

static ec_result trace(ec_pipeline *p, int connect, uint32_t bounce, const uint32_t *scalars, ec_error *err)
{
    static const ec_stage_id stages[2][EC_TRACE_COUNT] = {{EC_INTERSECT_PACKET, EC_INTERSECT_BVH8},
                                                          {EC_CONNECT_PACKET, EC_CONNECT_BVH8}};
    bool is_trial;
    ec_trace t = choose_trace(p, connect, bounce, &is_trial);
    if (!is_trial) return ec_pipeline_launch(p, stages[connect][t], scalars, err);
    ec_counters *counters = &p->counters;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, sizeof *counters, counters, err));
    double start = ec_now();
    EC_TRY(ec_pipeline_launch(p, stages[connect][t], scalars, err));
    EC_TRY(ec_cl_finish(p->cl, err));
    uint32_t step = scalars[EC_ARG_STEP];
    uint64_t rays = total(connect ? counters->shadows[step] : counters->rays[step]);
    double rate = (double)rays / (ec_now() - start), *best = &p->tuning[connect][bounce].best_rate[t];
    if (p->tuning[connect][bounce].trials[t]++ > 0 && rate > *best) *best = rate;
    return EC_OK;
}

static void swap_queues(ec_pipeline *p, uint32_t bounce)
{
    p->buffers[EC_ARG_PATHS] = p->path_queues[bounce & 1];
    p->buffers[EC_ARG_NEXT] = p->path_queues[~bounce & 1];
}

/* Up to EC_SEGMENT bounces. In p->counters, rays[0] says how many paths each part holds at the start; at the end rays[0]
 * says what is left. */
static ec_result run_segment(ec_pipeline *p, uint32_t *scalars, uint32_t first_bounce, ec_error *err)
{
    ec_counters *counters = &p->counters;
    memset((char *)counters + sizeof counters->rays[0], 0, sizeof *counters - sizeof counters->rays[0]);
    EC_TRY(ec_buffer_write(p->cl, p->buffers[EC_ARG_COUNTERS], 0, sizeof *counters, counters, err));
    for (uint32_t step = 0; step < EC_SEGMENT && first_bounce + step < p->params.max_depth; step++) {
        scalars[EC_ARG_BOUNCE] = first_bounce + step;
        scalars[EC_ARG_STEP] = step;
        swap_queues(p, first_bounce + step);
        EC_TRY(trace(p, 0, first_bounce + step, scalars, err));
        EC_TRY(ec_pipeline_launch(p, EC_SHADE, scalars, err));
        if (p->params.light_count) EC_TRY(trace(p, 1, first_bounce + step, scalars, err));
    }
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, sizeof *counters, counters, err));
    for (uint32_t step = 0; step < EC_SEGMENT; step++) p->rays += total(counters->rays[step]) + total(counters->shadows[step]);
    memcpy(counters->rays[0], counters->rays[EC_SEGMENT], sizeof counters->rays[0]);
    return EC_OK;
}

/* Paths fill the parts one after the other. */
static void fill_parts(ec_pipeline *p, uint32_t paths)
{
    for (uint32_t k = 0; k < EC_PARTS; k++) {
        uint32_t before = k * p->params.part, left = paths > before ? paths - before : 0;
        p->counters.rays[0][k * EC_PART_STRIDE] = left < p->params.part ? left : p->params.part;
    }
}

ec_result ec_run_path_wave(ec_pipeline *p, uint32_t seed, uint32_t first_pixel, uint32_t pixel_count, bool with_features,
                           ec_error *err)
{
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {0};
    uint32_t paths = pixel_count * p->params.batch;
    scalars[EC_ARG_SEED] = seed;
    scalars[EC_ARG_FIRST_PIXEL] = first_pixel;
    scalars[EC_ARG_PATH_COUNT] = paths;
    scalars[EC_ARG_PIXEL_COUNT] = pixel_count;
    swap_queues(p, 0);
    cl_mem aov = p->buffers[EC_ARG_AOV];
    if (!with_features) p->buffers[EC_ARG_AOV] = NULL;

    ec_result result = ec_pipeline_launch(p, EC_GENERATE, scalars, err);
    fill_parts(p, paths);
    for (uint32_t bounce = 0; result == EC_OK && total(p->counters.rays[0]) && bounce < p->params.max_depth; bounce += EC_SEGMENT)
        result = run_segment(p, scalars, bounce, err);
    p->buffers[EC_ARG_AOV] = aov;
    if (result == EC_OK) result = ec_pipeline_launch(p, EC_ACCUMULATE, scalars, err);
    if (result == EC_OK && with_features) result = ec_pipeline_launch(p, EC_STORE_FEATURES, scalars, err);
    return result;
}
