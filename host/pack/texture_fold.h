/* Textures put into the factors that they multiply. */
#ifndef EC_PACK_TEXTURE_FOLD_H
#define EC_PACK_TEXTURE_FOLD_H

#include "scene/scene.h"

/* The texture in a slot, where all of it that counts is one value: then nothing changes but speed. */
void ec_texture_fold(const ec_scene *scene, ec_material *m, int slot);
/* The colours in a slot whatever they are, by their mean; the texture stays, for what its alpha says. */
void ec_texture_flatten_color(const ec_scene *scene, ec_material *m, int slot);
/* All of it whatever it holds, by its mean. One that multiplies nothing, such as a normal map, is dropped. */
void ec_texture_flatten(const ec_scene *scene, ec_material *m, int slot);

#endif
