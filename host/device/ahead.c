#include "device/ahead.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cl/ahead.h"
#include "cl/notes.h"
#include "cl/workarounds.h"
#include "device/pipeline.h"

enum { BVH8_BYTES = 52 }; /* about, for a triangle: the BVH is not built yet. A wrong guess costs the time of kernels that are built for nothing. */

static bool begin(ec_cl *cl, const ec_build_plan *plan)
{
    ec_pipeline p = {.cl = cl, .integrator = (ec_integrator)plan->integrator, .params = {.width = plan->width, .height = plan->height, .batch = plan->batch},
                     .triangle_count = plan->triangles, .fast_math = plan->fast_math};
    p.effects.called.bits = plan->called, p.effects.built = plan->built, p.effects.without = plan->without, p.effects.never = plan->never;
    p.effects.launched = plan->launched;
    ec_compile_job job;
    if (!ec_compiles_late(&cl->info) || ec_pipeline_lanes(cl, plan->lanes, &p.lanes, NULL) != EC_OK) return false;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        p.accels[a].in_use = plan->accels >> a & 1;
        p.accels[a].bytes = (uint64_t)BVH8_BYTES * plan->triangles;
    }
    ec_pipeline_plan_wave(&p, plan->wave);
    const ec_kernel_set set = ec_kernel_set_fast(&p);
    const bool is_made = ec_kernel_set_job(&p, &set, &job, NULL) == EC_OK;
    if (is_made) ec_ahead_begin(cl, &job);
    ec_compile_job_free(&job);
    return is_made;
}

static bool is_sound(const ec_build_plan *plan)
{
    return plan->integrator < EC_INTEGRATOR_COUNT && plan->width && plan->height && plan->batch && plan->triangles && plan->lanes <= EC_LANES_MOST;
}

void ec_last_build_begin(ec_last_build *r, ec_cl *cl, const char *scene, uint32_t integrator)
{
    char *path = realpath(scene, NULL);
    snprintf(r->name, sizeof r->name, "plan 1, integrator %u, %s", integrator, path ? path : scene);
    free(path);
    cl->last_build = r;
    r->is_begun = ec_notes_read(cl, r->name, &r->plan, sizeof r->plan) && is_sound(&r->plan) && begin(cl, &r->plan);
}

void ec_build_ahead(ec_cl *cl, const ec_payload *payload, const ec_render_effects *effects, uint32_t width, uint32_t height, uint32_t batch)
{
    const ec_payload_head *head = &payload->head;
    const ec_last_build *last_build = cl->last_build;
    ec_build_plan plan;
    memset(&plan, 0, sizeof plan);
    plan.built = effects->built, plan.called = effects->called.bits, plan.without = effects->without, plan.never = effects->never;
    plan.launched = effects->launched;
    plan.integrator = head->integrator, plan.fast_math = head->fast_math;
    plan.lanes = head->lanes, plan.wave = head->wave;
    plan.width = width, plan.height = height, plan.batch = batch;
    plan.triangles = head->triangle_count, plan.accels = head->accels[ec_device_kind_of(&cl->info)];
    cl->last_build = NULL; /* for the first picture only */
    if (last_build && last_build->is_begun && !memcmp(&last_build->plan, &plan, sizeof plan)) return;
    if (begin(cl, &plan) && last_build) ec_notes_write(cl, last_build->name, &plan, sizeof plan);
}
