#include "scene/texture_range.h"

#include <string.h>

#define LANES 32 /* values side by side, so that compilers vectorise; a multiple of the channels */

/* Finds the range of `count` values, for lane k in low[k] and high[k]. */
#define FIND(type, name)                                                                           \
    static void name(const type *values, size_t count, type low[LANES], type high[LANES])          \
    {                                                                                              \
        size_t i = 0;                                                                              \
        for (; i + LANES <= count; i += LANES)                                                     \
            for (int k = 0; k < LANES; k++) {                                                      \
                low[k] = values[i + k] < low[k] ? values[i + k] : low[k];                          \
                high[k] = values[i + k] > high[k] ? values[i + k] : high[k];                       \
            }                                                                                      \
        for (int k = 0; i < count; i++, k++) {                                                     \
            low[k] = values[i] < low[k] ? values[i] : low[k];                                      \
            high[k] = values[i] > high[k] ? values[i] : high[k];                                   \
        }                                                                                          \
    }
FIND(uint8_t, find_shallow)
FIND(uint16_t, find_deep)

void ec_image_find_range(ec_image *image)
{
    const size_t count = 4 * (size_t)image->width * image->height;
    uint16_t low[LANES], high[LANES];
    uint8_t low8[LANES], high8[LANES];
    memset(low, 255, sizeof low);
    memset(high, 0, sizeof high);
    memset(low8, 255, sizeof low8);
    memset(high8, 0, sizeof high8);
    if (image->rgba16) find_deep(image->rgba16, count, low, high);
    else find_shallow(image->rgba8, count, low8, high8);
    for (int k = 0; k < LANES && !image->rgba16; k++) low[k] = low8[k], high[k] = high8[k];
    for (int k = 4; k < LANES; k++) {
        low[k % 4] = low[k] < low[k % 4] ? low[k] : low[k % 4];
        high[k % 4] = high[k] > high[k % 4] ? high[k] : high[k % 4];
    }
    for (int k = 0; k < 4; k++) image->least[k] = count ? low[k] : 0, image->most[k] = high[k];
    image->has_range = true;
}

void ec_image_range(const ec_image *image, int channel, uint32_t *least, uint32_t *most)
{
    ec_image looked_at = *image;
    if (!image->has_range) ec_image_find_range(&looked_at);
    *least = looked_at.least[channel];
    *most = looked_at.most[channel];
}

void ec_texture_range(const ec_scene *scene, const ec_texture_use *use, int channel, float *least, float *most)
{
    *least = *most = 1.0f;
    if (use->texture < 0) return;
    const ec_image *image = &scene->images[scene->textures[use->texture].image];
    uint32_t low, high, white = image->rgba16 ? 65535 : 255;
    ec_image_range(image, channel, &low, &high);
    *least = (float)low / (float)white;
    *most = (float)high / (float)white;
}

bool ec_alpha_hides(const ec_scene *scene, const ec_material *m, float most_alpha, bool varies)
{
    const ec_texture_use *use = &m->textures[EC_SLOT_BASE_COLOR];
    float least, most, slack = use->texture >= 0 || varies ? EC_TEXTURE_SLACK : 0.0f;
    if (m->alpha_mode == EC_ALPHA_OPAQUE) return false;
    ec_texture_range(scene, use, 3, &least, &most);
    most *= m->base_color[3] * most_alpha;
    return m->alpha_mode == EC_ALPHA_MASK ? most * (1.0f + slack) < m->alpha_cutoff : most == 0.0f;
}
