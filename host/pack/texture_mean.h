/* Measures how bright a texture is, as a whole and on one triangle. Only sampling probabilities depend on it, never the expected value of a picture. */
#ifndef EC_PACK_TEXTURE_MEAN_H
#define EC_PACK_TEXTURE_MEAN_H

#include "image/image.h"
#include "scene/scene.h"

typedef struct ec_texture_mean {
    double rgb[3]; /* linear */
} ec_texture_mean;

/* Returns a channel of a texel of an sRGB image, decoded; bytes: ec_srgb_bytes(). */
static inline double ec_texel_linear(const ec_image *image, const double *bytes, size_t index, int channel)
{
    return image->rgba8 ? bytes[image->rgba8[4 * index + channel]]
                        : ec_srgb_to_linear(image->rgba16[4 * index + channel] / 65535.0);
}

/* Returns the mean of an sRGB texture's whole image; 1 without a texture. */
ec_texture_mean ec_texture_whole_mean(const ec_scene *scene, const ec_texture_use *use);

/* Averages over triangle `prim`, by nearest texels at 64 stratified points. */
void ec_texture_triangle_mean(const ec_scene *scene, const ec_texture_use *use, uint32_t prim, double rgb[3]);

#endif
