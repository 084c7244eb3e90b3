/* A ground that shows only the shadows on it, after Debevec 1998 ("Rendering synthetic objects into real scenes", differential rendering): the ratio
 * of the light on the ground with the scene above it and without. */
#ifndef EC_JOBS_SHADOW_H
#define EC_JOBS_SHADOW_H

#include "render/render.h"

/* Fails if no light of the scene can cast such a shadow: environment and lamps do, emissive surfaces do not. */
ec_result ec_shadow_check(const ec_scene *scene, ec_error *err);

/* Renders both with the options' seed and `spp` samples per pixel, and replaces the alpha of `film` by 1 minus their ratio where that is larger. The
 * same samples meet the ground in both, so that the ratio is exactly 1 where nothing is in the way. *error: root mean square, over the ground's
 * pixels, of the standard error of that ratio, from the spread of its replicates; NaN: the camera sees no ground. A failure leaves the film
 * unchanged; go_on returning false is one. */
ec_result ec_shadow_cast(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, uint32_t spp, ec_progress_fn go_on, void *user, ec_film *film,
                         double *error, const ec_log *log, ec_error *err);

#endif
