/* How the kernels of precision.cl and the host talk: so many words for each input, so many for each result, and a few
 * tables in one memory. */
#ifndef EC_PRECISION_WORDS_H
#define EC_PRECISION_WORDS_H

#include "shared/scene_buffers.h"

#define EC_PRECISION_WORDS 48   /* a multiple of 12 and 16: an input can be read as a triangle, or as vertices */
#define EC_PRECISION_RESULTS 16

/* An environment map with a flat table, a texture seen three ways (repeated, clamped, mirrored), two
 * materials: plain, and with the texture as its normal map. */
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
