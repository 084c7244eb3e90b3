/* Small renders for cases: those of the self-test, and proofs in tests/robust. */
#ifndef EC_SELFTEST_SHOT_H
#define EC_SELFTEST_SHOT_H

#include "render/render.h"
#include "selftest/cases.h"

typedef struct ec_shot {
    ec_film film;
    ec_render_stats stats;
    float *rgb;            /* 3 floats per pixel */
    double mean, noise;    /* mean of green over all pixels; its standard error */
} ec_shot;
void ec_shot_free(ec_shot *shot); /* zero-initialised is fine */

/* Returns options for size x size pixels, unlimited depth, Sobol, MIS and seed 0, with the kernels that most cases need: one build serves all these
 * scenes. */
ec_render_options ec_shot_options(const ec_selftest *t, uint32_t size, uint32_t spp);

/* Renders a shot. Samples that are not finite make the mean NaN, with which no row passes. */
ec_result ec_shot_take(ec_selftest *t, const ec_scene *scene, const ec_render_options *options, ec_shot *shot, ec_error *err);

/* Adds a row with the mean of a picture whose radiance is known. It passes within four standard errors (one seed in 16 000 is further off, and seeds
 * are fixed), at most 2 %, plus 1e-5 for rounding: some hundred operations of 2^-24 each. */
ec_result ec_shot_row(ec_selftest *t, const char *what, const ec_scene *scene, const ec_render_options *options, double expected,
                      ec_error *err);
#define EC_SHOT_ROUNDING 1e-5
/* Adds such a row, and frees the scene. */
ec_result ec_shot_only_row(ec_selftest *t, const char *what, ec_scene *scene, const ec_render_options *options, double expected,
                           ec_error *err);

/* Makes a white floor, seen from above. */
ec_result ec_shot_floor(ec_scene **scene, ec_error *err);
/* Makes a camera that sees only a lamp of radiance 0.1. */
ec_result ec_shot_lamp(ec_scene **scene, ec_error *err);
/* Makes a camera in a box of one emitting Lambertian material, which sees the same everywhere: segment k adds albedo^(k - 1). */
ec_result ec_shot_box(double albedo, ec_scene **scene, ec_error *err);

#endif
