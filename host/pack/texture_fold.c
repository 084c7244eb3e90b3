#include "pack/texture_fold.h"

#include "image/image.h"
#include "pack/pack.h"
#include "scene/material_fields.h"
#include "scene/texture_range.h"

/* Returns the factor that a channel (R, G, B, A) of a texture multiplies; NULL: none. */
static float *factor_of(ec_material *m, int slot, int channel)
{
    for (int i = 0; i < ec_material_field_count; i++) {
        const ec_material_field *f = &ec_material_fields[i];
        if ((int)f->slot == slot && channel >= f->channel && channel < f->channel + f->floats)
            return ec_material_floats(m, f) + channel - f->channel;
    }
    return NULL;
}

static uint32_t texel(const ec_image *image, size_t at) { return image->rgba16 ? image->rgba16[at] : image->rgba8[at]; }

static bool is_constant(const ec_image *image, int channel)
{
    uint32_t least, most;
    ec_image_range(image, channel, &least, &most);
    return least == most && image->width && image->height;
}

static const ec_image *image_of(const ec_scene *scene, const ec_texture_use *use)
{
    return &scene->images[scene->textures[use->texture].image];
}

/* Decodes a channel's stored value to the one that is multiplied. */
static double decoded(const ec_image *image, int slot, int channel, uint32_t stored)
{
    double v = stored / (image->rgba16 ? 65535.0 : 255.0);
    return ec_material_slots[slot].is_srgb && channel < 3 ? ec_srgb_to_linear(v) : v;
}

/* A channel that is multiplied by 0 may have any values. */
void ec_texture_fold(const ec_scene *scene, ec_material *m, int slot)
{
    ec_texture_use *use = &m->textures[slot];
    float *factors[4];
    bool any = false;
    if (use->texture < 0) return;
    const ec_image *image = image_of(scene, use);
    for (int k = 0; k < 4; k++) {
        factors[k] = factor_of(m, slot, k);
        any |= factors[k] != NULL;
        if (factors[k] && *factors[k] != 0.0f && !is_constant(image, k)) return;
    }
    if (!any) return;
    for (int k = 0; k < 4; k++)
        if (factors[k] && *factors[k] != 0.0f) *factors[k] *= (float)decoded(image, slot, k, texel(image, (size_t)k));
    use->texture = -1;
}

/* Computes a mean by counting values first, as decoding each texel would take seconds. */
static double mean_of(const ec_image *image, int slot, int channel)
{
    const size_t count = (size_t)image->width * image->height, values = image->rgba16 ? 65536 : 256;
    uint32_t times[65536] = {0}; /* an image has at most 2^28 texels */
    double sum = 0.0;
    if (!count) return 1.0;
    for (size_t i = 0; i < count; i++) times[texel(image, 4 * i + (size_t)channel)]++;
    for (size_t v = 0; v < values; v++)
        if (times[v]) sum += (double)times[v] * decoded(image, slot, channel, (uint32_t)v);
    return sum / (double)count;
}

/* Multiplies factors by the means of channels before `end`. */
static void multiply_means(const ec_scene *scene, ec_material *m, int slot, int end)
{
    const ec_texture_use *use = &m->textures[slot];
    for (int k = 0; use->texture >= 0 && k < end; k++) {
        float *factor = factor_of(m, slot, k);
        if (factor) *factor *= (float)mean_of(image_of(scene, use), slot, k);
    }
}

void ec_texture_flatten_color(const ec_scene *scene, ec_material *m, int slot) { multiply_means(scene, m, slot, 3); }

void ec_texture_flatten(const ec_scene *scene, ec_material *m, int slot)
{
    multiply_means(scene, m, slot, 4);
    m->textures[slot].texture = -1;
}
