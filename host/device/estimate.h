/* Estimates the memory that a scene takes on a device, before there is one. */
#ifndef EC_DEVICE_ESTIMATE_H
#define EC_DEVICE_ESTIMATE_H

#include "device/effects.h"
#include "device/options.h"
#include "scene/scene.h"

/* Estimates how many bytes of device memory the scene itself takes (geometry, BVH of ref_count references, textures, lights), and what a render makes
 * of its effects. For `eclat info`. */
ec_result ec_scene_estimate(const ec_scene *scene, const ec_render_options *options, uint32_t ref_count, uint64_t *device_bytes,
                            ec_render_effects *effects, ec_error *err);

#endif
