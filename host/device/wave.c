/* The path tracer's bounce loop. A wave's paths go generate → (intersect → shade → connect)* → accumulate; the host looks at
 * the queues only every EC_SEGMENT bounces. */
#include <string.h>

#include "device/pipeline.h"

/* Sends the counters: zeros, but for rays[0], which says how many paths each part holds. */
static ec_result begin_segment(ec_pipeline *p, ec_error *err)
{
    ec_counters *counters = &p->counters;
    memset((char *)counters + sizeof counters->rays[0], 0, sizeof *counters - sizeof counters->rays[0]);
    p->held = ec_pipeline_fullest(counters->rays[0]);
    return ec_buffer_send(p->cl, p->buffers[EC_ARG_COUNTERS], sizeof *counters, counters, err);
}

/* Reads the counters and adds up rays; rays[0] then says how many paths are left. */
static ec_result end_segment(ec_pipeline *p, ec_stage_id shade, ec_error *err)
{
    ec_counters *counters = &p->counters;
    p->held = 0;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, sizeof *counters, counters, err));
    for (uint32_t step = 0; step < EC_SEGMENT; step++) {
        p->rays += ec_pipeline_total(counters->rays[step]) + ec_pipeline_total(counters->shadows[step]);
        ec_pipeline_busy(p, EC_INTERSECT, counters->rays[step]);
        ec_pipeline_busy(p, shade, counters->rays[step]);
        ec_pipeline_busy(p, EC_CONNECT, counters->shadows[step]);
    }
    memcpy(counters->rays[0], counters->rays[EC_SEGMENT], sizeof counters->rays[0]);
    return EC_OK;
}

/* Runs up to EC_SEGMENT bounces, of light paths if `kind` is EC_LIGHT_BOUNCE. */
static ec_result run_segment(ec_pipeline *p, uint32_t *scalars, uint32_t kind, uint32_t first_bounce, ec_error *err)
{
    const bool of_light = kind != 0;
    const ec_stage_id shade = of_light ? EC_SHADE_LIGHT : EC_SHADE;
    EC_TRY(begin_segment(p, err));
    if (of_light && first_bounce == 0) EC_TRY(ec_pipeline_launch(p, EC_EMIT, scalars, err));
    for (uint32_t step = 0; step < EC_SEGMENT && first_bounce + step < p->params.max_depth; step++) {
        const uint32_t bounce = first_bounce + step;
        scalars[EC_ARG_BOUNCE] = bounce | kind;
        scalars[EC_ARG_STEP] = step;
        ec_pipeline_swap_queues(p, bounce);
        EC_TRY(ec_pipeline_trace(p, 0, bounce, scalars, err));
        EC_TRY(ec_pipeline_launch(p, shade, scalars, err));
        if (p->buffers[EC_ARG_PHOTONS]) continue; /* photons make the guide (train.c), and are joined to no camera */
        if (p->params.light_count) EC_TRY(ec_pipeline_trace(p, 1, bounce, scalars, err));
        if (of_light) EC_TRY(ec_pipeline_launch(p, EC_SPLAT, scalars, err));
    }
    return end_segment(p, shade, err);
}

/* Runs bounces from `first` on, as long as p->counters.rays[0] has paths. */
static ec_result run_bounces(ec_pipeline *p, uint32_t *scalars, uint32_t kind, uint32_t first, ec_error *err)
{
    for (uint32_t bounce = first; ec_pipeline_total(p->counters.rays[0]) && bounce < p->params.max_depth; bounce += EC_SEGMENT)
        EC_TRY(run_segment(p, scalars, kind, bounce, err));
    return EC_OK;
}

ec_result ec_integrate_paths(ec_pipeline *p, uint32_t *scalars, ec_error *err)
{
    ec_pipeline_fill_parts(p, scalars[EC_ARG_PATH_COUNT]);
    return run_bounces(p, scalars, 0, 0, err);
}

ec_result ec_pipeline_run_light_wave(ec_pipeline *p, uint32_t seed, uint32_t first, uint32_t count, ec_error *err)
{
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {0};
    scalars[EC_ARG_SEED] = seed;
    scalars[EC_ARG_FIRST_PIXEL] = first;
    scalars[EC_ARG_PATH_COUNT] = count * p->params.batch;
    cl_mem list = p->buffers[EC_ARG_PIXEL_LIST];
    p->buffers[EC_ARG_PIXEL_LIST] = NULL;
    ec_pipeline_swap_queues(p, 0);
    memset(&p->counters, 0, sizeof p->counters); /* ec_emit counts the paths */
    ec_result result = run_segment(p, scalars, EC_LIGHT_BOUNCE, 0, err);
    if (result == EC_OK) result = run_bounces(p, scalars, EC_LIGHT_BOUNCE, EC_SEGMENT, err);
    p->buffers[EC_ARG_PIXEL_LIST] = list;
    return result;
}

ec_result ec_pipeline_run_edge_rays(ec_pipeline *p, uint32_t seed, uint32_t count, ec_error *err)
{
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {[EC_ARG_SEED] = seed, [EC_ARG_PATH_COUNT] = count};
    cl_mem list = p->buffers[EC_ARG_PIXEL_LIST];
    p->buffers[EC_ARG_PIXEL_LIST] = p->buffers[EC_ARG_EDGE_LIST];
    ec_pipeline_swap_queues(p, 0);
    ec_pipeline_fill_parts(p, count);
    ec_result result = ec_pipeline_launch(p, EC_GENERATE, scalars, err);
    if (result == EC_OK) result = begin_segment(p, err);
    if (result == EC_OK) result = ec_pipeline_trace(p, 0, 0, scalars, err);
    if (result == EC_OK) result = ec_pipeline_launch(p, EC_SHADE, scalars, err);
    if (result == EC_OK) result = end_segment(p, EC_SHADE, err);
    p->buffers[EC_ARG_PIXEL_LIST] = list;
    return result;
}

ec_result ec_pipeline_show_light(ec_pipeline *p, uint32_t first_pixel, uint32_t pixel_count, ec_error *err)
{
    const uint32_t scalars[EC_ARG_SCALAR_COUNT] = {[EC_ARG_FIRST_PIXEL] = first_pixel, [EC_ARG_PATH_COUNT] = pixel_count * p->params.batch, [EC_ARG_PIXEL_COUNT] = pixel_count};
    for (uint64_t c = 0; c < 3; c++)
        EC_TRY(ec_buffer_zero(p->cl, p->buffers[EC_ARG_RADIANCE], 4ull * c * p->wave, 4ull * pixel_count * p->params.batch, err));
    cl_mem list = p->buffers[EC_ARG_PIXEL_LIST];
    p->buffers[EC_ARG_PIXEL_LIST] = NULL;
    ec_result result = ec_pipeline_launch(p, EC_ACCUMULATE, scalars, err);
    p->buffers[EC_ARG_PIXEL_LIST] = list;
    return result;
}

ec_result ec_pipeline_run_wave(ec_pipeline *p, uint32_t seed, uint32_t first_pixel, uint32_t pixel_count,
                               bool with_features, ec_error *err)
{
    static ec_integrate *const integrate[EC_INTEGRATOR_COUNT] = {
        [EC_INTEGRATOR_PATH] = ec_integrate_paths,
        [EC_INTEGRATOR_WHITTED] = ec_integrate_whitted,
        [EC_INTEGRATOR_RASTER] = ec_integrate_raster,
        [EC_INTEGRATOR_LIGHT] = ec_integrate_paths};
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {0};
    scalars[EC_ARG_SEED] = seed;
    scalars[EC_ARG_FIRST_PIXEL] = first_pixel;
    scalars[EC_ARG_PATH_COUNT] = (pixel_count + p->edges.positions) * p->params.batch;
    scalars[EC_ARG_PIXEL_COUNT] = pixel_count;
    scalars[EC_ARG_TRIANGLE_COUNT] = p->triangle_count;
    ec_pipeline_swap_queues(p, 0);
    cl_mem aov = p->buffers[EC_ARG_AOV], list = p->buffers[EC_ARG_PIXEL_LIST], edges = p->buffers[EC_ARG_EDGES];
    if (!with_features) p->buffers[EC_ARG_AOV] = NULL;
    if (p->edges.positions) {
        p->buffers[EC_ARG_PIXEL_LIST] = p->buffers[EC_ARG_EDGE_LIST];
        scalars[EC_ARG_FIRST_PIXEL] = 0;
    } else p->buffers[EC_ARG_EDGES] = NULL;
    ec_result result = ec_pipeline_launch(p, EC_GENERATE, scalars, err);
    if (result == EC_OK) result = integrate[p->integrator](p, scalars, err);
    if (result == EC_OK && p->edges.positions) result = ec_pipeline_launch(p, EC_LAMP_EDGES, scalars, err);
    scalars[EC_ARG_FIRST_PIXEL] = first_pixel;
    p->buffers[EC_ARG_EDGES] = edges;
    p->buffers[EC_ARG_PIXEL_LIST] = list;
    p->buffers[EC_ARG_AOV] = aov;
    if (result == EC_OK) result = ec_pipeline_launch(p, EC_ACCUMULATE, scalars, err);
    if (result == EC_OK && p->params.layer_count) result = ec_pipeline_launch(p, EC_SLOT_LAYERS, scalars, err);
    if (result == EC_OK && with_features) result = ec_pipeline_launch(p, EC_STORE_FEATURES, scalars, err);
    return result;
}
