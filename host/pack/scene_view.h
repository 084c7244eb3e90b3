/* A scene with materials and lights of its own. It shares all else with the scene it was made of, and is valid as long as that is. */
#ifndef EC_PACK_SCENE_VIEW_H
#define EC_PACK_SCENE_VIEW_H

#include "scene/scene.h"

typedef struct ec_scene_view {
    ec_scene scene;          /* its materials and lights are owned; their names are not */
    uint32_t first_white; /* 0: no image is; else those from here on are owned, and the lists of images and textures */
} ec_scene_view;

ec_result ec_scene_view_make(const ec_scene *scene, ec_scene_view *view, ec_error *err);
void ec_scene_view_free(ec_scene_view *view); /* zero-initialised is fine */
/* The texture is replaced by one of the same alpha whose colours are white. */
ec_result ec_scene_view_whiten(ec_scene_view *view, int32_t *texture, ec_error *err);

/* plain.c: the same picture with less in it. Constant textures go into their factors; what an effect of no weight has is dropped, what
 * no triangle shows, what coverage hides everywhere, lights of no power, maps of one radiance. The scan looks at this. */
ec_result ec_scene_view_plain(const ec_scene *scene, ec_scene_view *view, ec_error *err);

/* without.c: with effects (EC_FEATURE_*) switched off on purpose, in one material or all. Textures become their means;
 * the alpha of a base colour that covers stays. */
#define EC_ALL_MATERIALS (-1)
ec_result ec_scene_view_without(const ec_scene *scene, uint64_t off, int64_t material, ec_scene_view *view, ec_error *err);
extern const uint64_t ec_effects_optional; /* those that can be */

#endif
