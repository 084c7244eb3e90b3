/* Layout of the data between the kernels of precision.cl and the host: words for each input, words for each result, and a few tables in one
 * memory. */
#ifndef EC_PRECISION_WORDS_H
#define EC_PRECISION_WORDS_H

#include "shared/scene_buffers.h"

#define EC_PRECISION_WORDS 48   /* a multiple of 12 and 16: an input can be read as triangles or vertices */
#define EC_PRECISION_RESULTS 16

/* Tables: an environment map with a flat distribution; a texture with three wrap modes (repeat, clamp, mirror); two materials, one plain,
 * one with the texture as its normal map. */
#define EC_PRECISION_MAP_WIDTH 16
#define EC_PRECISION_MAP_HEIGHT 8
#define EC_PRECISION_MAP 0
#define EC_PRECISION_TABLE (EC_PRECISION_MAP + 4 * EC_PRECISION_MAP_WIDTH * (EC_PRECISION_MAP_HEIGHT + 1))
#define EC_PRECISION_TEXTURES (EC_PRECISION_TABLE + 2 * (EC_PRECISION_MAP_WIDTH + 1) * (EC_PRECISION_MAP_HEIGHT + 1))
#define EC_PRECISION_TEXTURE_SIZE 8
#define EC_PRECISION_TEXELS (EC_PRECISION_TEXTURES + 4 * 3)
#define EC_PRECISION_MATERIALS (EC_PRECISION_TEXELS + 4 * EC_PRECISION_TEXTURE_SIZE * EC_PRECISION_TEXTURE_SIZE)
#define EC_PRECISION_MEMORY (EC_PRECISION_MATERIALS + 2 * EC_MATERIAL_WORDS)

#endif
