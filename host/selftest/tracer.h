/* Traces rays with the kernels of every accelerator, without the stages around them. Inside host/selftest only. */
#ifndef EC_SELFTEST_TRACER_H
#define EC_SELFTEST_TRACER_H

#include "accel/accel.h"
#include "selftest/cases.h"
#include "selftest/soup.h"
#include "shared/path_state.h"

/* Rays of one run: a single number, below PoCL's 65536, so that each kernel is compiled once. */
#define EC_TRACER_RAYS 32768u

typedef struct ec_tracer {
    ec_selftest *t;
    uint32_t used;         /* bit by accelerator: all of them or, without --full, those that renders choose by themselves */
    uint32_t lanes[EC_ACCEL_COUNT];
    cl_program programs[EC_ACCEL_COUNT];
    const ec_soup *soup;
    float largest;         /* largest |coordinate| of the soup */
    ec_accel accels[EC_ACCEL_COUNT];
    float *paths;          /* ec_path_field */
    float *hits;           /* ec_hit_field, including those of PROBE */
} ec_tracer;

/* Returns the tracer of this self-test, made when first asked for. */
ec_result ec_tracer_of(ec_selftest *t, ec_tracer **tracer, ec_error *err);
void ec_tracer_close(ec_tracer *tracer); /* NULL is fine */

/* Builds the accelerators in use over the soup, which must remain; the one that tests every triangle only if that is fast. */
ec_result ec_tracer_build(ec_tracer *tracer, const ec_soup *soup, ec_error *err);
bool ec_tracer_has(const ec_tracer *tracer, uint32_t accel);

void ec_tracer_ray(ec_tracer *tracer, uint32_t i, const float o[3], const float d[3], uint32_t skip);
void ec_tracer_given(const ec_tracer *tracer, uint32_t i, float o[3], float d[3]);
/* Traces the first `count` paths to their closest hits. */
ec_result ec_tracer_trace(ec_tracer *tracer, uint32_t accel, uint32_t count, ec_error *err);
/* Traces with one accelerator after the other: for (uint32_t a = 0; ec_tracer_next(r, &a, count, &result, err); a++). Skips those that are not built,
 * and ends when *result is not EC_OK. */
bool ec_tracer_next(ec_tracer *tracer, uint32_t *accel, uint32_t count, ec_result *result, ec_error *err);
typedef struct ec_traced {
    uint32_t prim;         /* EC_NO_ID: none */
    float b1, b2, t;
} ec_traced;
ec_traced ec_tracer_hit(const ec_tracer *tracer, uint32_t i);
static inline const float *ec_tracer_triangle(const ec_tracer *tracer, uint32_t prim)
{
    return tracer->soup->vertices + 9 * (size_t)prim;
}
/* rays_closed.c: makes rays from within a ball at a vertex, at a point of an edge, or at any point; a third begin just below a point of the same
 * triangle. Some are along an axis, with components of 0 and -0. */
void ec_rays_within(ec_tracer *tracer, uint64_t *random, const double centre[3], const double stretch[3]);

/* Computes the direction from `from` to `to`, normalised in float like those of the shading stages. */
void ec_float_direction(const double from[3], const double to[3], float d[3]);

#endif
