/* tier: quick */
/* A texture of one colour becomes part of its factors, and --without replaces a texture by its mean. Expected values are from the
 * specifications: which channel multiplies which factor, and which slots are sRGB. */
#include <stddef.h>

#include "pack/texture_fold.h"
#include "support/test.h"

#define AT(field) offsetof(ec_material, field)
static const struct {
    int slot, channel;
    size_t factor;
    bool srgb;
} rows[] = {
    {EC_SLOT_BASE_COLOR, 0, AT(base_color[0]), true}, {EC_SLOT_BASE_COLOR, 1, AT(base_color[1]), true},
    {EC_SLOT_BASE_COLOR, 2, AT(base_color[2]), true}, {EC_SLOT_BASE_COLOR, 3, AT(base_color[3]), false},
    {EC_SLOT_METALLIC_ROUGHNESS, 1, AT(roughness), false}, {EC_SLOT_METALLIC_ROUGHNESS, 2, AT(metallic), false},
    {EC_SLOT_EMISSION, 0, AT(emission[0]), true}, {EC_SLOT_EMISSION, 2, AT(emission[2]), true},
    {EC_SLOT_SPECULAR, 3, AT(specular), false}, {EC_SLOT_SPECULAR_COLOR, 1, AT(specular_color[1]), true},
    {EC_SLOT_TRANSMISSION, 0, AT(transmission), false}, {EC_SLOT_CLEARCOAT, 0, AT(coat), false},
    {EC_SLOT_CLEARCOAT_ROUGHNESS, 1, AT(coat_roughness), false}, {EC_SLOT_SHEEN_COLOR, 2, AT(sheen[2]), true},
    {EC_SLOT_SHEEN_ROUGHNESS, 3, AT(sheen_roughness), false}, {EC_SLOT_IRIDESCENCE, 0, AT(film), false},
    {EC_SLOT_DIFFUSE_TRANSMISSION, 3, AT(diffuse_transmission), false}, {EC_SLOT_DIFFUSE_TRANSMISSION_COLOR, 0, AT(transmission_color[0]), true},
};

static double decoded(uint8_t byte, bool srgb)
{
    double v = byte / 255.0;
    return !srgb ? v : v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* All factors are 0.5; only one slot has the texture. */
static ec_material half(int slot)
{
    ec_material m = {0};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) *(float *)((char *)&m + rows[i].factor) = 0.5f;
    for (int k = 0; k < EC_SLOT_COUNT; k++) m.textures[k].texture = k == slot ? 0 : -1;
    return m;
}

int main(void)
{
    uint8_t texels[8] = {51, 102, 153, 204, 51, 102, 153, 204};
    ec_image image = {.width = 2, .height = 1, .rgba8 = texels};
    ec_texture texture = {0};
    ec_scene scene = {.images = &image, .image_count = 1, .textures = &texture, .texture_count = 1};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        ec_material folded = half(rows[i].slot), mixed = folded, mean = folded;
        const float *factor = (const float *)((const char *)&folded + rows[i].factor);
        const float *of_mixed = (const float *)((const char *)&mixed + rows[i].factor), *of_mean = (const float *)((const char *)&mean + rows[i].factor);
        double first = decoded(texels[rows[i].channel], rows[i].srgb), second = decoded(255, rows[i].srgb);
        ec_texture_fold(&scene, &folded, rows[i].slot);
        CHECK_NEAR(*factor, 0.5 * first, 1e-7);
        CHECK_MSG(folded.textures[rows[i].slot].texture == -1, "row %zu is still there", i);
        texels[4 + rows[i].channel] = 255;
        ec_texture_fold(&scene, &mixed, rows[i].slot);
        CHECK_MSG(mixed.textures[rows[i].slot].texture == 0 && *of_mixed == 0.5f, "row %zu: two values are no factor", i);
        ec_texture_flatten(&scene, &mean, rows[i].slot);
        CHECK_NEAR(*of_mean, 0.25 * (first + second), 1e-7);
        texels[4 + rows[i].channel] = texels[rows[i].channel];
    }
    TEST_END();
}
