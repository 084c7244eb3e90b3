/* A scene with materials and lights of its own. It shares everything else with the scene it was made of, and is valid as long as that one. */
#ifndef EC_PACK_SCENE_VIEW_H
#define EC_PACK_SCENE_VIEW_H

#include "scene/scene.h"

typedef struct ec_scene_view {
    ec_scene scene;          /* owns its materials and lights, but not their names */
    uint32_t first_white; /* 0: no images are owned; otherwise those from here on are, and the lists of images and textures */
} ec_scene_view;

ec_result ec_scene_view_make(const ec_scene *scene, ec_scene_view *view, ec_error *err);
void ec_scene_view_free(ec_scene_view *view); /* zero-initialised is fine */
/* Replaces the texture by one with the same alpha and white colours. */
ec_result ec_scene_view_whiten(ec_scene_view *view, int32_t *texture, ec_error *err);

/* plain.c: makes a view that gives the same picture with less in it. Constant textures go into their factors. Dropped are effects without weight,
 * materials that no triangle shows, what coverage hides everywhere, lights without power, and maps of one radiance. The scan for effects uses this
 * view. */
ec_result ec_scene_view_plain(const ec_scene *scene, ec_scene_view *view, ec_error *err);

/* without.c: makes a view with effects (EC_FEATURE_*) switched off on purpose, in one material or all. Textures become their means; the alpha of a
 * base colour that covers is kept. */
#define EC_ALL_MATERIALS (-1)
ec_result ec_scene_view_without(const ec_scene *scene, uint64_t off, int64_t material, ec_scene_view *view, ec_error *err);
extern const uint64_t ec_effects_optional; /* those that can be switched off */

#endif
