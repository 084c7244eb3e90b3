/* Sets up a render on one device from a payload, and tears it down. */
#include "device/pipeline.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "device/help.h"
#include "device/tiers.h"

ec_result ec_pipeline_create(ec_cl *cl, const ec_payload *payload, ec_payload *spent, ec_pipeline *p, ec_render_stats *stats,
                             ec_error *err)
{
    const ec_payload_head *head = &payload->head;
    memset(p, 0, sizeof *p);
    p->cl = cl;
    p->compiler.report = -1;
    p->integrator = head->integrator;
    p->params = head->params;
    p->effects = head->effects;
    p->triangle_count = head->triangle_count;
    p->fast_math = head->fast_math;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) p->accels[a].in_use = head->accels[ec_device_kind_of(&cl->info)] >> a & 1;
    EC_TRY(ec_pipeline_lanes(cl, head->lanes, &p->lanes, err));
    double start = ec_now();
    uint64_t uploaded = cl->uploaded_bytes, found = cl->found_bytes;
    uint32_t programs = cl->programs_found;
    ec_result result = ec_pipeline_upload(p, payload, spent, err);
    if (result == EC_OK) result = ec_pipeline_create_queues(p, head->wave, err);
    stats->pack_seconds += ec_now() - start;
    if (result != EC_OK) return result;
    start = ec_now();
    result = ec_tiers_begin(p, head, err);
    stats->kernel_seconds = ec_now() - start;
    if (result == EC_OK) result = ec_pipeline_train(p, &stats->guide_seconds, err);
    for (int i = 0; i <= EC_LANES_MOST; i++) stats->programs_built += p->kernels.programs[i] != NULL;
    stats->programs_found = cl->programs_found - programs;
    stats->programs_built -= stats->programs_found;
    stats->bytes_uploaded = cl->uploaded_bytes - uploaded;
    stats->bytes_found = cl->found_bytes - found;
    stats->lanes = p->lanes;
    stats->wave = p->room;
    return result;
}

ec_result ec_pipeline_read_invalid(ec_pipeline *p, uint32_t counts[EC_STAGE_COUNT], ec_error *err)
{
    return ec_buffer_read(p->cl, p->buffers[EC_ARG_INVALID], 0, EC_STAGE_COUNT * sizeof *counts, counts, err);
}

void ec_pipeline_destroy(ec_pipeline *p)
{
    if (!p->cl) return;
    clFinish(p->cl->queue); /* after an error counters may still be on their way, and the next pipeline sends its own */
    ec_kernel_set_release(&p->kernels);
    ec_help_end(p);
    ec_compiler_leave(&p->compiler);
    for (int a = 0; a < EC_ACCEL_COUNT; a++)
        for (int k = 0; k < EC_ACCEL_BUFFERS; k++) ec_buffer_release(p->cl, &p->accels[a].buffers[k]);
    p->buffers[EC_ARG_PATHS] = p->buffers[EC_ARG_NEXT] = NULL; /* views of path_queues, as these of accels */
    memset(&p->buffers[EC_ARG_ACCEL], 0, EC_ACCEL_BUFFERS * sizeof *p->buffers);
    for (int i = 0; i < EC_ARG_COUNT; i++) ec_buffer_release(p->cl, &p->buffers[i]);
    for (int i = 0; i < 2; i++) ec_buffer_release(p->cl, &p->path_queues[i]);
    free(p->guide);
    free(p->edges.marks);
    free(p->edges.list);
    memset(p, 0, sizeof *p);
}
