/* Moves textures into the factors that they multiply. */
#ifndef EC_PACK_TEXTURE_FOLD_H
#define EC_PACK_TEXTURE_FOLD_H

#include "scene/scene.h"

/* Removes the texture in a slot if all of it that matters has one value, which changes nothing but speed. */
void ec_texture_fold(const ec_scene *scene, ec_material *m, int slot);
/* Replaces the colours in a slot by their mean; the texture stays, for its alpha. */
void ec_texture_flatten_color(const ec_scene *scene, ec_material *m, int slot);
/* Replaces a texture by its mean. One that multiplies nothing, such as a normal map, is dropped. */
void ec_texture_flatten(const ec_scene *scene, ec_material *m, int slot);

#endif
