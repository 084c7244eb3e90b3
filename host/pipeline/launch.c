/* Binds a stage's arguments from its table entry and enqueues it. */
#include "pipeline/pipeline.h"

ec_result ec_pipeline_launch(ec_pipeline *p, ec_stage_id id, const uint32_t *scalars, uint64_t items, ec_error *err)
{
    const ec_stage_entry *stage = &ec_stages[id];
    for (uint32_t i = 0; i < stage->argument_count; i++) {
        ec_arg arg = stage->arguments[i];
        cl_int code = arg < EC_ARG_SCALAR_COUNT
                          ? clSetKernelArg(p->kernels[id], i, sizeof(cl_uint), &scalars[arg])
                          : clSetKernelArg(p->kernels[id], i, sizeof(cl_mem), p->buffers[arg] ? &p->buffers[arg] : NULL);
        EC_TRY(ec_cl_check(code, "clSetKernelArg", stage->label, err));
    }
    bool is_per_ray = id == EC_INTERSECT_BVH8 || id == EC_CONNECT_BVH8 || stage->lanes == 1;
    uint64_t global = is_per_ray ? items : (items + p->lanes - 1) / p->lanes;
    return ec_kernel_run(p->cl, stage->label, p->kernels[id], global, EC_LOCAL_SIZE, err);
}
