/* The kernels a scene calls for, each built with the features that can change its code and no others. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "device/pipeline.h"

static bool is_needed(const ec_pipeline *p, ec_stage_id id)
{
    if (ec_stages[id].lanes == EC_LANES_OF_ACCEL) return false; /* there is one for each accelerator: see below */
    return ec_stages[id].integrators >> p->integrator & 1;
}

static uint32_t lanes_of(const ec_pipeline *p, uint32_t lanes) { return lanes == EC_LANES_OF_PIPELINE ? p->lanes : lanes; }

const char *ec_traversal_options(const ec_device_info *device, uint32_t accel, uint64_t bytes, uint64_t features)
{
    bool is_large = device->type & CL_DEVICE_TYPE_CPU && bytes > device->cache_bytes;
    bool is_known = !(features & (EC_FEATURE_PANES | EC_FEATURE_MOTION)); /* to trace_interleaved.h */
    return accel == ec_accel_find("bvh8") && is_large && is_known ? " -DINTERLEAVE=8" : "";
}

static uint64_t accel_bytes(const ec_pipeline *p, uint32_t accel)
{
    uint64_t sum = 0;
    for (uint32_t k = 0; k < EC_ACCEL_BUFFERS; k++) {
        size_t size = 0;
        if (p->accels[accel].buffers[k]) clGetMemObjectInfo(p->accels[accel].buffers[k], CL_MEM_SIZE, sizeof size, &size, NULL);
        sum += size;
    }
    return sum;
}

/* One program for all stages of a lane width: each parse of the shared headers costs as much as compiling a stage. */
static ec_result build_width(ec_pipeline *p, uint32_t lanes, cl_program *program, ec_error *err)
{
    const char *names[EC_STAGE_ID_COUNT + EC_ACCEL_COUNT + 1] = {NULL};
    char traversals[EC_ACCEL_COUNT][32];
    uint64_t features = 0;
    uint32_t count = 0;
    const char *traversal = "";
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++) {
        if (!is_needed(p, (ec_stage_id)id) || lanes_of(p, ec_stages[id].lanes) != lanes) continue;
        names[count++] = ec_stages[id].source;
        features |= ec_stage_features(&ec_stages[id], p->effects.built);
    }
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        if (!p->accels[a].in_use || lanes_of(p, ec_accels[a].lanes) != lanes) continue;
        snprintf(traversals[a], sizeof traversals[a], "traverse_%s", ec_accels[a].name);
        names[count++] = traversals[a];
        features |= ec_stage_features(&ec_stages[EC_INTERSECT], p->effects.built) |
                    ec_stage_features(&ec_stages[EC_CONNECT], p->effects.built);
        const char *own = ec_traversal_options(&p->cl->info, a, accel_bytes(p, a), p->effects.built);
        if (*own) traversal = own;
    }
    char options[128], label[32], *source;
    snprintf(options, sizeof options, "-DLANES=%u -DFEATURES=0x%" PRIx64 "ul%s%s", lanes, features, traversal,
             p->fast_math ? " " EC_FAST_MATH : "");
    snprintf(label, sizeof label, "lanes%u%s", lanes, p->fast_math ? "_fast" : "");
    EC_TRY(ec_kernel_sources_join(names, &source, err));
    ec_result result = ec_program_build(p->cl, label, source, options, program, err);
    free(source);
    return result;
}

/* accel: the name of one, or NULL where the stage has nothing to do with them. */
static ec_result build_kernel(ec_pipeline *p, const char *source, const char *accel, uint32_t lanes, cl_kernel *kernel,
                              ec_error *err)
{
    char name[64];
    snprintf(name, sizeof name, "ec_%s%s%s", source, accel ? "_" : "", accel ? accel : "");
    cl_program *program = &p->programs[lanes];
    if (!*program) EC_TRY(build_width(p, lanes, program, err));
    return ec_kernel_create(*program, name, kernel, err);
}

ec_result ec_pipeline_build(ec_pipeline *p, ec_error *err)
{
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++) {
        const ec_stage_entry *stage = &ec_stages[id];
        if (is_needed(p, (ec_stage_id)id))
            EC_TRY(build_kernel(p, stage->source, NULL, lanes_of(p, stage->lanes), &p->kernels[id], err));
    }
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        for (int connect = 0; p->accels[a].in_use && connect < 2; connect++)
            EC_TRY(build_kernel(p, ec_stages[connect ? EC_CONNECT : EC_INTERSECT].source, ec_accels[a].name,
                                lanes_of(p, ec_accels[a].lanes), &p->accels[a].kernels[connect], err));
    return EC_OK;
}
