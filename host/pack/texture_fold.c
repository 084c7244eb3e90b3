#include "pack/texture_fold.h"

#include <stddef.h>

#include "image/image.h"
#include "pack/pack.h"
#include "scene/texture_range.h"

/* Which factor a texture's channel multiplies: R, G, B, A. A slot without a row stays as it is. */
#define NO_FACTOR (-1)
#define AT(field) (int)offsetof(ec_material, field)
typedef struct factors {
    int slot, of[4];
} factors;
static const factors table[] = {
    {EC_SLOT_BASE_COLOR, {AT(base_color[0]), AT(base_color[1]), AT(base_color[2]), AT(base_color[3])}},
    {EC_SLOT_METALLIC_ROUGHNESS, {NO_FACTOR, AT(roughness), AT(metallic), NO_FACTOR}},
    {EC_SLOT_EMISSION, {AT(emission[0]), AT(emission[1]), AT(emission[2]), NO_FACTOR}},
    {EC_SLOT_SPECULAR, {NO_FACTOR, NO_FACTOR, NO_FACTOR, AT(specular)}},
    {EC_SLOT_SPECULAR_COLOR, {AT(specular_color[0]), AT(specular_color[1]), AT(specular_color[2]), NO_FACTOR}},
    {EC_SLOT_TRANSMISSION, {AT(transmission), NO_FACTOR, NO_FACTOR, NO_FACTOR}},
    {EC_SLOT_CLEARCOAT, {AT(coat), NO_FACTOR, NO_FACTOR, NO_FACTOR}},
    {EC_SLOT_CLEARCOAT_ROUGHNESS, {NO_FACTOR, AT(coat_roughness), NO_FACTOR, NO_FACTOR}},
    {EC_SLOT_SHEEN_COLOR, {AT(sheen[0]), AT(sheen[1]), AT(sheen[2]), NO_FACTOR}},
    {EC_SLOT_IRIDESCENCE, {AT(film), NO_FACTOR, NO_FACTOR, NO_FACTOR}},
    {EC_SLOT_DIFFUSE_TRANSMISSION, {NO_FACTOR, NO_FACTOR, NO_FACTOR, AT(diffuse_transmission)}},
    {EC_SLOT_DIFFUSE_TRANSMISSION_COLOR, {AT(transmission_color[0]), AT(transmission_color[1]), AT(transmission_color[2]), NO_FACTOR}},
    {EC_SLOT_SHEEN_ROUGHNESS, {NO_FACTOR, NO_FACTOR, NO_FACTOR, AT(sheen_roughness)}},
};

#define SLOT_IS_SRGB(name, is_srgb) is_srgb,
static const bool slot_is_srgb[EC_SLOT_COUNT] = {EC_SLOTS(SLOT_IS_SRGB)};

static float *factor_at(ec_material *m, int offset) { return (float *)((char *)m + offset); }

static uint32_t texel(const ec_image *image, size_t at) { return image->rgba16 ? image->rgba16[at] : image->rgba8[at]; }

static bool is_constant(const ec_image *image, int channel)
{
    uint32_t least, most;
    ec_image_range(image, channel, &least, &most);
    return least == most && image->width && image->height;
}

static const factors *factors_of(int slot)
{
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (table[i].slot == slot) return &table[i];
    return NULL;
}

static const ec_image *image_of(const ec_scene *scene, const ec_texture_use *use)
{
    return &scene->images[scene->textures[use->texture].image];
}

/* A channel's value as it is multiplied with, from what the image has. */
static double decoded(const ec_image *image, int slot, int channel, uint32_t stored)
{
    double v = stored / (image->rgba16 ? 65535.0 : 255.0);
    return slot_is_srgb[slot] && channel < 3 ? ec_srgb_to_linear(v) : v;
}

/* A channel that is multiplied by 0 may be anything. */
void ec_texture_fold(const ec_scene *scene, ec_material *m, int slot)
{
    ec_texture_use *use = &m->textures[slot];
    const factors *f = factors_of(slot);
    if (use->texture < 0 || !f) return;
    const ec_image *image = image_of(scene, use);
    for (int k = 0; k < 4; k++)
        if (f->of[k] != NO_FACTOR && *factor_at(m, f->of[k]) != 0.0f && !is_constant(image, k)) return;
    for (int k = 0; k < 4; k++)
        if (f->of[k] != NO_FACTOR && *factor_at(m, f->of[k]) != 0.0f)
            *factor_at(m, f->of[k]) *= (float)decoded(image, slot, k, texel(image, (size_t)k));
    use->texture = -1;
}

/* Values are counted first: to decode each texel would take seconds. */
static double mean_of(const ec_image *image, int slot, int channel)
{
    const size_t count = (size_t)image->width * image->height, values = image->rgba16 ? 65536 : 256;
    uint32_t times[65536] = {0}; /* a picture has 2^28 texels at most */
    double sum = 0.0;
    if (!count) return 1.0;
    for (size_t i = 0; i < count; i++) times[texel(image, 4 * i + (size_t)channel)]++;
    for (size_t v = 0; v < values; v++)
        if (times[v]) sum += (double)times[v] * decoded(image, slot, channel, (uint32_t)v);
    return sum / (double)count;
}

/* Takes channels before `end`. */
static void multiply_means(const ec_scene *scene, ec_material *m, int slot, int end)
{
    const ec_texture_use *use = &m->textures[slot];
    const factors *f = factors_of(slot);
    for (int k = 0; f && use->texture >= 0 && k < end; k++)
        if (f->of[k] != NO_FACTOR) *factor_at(m, f->of[k]) *= (float)mean_of(image_of(scene, use), slot, k);
}

void ec_texture_flatten_color(const ec_scene *scene, ec_material *m, int slot) { multiply_means(scene, m, slot, 3); }

void ec_texture_flatten(const ec_scene *scene, ec_material *m, int slot)
{
    multiply_means(scene, m, slot, 4);
    m->textures[slot].texture = -1;
}
