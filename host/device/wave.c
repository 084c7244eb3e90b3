/* The path tracer's bounce loop. A wave's paths go generate → (intersect → shade → connect)* → accumulate; the host looks at
 * the queues only at the ends of segments. */
#include <string.h>

#include "device/pipeline.h"

/* Sends the counters of so many bounces: zeros, but for the first rays, which say how many paths each part holds. */
static ec_result begin_segment(ec_pipeline *p, uint32_t bounces, ec_error *err)
{
    p->held = ec_pipeline_fullest(p->counters.at[0].rays);
    return ec_buffer_send(p->cl, p->buffers[EC_ARG_COUNTERS], ec_counters_clear(&p->counters, bounces), &p->counters, err);
}

/* Reads the counters after so many bounces and adds up rays; the first ones then say how many paths are left. *traced: how many of the bounces had a
 * path. */
static ec_result end_segment(ec_pipeline *p, ec_stage_id shade, uint32_t bounces, uint32_t *traced, ec_error *err)
{
    ec_counters *counters = &p->counters;
    p->held = 0;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, ec_counters_bytes(bounces), counters, err));
    *traced = 0;
    for (uint32_t step = 0; step < bounces; step++) {
        const uint64_t paths = ec_pipeline_total(counters->at[step].rays);
        *traced += paths > 0;
        p->rays += paths + ec_pipeline_total(counters->at[step].shadows);
        ec_pipeline_busy(p, EC_INTERSECT, counters->at[step].rays);
        ec_pipeline_busy(p, shade, counters->at[step].rays);
        ec_pipeline_busy(p, EC_CONNECT, counters->at[step].shadows);
    }
    memcpy(counters->at[0].rays, counters->at[bounces].rays, sizeof counters->at[0].rays);
    return EC_OK;
}

/* Returns how many bounces from `first` on come before the next look at the queues. The last wave's paths had `last` bounces, and this wave's hardly have
 * more. On a processor all of these are launched while the first one runs, since a launch that finds the device idle has to wake it. Cards are looked at
 * more often: their launches go over what is left (launch.c). */
static uint32_t segment_length(const ec_pipeline *p, uint32_t first, uint32_t last)
{
    enum { UNKNOWN = 16, LATE = 4, OF_CARDS = 8 };
    const uint32_t length = !last ? UNKNOWN : first >= last ? LATE : last - first, left = p->params.max_depth - first;
    const uint32_t most = p->cl->info.type & CL_DEVICE_TYPE_CPU ? EC_SEGMENT : OF_CARDS, least = length < most ? length : most;
    return least < left ? least : left;
}

/* Runs so many bounces from `first` on, of light paths if `kind` is EC_LIGHT_BOUNCE. *traced: as in end_segment. */
static ec_result run_segment(ec_pipeline *p, uint32_t *scalars, uint32_t kind, uint32_t first, uint32_t bounces, uint32_t *traced, ec_error *err)
{
    const bool of_light = kind != 0;
    const ec_stage_id shade = of_light ? EC_SHADE_LIGHT : EC_SHADE;
    EC_TRY(begin_segment(p, bounces, err));
    if (of_light && first == 0) EC_TRY(ec_pipeline_launch(p, EC_EMIT, scalars, err));
    for (uint32_t step = 0; step < bounces; step++) {
        const uint32_t bounce = first + step;
        scalars[EC_ARG_BOUNCE] = bounce | kind;
        scalars[EC_ARG_STEP] = step;
        ec_pipeline_swap_queues(p, bounce);
        EC_TRY(ec_pipeline_trace(p, 0, bounce, scalars, err));
        EC_TRY(ec_pipeline_launch(p, shade, scalars, err));
        if (p->buffers[EC_ARG_PHOTONS]) continue; /* photons make the guide (train.c), and are joined to no camera */
        if (p->params.light_count) EC_TRY(ec_pipeline_trace(p, 1, bounce, scalars, err));
        if (of_light) EC_TRY(ec_pipeline_launch(p, EC_SPLAT, scalars, err));
    }
    return end_segment(p, shade, bounces, traced, err);
}

/* Runs bounces as long as there are paths. How many light paths begin is known only after their first segment. */
static ec_result run_bounces(ec_pipeline *p, uint32_t *scalars, uint32_t kind, ec_error *err)
{
    const bool of_light = kind != 0;
    uint32_t all = 0, traced, bounces;
    for (uint32_t first = 0; (of_light && !first) || (ec_pipeline_total(p->counters.at[0].rays) && first < p->params.max_depth); first += bounces) {
        bounces = segment_length(p, first, p->bounces[of_light]);
        EC_TRY(run_segment(p, scalars, kind, first, bounces, &traced, err));
        all += traced;
    }
    p->bounces[of_light] = all;
    return EC_OK;
}

ec_result ec_integrate_paths(ec_pipeline *p, uint32_t *scalars, ec_error *err)
{
    ec_pipeline_fill_parts(p, scalars[EC_ARG_PATH_COUNT]);
    return run_bounces(p, scalars, 0, err);
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
    const ec_result result = run_bounces(p, scalars, EC_LIGHT_BOUNCE, err);
    p->buffers[EC_ARG_PIXEL_LIST] = list;
    return result;
}

ec_result ec_pipeline_run_edge_rays(ec_pipeline *p, uint32_t seed, uint32_t count, ec_error *err)
{
    uint32_t scalars[EC_ARG_SCALAR_COUNT] = {[EC_ARG_SEED] = seed, [EC_ARG_PATH_COUNT] = count};
    uint32_t traced;
    cl_mem list = p->buffers[EC_ARG_PIXEL_LIST];
    p->buffers[EC_ARG_PIXEL_LIST] = p->buffers[EC_ARG_EDGE_LIST];
    ec_pipeline_swap_queues(p, 0);
    ec_pipeline_fill_parts(p, count);
    ec_result result = ec_pipeline_launch(p, EC_GENERATE, scalars, err);
    if (result == EC_OK) result = begin_segment(p, 1, err);
    if (result == EC_OK) result = ec_pipeline_trace(p, 0, 0, scalars, err);
    if (result == EC_OK) result = ec_pipeline_launch(p, EC_SHADE, scalars, err);
    if (result == EC_OK) result = end_segment(p, EC_SHADE, 1, &traced, err);
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
