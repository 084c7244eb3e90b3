/* Which options make sense together. */
#ifndef EC_JOBS_COMBINATIONS_H
#define EC_JOBS_COMBINATIONS_H

#include "jobs/option.h"
#include "render/render.h"

/* given[i]: options[i] was on the command line. EC_USAGE, and one line that says what belongs together, where it does not. */
ec_result ec_combinations_check(const ec_option *options, int count, const bool *given, const ec_render_options *asked,
                                ec_error *err);

/* Does an option of `render` mean anything to that integrator? */
bool ec_combinations_belongs(const char *option, ec_integrator integrator);

/* Checks a grid's density (0: not given) and the acceleration structure asked for, which may be NULL. takes_all: "all" is one. */
ec_result ec_combinations_check_grid(double density, const char *accel, bool takes_all, ec_error *err);

/* A moment or a span of them. */
ec_result ec_combinations_check_shutter(const ec_scene_choice *choice, ec_error *err);

#endif
