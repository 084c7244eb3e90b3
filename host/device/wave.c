/* The path tracer's bounce loop. A wave's paths go generate → (intersect → shade → connect)* → accumulate; the host looks at
 * the queues only every EC_SEGMENT bounces. */
#include <string.h>

#include "device/pipeline.h"

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
        ec_pipeline_swap_queues(p, first_bounce + step);
        EC_TRY(ec_pipeline_trace(p, 0, first_bounce + step, scalars, err));
        EC_TRY(ec_pipeline_launch(p, EC_SHADE, scalars, err));
        if (p->params.light_count) EC_TRY(ec_pipeline_trace(p, 1, first_bounce + step, scalars, err));
    }
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, sizeof *counters, counters, err));
    for (uint32_t step = 0; step < EC_SEGMENT; step++)
        p->rays += ec_pipeline_total(counters->rays[step]) + ec_pipeline_total(counters->shadows[step]);
    memcpy(counters->rays[0], counters->rays[EC_SEGMENT], sizeof counters->rays[0]);
    return EC_OK;
}

ec_result ec_integrate_paths(ec_pipeline *p, uint32_t *scalars, ec_error *err)
{
    ec_pipeline_fill_parts(p, scalars[EC_ARG_PATH_COUNT]);
    for (uint32_t bounce = 0; ec_pipeline_total(p->counters.rays[0]) && bounce < p->params.max_depth; bounce += EC_SEGMENT)
        EC_TRY(run_segment(p, scalars, bounce, err));
    return EC_OK;
}

ec_result ec_pipeline_run_wave(ec_pipeline *p, uint32_t seed, uint32_t first_pixel, uint32_t pixel_count,
                               bool with_features, ec_error *err)
{
    static ec_integrate *const integrate[EC_INTEGRATOR_COUNT] = {
        [EC_INTEGRATOR_PATH] = ec_integrate_paths,
        [EC_INTEGRATOR_WHITTED] = ec_integrate_whitted,
        [EC_INTEGRATOR_RASTER] = ec_integrate_raster};
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {0};
    scalars[EC_ARG_SEED] = seed;
    scalars[EC_ARG_FIRST_PIXEL] = first_pixel;
    scalars[EC_ARG_PATH_COUNT] = pixel_count * p->params.batch;
    scalars[EC_ARG_PIXEL_COUNT] = pixel_count;
    scalars[EC_ARG_TRIANGLE_COUNT] = p->triangle_count;
    ec_pipeline_swap_queues(p, 0);
    cl_mem aov = p->buffers[EC_ARG_AOV];
    if (!with_features) p->buffers[EC_ARG_AOV] = NULL;

    ec_result result = ec_pipeline_launch(p, EC_GENERATE, scalars, err);
    if (result == EC_OK) result = integrate[p->integrator](p, scalars, err);
    p->buffers[EC_ARG_AOV] = aov;
    if (result == EC_OK) result = ec_pipeline_launch(p, EC_ACCUMULATE, scalars, err);
    if (result == EC_OK && with_features) result = ec_pipeline_launch(p, EC_STORE_FEATURES, scalars, err);
    return result;
}
