/* Makes rays that leave a tracer's hits in the paths' directions, as the shading stages do. */
#ifndef EC_TESTS_ROBUST_LEAVE_H
#define EC_TESTS_ROBUST_LEAVE_H

#include <string.h>

#include "kernel/kernel_run.h"
#include "robust/leave_fields.h"
#include "selftest/tracer.h"
#include "shared/scene_buffers.h"

static float leave_results[EC_LEAVE_FIELDS * EC_TRACER_RAYS]; /* indexed by ec_leave_field */

static inline float left(int field, uint32_t i) { return leave_results[(size_t)field * EC_TRACER_RAYS + i]; }

static inline void set_hit(ec_tracer *r, uint32_t i, uint32_t prim, double b1, double b2)
{
    memcpy(&r->hits[i], &prim, sizeof prim);
    r->hits[EC_HIT_B1 * EC_TRACER_RAYS + i] = (float)b1;
    r->hits[EC_HIT_B2 * EC_TRACER_RAYS + i] = (float)b2;
}

/* Builds the program once; it stays until the process ends. */
static inline ec_result leave_program(ec_tracer *r, cl_program *program, ec_error *err)
{
    static cl_program built;
    char options[32], *source = built ? NULL : kernel_flatten("robust/leave.cl");
    snprintf(options, sizeof options, "-DLANES=%u", r->t->lanes);
    ec_result result = built || source ? EC_OK : ec_fail(err, "robust/leave.cl cannot be flattened");
    if (source) result = ec_program_build(r->t->cl, "leave", source, options, &built, err);
    free(source);
    *program = built;
    return result;
}

/* Sets the origins of paths that leave the hits in their directions. */
static inline ec_result leave_hits(ec_tracer *r, ec_error *err)
{
    const uint32_t wave = EC_TRACER_RAYS, count = r->soup->count;
    cl_program program;
    EC_TRY(leave_program(r, &program, err));
    float *prims = calloc((size_t)EC_PRIM_WORDS * count + 1, sizeof *prims); /* in the layout of the shading kernels */
    if (!prims) return ec_fail(err, "out of memory for %u triangles", count);
    for (size_t i = 0; i < 3 * (size_t)count; i++) memcpy(prims + 4 * i, r->soup->vertices + 3 * i, 3 * sizeof *prims);
    const ec_array arrays[] = {EC_SCALAR(wave), EC_SCALAR(r->largest), EC_IN(prims, EC_PRIM_WORDS * (size_t)count),
                               EC_IN(r->hits, EC_HIT_FIELDS * wave), EC_OUT(r->paths, EC_PATH_FIELDS * wave),
                               EC_OUT(leave_results, EC_LEAVE_FIELDS * wave)};
    ec_result result = ec_kernel_call(r->t->cl, program, "leave", wave / r->t->lanes, 64, arrays, sizeof arrays / sizeof *arrays, err);
    free(prims);
    return result;
}

#endif
