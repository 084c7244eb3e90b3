/* The blurred environment that --background blur puts behind the surfaces of a picture. */
#ifndef EC_JOBS_BACKDROP_H
#define EC_JOBS_BACKDROP_H

#include "image/screen.h"
#include "render/render.h"

/* As the options' camera of the scene sees it; behind->rgb is malloc'ed. A camera that moves stands in the middle of its way. */
ec_result ec_backdrop_make(const ec_scene *scene, const ec_render_options *options, double degrees, ec_behind *behind, ec_error *err);

#endif
