/* Small renders for cases: those of the self-test, and proofs in tests/robust. */
#ifndef EC_SELFTEST_SHOT_H
#define EC_SELFTEST_SHOT_H

#include "render/render.h"
#include "selftest/cases.h"

typedef struct ec_shot {
    ec_film film;
    ec_render_stats stats;
    float *rgb;            /* 3 a pixel */
    double mean, noise;    /* of green over all pixels, and its standard error */
} ec_shot;
void ec_shot_free(ec_shot *shot); /* zero-initialised is fine */

/* size x size pixels, unlimited depth, Sobol, MIS, seed 0. Kernels for what most cases call for: one build for all these scenes. */
ec_render_options ec_shot_options(const ec_selftest *t, uint32_t size, uint32_t spp);

/* Samples that are not finite make the mean NaN: no row passes with it. */
ec_result ec_shot_take(ec_selftest *t, const ec_scene *scene, const ec_render_options *options, ec_shot *shot, ec_error *err);

/* A row: the mean of a picture whose radiance is known. Passes within four standard errors (a seed in 16 000 is further off, and
 * seeds are fixed), at most 2 %, and 1e-5 for rounding: some hundred operations of 2^-24 each. */
ec_result ec_shot_row(ec_selftest *t, const char *what, const ec_scene *scene, const ec_render_options *options, double expected,
                      ec_error *err);
#define EC_SHOT_ROUNDING 1e-5
/* A row, and ends the scene. */
ec_result ec_shot_only_row(ec_selftest *t, const char *what, ec_scene *scene, const ec_render_options *options, double expected,
                           ec_error *err);

/* A white floor, seen from above. */
ec_result ec_shot_floor(ec_scene **scene, ec_error *err);
/* A camera that sees nothing but a lamp of radiance 0.1. */
ec_result ec_shot_lamp(ec_scene **scene, ec_error *err);
/* A camera in a box of one emitting Lambert material sees the same everywhere: segment k adds albedo^(k - 1). */
ec_result ec_shot_box(double albedo, ec_scene **scene, ec_error *err);

#endif
