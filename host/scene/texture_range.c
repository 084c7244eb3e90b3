#include "scene/texture_range.h"

void ec_texture_range(const ec_scene *scene, const ec_texture_use *use, int channel, float *least, float *most)
{
    *least = *most = 1.0f;
    if (use->texture < 0) return;
    const ec_image *image = &scene->images[scene->textures[use->texture].image];
    size_t count = (size_t)image->width * image->height;
    uint32_t low = UINT32_MAX, high = 0, white = image->rgba16 ? 65535 : 255;
    for (size_t i = 0; i < count; i++) {
        uint32_t v = image->rgba16 ? image->rgba16[4 * i + channel] : image->rgba8[4 * i + channel];
        low = v < low ? v : low;
        high = v > high ? v : high;
    }
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

bool ec_emits(const ec_scene *scene, const ec_material *m)
{
    for (int k = 0; k < 3; k++) {
        float least, most;
        if (!(m->emission[k] > 0)) continue;
        ec_texture_range(scene, &m->textures[EC_SLOT_EMISSION], k, &least, &most);
        if (most > 0) return true;
    }
    return false;
}
