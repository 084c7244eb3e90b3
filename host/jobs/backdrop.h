/* Makes the blurred environment that --background blur puts behind the surfaces of a picture. */
#ifndef EC_JOBS_BACKDROP_H
#define EC_JOBS_BACKDROP_H

#include "image/screen.h"
#include "render/render.h"

/* Blurs the environment by `degrees`, as seen by the camera options->camera, for one that moves in the middle of the exposure. behind->rgb is
 * malloc'ed. */
ec_result ec_backdrop_make(const ec_scene *scene, const ec_render_options *options, double degrees, ec_behind *behind, ec_error *err);

#endif
