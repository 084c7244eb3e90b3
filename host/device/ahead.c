#include "device/ahead.h"

#include "cl/ahead.h"
#include "cl/workarounds.h"
#include "device/pipeline.h"

enum { BVH8_BYTES = 52 }; /* a triangle, about: the BVH is not built yet. A wrong guess costs the time of kernels that are built for nothing. */

void ec_build_ahead(ec_cl *cl, const ec_cargo *cargo, const ec_render_effects *effects, uint32_t width, uint32_t height, uint32_t batch)
{
    const ec_cargo_head *head = &cargo->head;
    ec_pipeline p = {.cl = cl, .integrator = head->integrator, .params = {.width = width, .height = height, .batch = batch},
                     .effects = *effects, .triangle_count = head->triangle_count, .fast_math = head->fast_math};
    ec_compile_job job;
    if (!ec_compiles_late(cl) || ec_pipeline_lanes(cl, head->lanes, &p.lanes, NULL) != EC_OK) return;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        p.accels[a].in_use = head->accels[ec_device_kind_of(&cl->info)] >> a & 1;
        p.accels[a].bytes = (uint64_t)BVH8_BYTES * head->triangle_count;
    }
    ec_pipeline_plan_wave(&p, head->wave);
    const ec_kernel_set set = ec_kernel_set_fast(&p);
    if (ec_kernel_set_job(&p, &set, &job, NULL) == EC_OK) ec_ahead_begin(cl, &job);
    ec_compile_job_free(&job);
}
