/* A lamp of 1 x 1 that faces down at height 1, about the y axis, with one bright texel. Texel (x, y) is x / TEXEL_SIDE from its corner
 * (-0.5, 1, -0.5) to the right, and y / TEXEL_SIDE along z. */
#ifndef EC_TESTS_SUPPORT_TEXEL_LAMP_H
#define EC_TESTS_SUPPORT_TEXEL_LAMP_H

#include "image/image.h"
#include "support/gltf_writer.h"
#include "support/test.h"

enum { TEXEL_SIDE = 64, TEXEL_X = 40, TEXEL_Y = 9 };

/* Adds the lamp to a scene of this name. sampler: -1, or glTF's; dark: the sRGB code of other texels; bright: that of the one. */
static inline void texel_lamp_add(gltf_writer *w, const char *name, int sampler, int dark, int bright, double radiance)
{
    static uint8_t rgb[3 * TEXEL_SIDE * TEXEL_SIDE];
    char path[512], with_sampler[32] = "";
    ec_error err = {0};
    memset(rgb, dark, sizeof rgb);
    memset(rgb + 3 * (TEXEL_Y * TEXEL_SIDE + TEXEL_X), bright, 3);
    snprintf(path, sizeof path, "%s/%s-%d.png", ECLAT_TEST_OUT, name, w->textures.count);
    CHECK_OK(ec_png_write(path, TEXEL_SIDE, TEXEL_SIDE, rgb, &err), err);
    if (sampler >= 0) snprintf(with_sampler, sizeof with_sampler, ",\"sampler\":%d", sampler);
    const int texture = gltf_add(&w->textures, "{\"source\":%d%s}", w->textures.count, with_sampler);
    const int lamp = gltf_add(&w->materials, "{\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":%d},\"extensions\":{"
                              "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":%.9g}}}", texture, radiance);
    gltf_quad(w, lamp, (double[3]){-0.5, 1, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
}

#endif
