/* Finds the range of a texture's values, and what follows from it for a material. */
#ifndef EC_SCENE_TEXTURE_RANGE_H
#define EC_SCENE_TEXTURE_RANGE_H

#include "scene/scene.h"

/* Finds the least and largest values of all channels, and stores them in the image, whose pixels must not change afterwards. */
void ec_image_find_range(ec_image *image);

/* Gets the range of one channel, as stored; 0 and 0 for an image without pixels. */
void ec_image_range(const ec_image *image, int channel, uint32_t *least, uint32_t *most);

/* Gets the range of a channel as stored, scaled to 0..1; 1 without a texture. */
void ec_texture_range(const ec_scene *scene, const ec_texture_use *use, int channel, float *least, float *most);

/* Largest relative rounding error of a bilinear look-up and a product. */
#define EC_TEXTURE_SLACK 4e-7f

/* Tells whether alpha hides all of a material whose vertex colours have an alpha of at most most_alpha. varies: alpha of vertex colours is not the
 * same everywhere. */
bool ec_alpha_hides(const ec_scene *scene, const ec_material *material, float most_alpha, bool varies);

#endif
