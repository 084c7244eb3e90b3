/* Turns placed glTF meshes into the scene's triangles. Inside host/gltf/ only. */
#ifndef EC_GLTF_FLATTEN_H
#define EC_GLTF_FLATTEN_H

#include "gltf/gltf_tree.h"

/* prepare.c: checks every primitive that is placed, and counts what is skipped. */
ec_result ec_flatten_prepare(ec_gltf *gltf, const ec_placement_list *placements, ec_scene *scene, const ec_log *log,
                             ec_error *err);

/* deform.c: replaces meshes that morph targets or a skin move by deformed copies. */
ec_result ec_gltf_deform(ec_gltf *gltf, ec_placement_list *placements, ec_error *err);

/* Fills vertices, triangles, bounds, center and the counters of dropped triangles. Fails if no triangle is left, unless the file intends that
 * (empty.c). */
ec_result ec_flatten(ec_gltf *gltf, const ec_placement_list *placements, ec_scene *scene, const ec_log *log,
                     ec_error *err);

/* motion.c: adds what moves while the shutter is open, by posing the same document at other moments. `base` is the document of the scene; it is left
 * posed at one of them. */
ec_result ec_gltf_move(const ec_scene_choice *choice, ec_gltf *base, ec_scene *scene, const ec_log *log,
                       ec_error *err);

/* materials.c: moves the materials into the scene and gives each drawn primitive its index there. A material is duplicated if some of its meshes lack
 * a texture coordinate set that it uses. */
ec_result ec_gltf_materials_assign(ec_gltf *gltf, ec_scene *scene, const ec_log *log, ec_error *err);

/* textures.c: decodes the images that drawn materials use; a texture without a usable image is left out. */
ec_result ec_gltf_textures_load(ec_gltf *gltf, const ec_placement_list *placements, ec_scene *scene, const ec_log *log,
                                ec_error *err);

/* Decodes one image into *image, which must be zero. On failure returns false, leaves *image zero, and says in err which image failed and why. */
bool ec_gltf_image_load(const ec_gltf *gltf, uint32_t index, ec_image *image, ec_error *err);

/* hide.c: primitives that alpha hides everywhere are not drawn, unless nothing else is. */
ec_result ec_gltf_hide(ec_gltf *gltf, const ec_placement_list *placements, ec_scene *scene, const ec_log *log, ec_error *err);

/* image_light.c: makes the cube of EXT_lights_image_based, if the file has one, the scene's environment. */
ec_result ec_gltf_image_light_load(const ec_gltf *gltf, ec_scene *scene, const ec_log *log, ec_error *err);

/* place_cameras.c */
ec_result ec_gltf_cameras_place(ec_gltf *gltf, const ec_placement_list *placements, ec_scene *scene, const ec_log *log,
                                ec_error *err);
/* place_lights.c */
ec_result ec_gltf_lights_place(const ec_gltf *gltf, const ec_placement_list *placements, ec_scene *scene,
                               const ec_log *log, ec_error *err);

#endif
