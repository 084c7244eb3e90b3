/* A ground that is not seen but for the shadows on it, after Debevec 1998 ("Rendering synthetic objects into real scenes", differential rendering):
 * the light on a ground with the scene above it, over that without. */
#ifndef EC_JOBS_SHADOW_H
#define EC_JOBS_SHADOW_H

#include "render/render.h"

/* Fails where no light of the scene's can cast a shadow: environment and lamps do, surfaces that glow do not. */
ec_result ec_shadow_check(const ec_scene *scene, ec_error *err);

/* Renders both with the options' seed and `spp` samples a pixel, and puts 1 minus their ratio in place of the alpha of `film`, where it is larger.
 * Same samples meet the ground in both, so that the ratio is 1 to the bit where nothing is in the way. *error: root mean square over the ground's pixels
 * of the standard error of that ratio, by the spread of its replicates; NaN: the camera sees no ground. The film stays as it was on failure, and where
 * go_on says no, which is one. */
ec_result ec_shadow_cast(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t spp, ec_progress_fn go_on, void *user, ec_film *film,
                         double *error, const ec_log *log, ec_error *err);

#endif
