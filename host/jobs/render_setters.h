/* How each option of `eclat render` is stored in an ec_render_request, and the words that some of them take. */
#ifndef EC_JOBS_RENDER_SETTERS_H
#define EC_JOBS_RENDER_SETTERS_H

#include "jobs/option.h"

extern const char *const ec_adaptive_names[]; /* ec_adaptive */
extern const char *const ec_effects_names[];  /* the scene's, all */

typedef ec_result ec_setter(void *target, const char *option, const char *value, ec_error *err);

/* set_picture.c */
ec_setter ec_set_scene, ec_set_variant, ec_set_animation, ec_set_at, ec_set_shutter, ec_set_env, ec_set_env_rotate,
    ec_set_env_strength, ec_set_camera, ec_set_eye, ec_set_look_at, ec_set_up, ec_set_fov, ec_set_parallel, ec_set_focus,
    ec_set_fstop, ec_set_filter, ec_set_filter_width, ec_set_tonemap, ec_set_exposure, ec_set_output, ec_set_size;

/* set_job.c */
ec_setter ec_set_adaptive, ec_set_error, ec_set_every, ec_set_time, ec_set_fps, ec_set_spp, ec_set_overwrite, ec_set_resume,
    ec_set_json, ec_set_quiet, ec_set_verbose, ec_set_frames, ec_set_checkpoint, ec_set_plan, ec_set_samples;

/* set_method.c */
ec_setter ec_set_instancing, ec_set_integrator, ec_set_light_choice, ec_set_sample, ec_set_sampler, ec_set_scattering,
    ec_set_terminator, ec_set_compile, ec_set_device, ec_set_lanes, ec_set_memory, ec_set_clamp, ec_set_cutoff, ec_set_replicates, ec_set_wave,
    ec_set_accel, ec_set_grid_density, ec_set_max_depth, ec_set_rr, ec_set_seed, ec_set_effects, ec_set_without;

#endif
