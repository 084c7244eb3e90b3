/* Options of `eclat render` with setters of their own (jobs/option.h), and the words that some of them take. */
#ifndef EC_JOBS_RENDER_SETTERS_H
#define EC_JOBS_RENDER_SETTERS_H

#include "jobs/option.h"

extern const char *const ec_ground_names[];
extern const char *const ec_adaptive_names[]; /* ec_adaptive */
extern const char *const ec_png_depths[];     /* 8, 16 */
extern const char *const ec_effects_names[];  /* those of the scene, or all */

ec_option_setter ec_set_adaptive, ec_set_at, ec_set_background, ec_set_channels, ec_set_denoise, ec_set_effects, ec_set_ground, ec_set_fov,
    ec_set_frames, ec_set_grid_density, ec_set_light_paths, ec_set_max_depth,
    ec_set_parallel, ec_set_fog, ec_set_screen_window, ec_set_plan, ec_set_rr, ec_set_samples, ec_set_seed, ec_set_shard, ec_set_shutter, ec_set_up, ec_set_without;

#endif
