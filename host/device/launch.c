/* Binds a stage's arguments from its table entry and enqueues it. */
#include <string.h>

#include "device/pipeline.h"

/* Counts work-items for the whole wave, of which those past the queue's end leave at once: the host need not know the count, PoCL need not compile
 * again for a smaller grid, and several PoCL devices never run one kernel at two sizes, which makes it abort (3.1, pocl_release_dlhandle_cache).
 * Cards get fewer (held_items). */
uint64_t ec_pipeline_items(ec_stage_id id, uint32_t takes, uint32_t wave, uint32_t triangles, uint32_t *rows)
{
    const bool is_of_triangles = id == EC_RASTER_SETUP || id == EC_RASTER_FILL;
    *rows = is_of_triangles ? 1 : EC_PARTS;
    if (is_of_triangles) return triangles > EC_SMALL_LAUNCH ? triangles : EC_SMALL_LAUNCH;
    return (wave / EC_PARTS + takes - 1) / takes;
}

uint32_t ec_local_size(const ec_device_info *device)
{
    return device->type & CL_DEVICE_TYPE_CPU ? EC_LOCAL_SIZE : EC_LOCAL_SIZE_OF_CARDS;
}

/* On cards, launches cover as many entries of each part of the queue as any part may hold: a million work-items without a path take as long as a late
 * bounce's few with one. */
static uint64_t held_items(const ec_pipeline *p, const ec_stage_entry *stage, uint64_t takes, uint64_t items)
{
    if (stage->busy < EC_ARG_SCALAR_COUNT || !p->held || p->cl->info.type & CL_DEVICE_TYPE_CPU) return items;
    const uint64_t most = (p->held + takes - 1) / takes;
    return most < items ? most : items;
}

/* Returns how many work-items carry so many paths, pixels or triangles. */
static uint64_t work_items(const ec_pipeline *p, const ec_stage_entry *stage, uint64_t count)
{
    return count / (stage->lanes == 1 ? 1 : p->kernels.lanes);
}

void ec_pipeline_busy(ec_pipeline *p, ec_stage_id id, const uint32_t *parts)
{
    ec_cl_busy(p->cl, ec_stages[id].label, work_items(p, &ec_stages[id], ec_pipeline_total(parts)));
}

/* Sets the arguments that have changed since this kernel's last launch. */
static ec_result bind(ec_pipeline *p, const ec_stage_entry *stage, ec_bound_kernel *bound, const uint32_t *scalars, ec_error *err)
{
    const bool is_fresh = bound->release != p->cl->releases;
    for (uint32_t i = 0; i < stage->argument_count; i++) {
        const ec_arg arg = stage->arguments[i];
        const bool is_scalar = arg < EC_ARG_SCALAR_COUNT;
        const uint64_t value = is_scalar ? scalars[arg] : (uint64_t)(uintptr_t)p->buffers[arg];
        if (!is_fresh && bound->arguments[i] == value) continue;
        const cl_int code = is_scalar ? clSetKernelArg(bound->kernel, i, sizeof(cl_uint), &scalars[arg])
                                      : clSetKernelArg(bound->kernel, i, sizeof(cl_mem), p->buffers[arg] ? &p->buffers[arg] : NULL);
        bound->release = 0;
        EC_TRY(ec_cl_check(code, "clSetKernelArg", stage->label, err));
        bound->arguments[i] = value;
    }
    bound->release = p->cl->releases;
    return EC_OK;
}

static ec_result launch(ec_pipeline *p, ec_stage_id id, ec_bound_kernel *bound, const uint32_t *scalars, ec_error *err)
{
    const ec_stage_entry *stage = &ec_stages[id];
    const cl_kernel kernel = bound->kernel;
    EC_TRY(bind(p, stage, bound, scalars, err));
    uint32_t rows;
    const uint64_t items = ec_pipeline_items(id, bound->takes, p->wave, scalars[EC_ARG_TRIANGLE_COUNT], &rows);
    if (stage->busy < EC_ARG_SCALAR_COUNT) ec_cl_busy(p->cl, stage->label, work_items(p, stage, scalars[stage->busy]));
    return ec_kernel_run_rows(p->cl, stage->label, kernel, held_items(p, stage, bound->takes, items), rows, ec_local_size(&p->cl->info), err);
}

ec_result ec_pipeline_launch(ec_pipeline *p, ec_stage_id id, const uint32_t *scalars, ec_error *err)
{
    return launch(p, id, &p->kernels.stages[id], scalars, err);
}

ec_result ec_pipeline_launch_trace(ec_pipeline *p, int connect, uint32_t accel, const uint32_t *scalars, ec_error *err)
{
    memcpy(&p->buffers[EC_ARG_ACCEL], p->accels[accel].buffers, sizeof p->accels[accel].buffers);
    return launch(p, connect ? EC_CONNECT : EC_INTERSECT, &p->kernels.traverse[accel][connect], scalars, err);
}
