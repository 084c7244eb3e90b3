/* Between which values does a texture lie, and what does that make of a material? */
#ifndef EC_SCENE_TEXTURE_RANGE_H
#define EC_SCENE_TEXTURE_RANGE_H

#include "scene/scene.h"

/* Looks for the least and largest values of all channels, and notes them in the image: for pixels that stay as they are. */
void ec_image_find_range(ec_image *image);

/* The range of one channel, as stored. An image without pixels has 0 and 0. */
void ec_image_range(const ec_image *image, int channel, uint32_t *least, uint32_t *most);

/* Least and largest value of a channel as it is stored, 0 to 1; 1 without a texture. */
void ec_texture_range(const ec_scene *scene, const ec_texture_use *use, int channel, float *least, float *most);

/* The largest relative rounding error of a bilinear look-up and a product. */
#define EC_TEXTURE_SLACK 4e-7f

/* Does alpha hide all of a material, whose vertex colours have an alpha of most_alpha or less? varies: not the same everywhere. */
bool ec_alpha_hides(const ec_scene *scene, const ec_material *material, float most_alpha, bool varies);

#endif
