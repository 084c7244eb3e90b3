/* The camera as options set it. */
#ifndef EC_DEVICE_CAMERA_H
#define EC_DEVICE_CAMERA_H

#include "device/options.h"
#include "scene/scene.h"

/* Sets half the picture's width and height, in the plane at distance 1 or, for an orthographic camera, in its own units; with a screen window, those
 * of the square that it is given in units of. */
void ec_camera_half_sizes(const ec_camera *camera, const ec_render_options *options, double half[2]);

#endif
