/* Fuzzes pictures: OpenEXR and Radiance files as environment maps, including the table; others (PNG, JPEG, WebP, AVIF, KTX2) as textures. */
#include <math.h>

#include "fuzz.h"
#include "image/image.h"
#include "pack/pack.h"
#include "gltf/image_decode.h"

enum { PIXELS_MOST = 1 << 16 }; /* larger pictures find nothing more and are slower */

static void judge_environment(ec_scene *scene)
{
    ec_pack pack = {0};
    ec_error err = {0};
    double luminance;
    ec_result result = ec_pack_environment(scene, &pack, &luminance, &err);
    fuzz_judge_result(result, &err);
    PROMISE(isfinite(luminance) && luminance >= 0, "mean luminance %g", luminance);
    const uint32_t rows = pack.environment_height + 1;
    const size_t count = (size_t)pack.environment_width * rows;
    for (uint32_t y = 0; pack.environment_table && y < rows; y++)
        PROMISE(pack.environment_table[y].guide < rows, "guide %u", pack.environment_table[y].guide);
    for (size_t i = 0; pack.environment_table && i < count; i++)
        PROMISE(pack.environment_table[rows + i].guide < pack.environment_width, "guide %u", pack.environment_table[rows + i].guide);
    for (size_t i = 0; pack.environment_texels && i < count; i++) {
        const float scale = pack.environment_texels[4 * i + 3];
        PROMISE(isfinite(scale) && scale >= 0 && (pack.environment_table || scale == 0), "patch %zu has the scale %g", i, scale);
    }
    ec_pack_free(&pack);
}

static void read_environment(const uint8_t *data, size_t size)
{
    ec_scene scene = {0};
    ec_error err = {0};
    ec_result result = ec_scene_set_environment(&scene, fuzz_file(data, size), NULL, &err);
    fuzz_judge_result(result, &err);
    size_t values = 3 * (size_t)scene.environment.width * scene.environment.height;
    for (size_t i = 0; result == EC_OK && i < values; i++)
        PROMISE(isfinite(scene.environment.rgb[i]) && scene.environment.rgb[i] >= 0, "texel %g", scene.environment.rgb[i]);
    if (result == EC_OK && values <= 3 * (size_t)PIXELS_MOST) judge_environment(&scene);
    free(scene.environment.rgb);
}

static void decode_texture(const uint8_t *data, size_t size)
{
    ec_image image = {0};
    ec_decode_error why = {.text = ""};
    if (ec_image_decode(data, size, &image, &why))
        PROMISE(image.width && image.height && !image.rgba8 != !image.rgba16, "%u x %u", image.width, image.height);
    else
        PROMISE(!image.rgba8 && !image.rgba16 && why.text[0] && !strchr(why.text, '\n'), "%s", why.text);
    free(image.rgba8);
    free(image.rgba16);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size && (data[0] == 'v' || data[0] == '#')) read_environment(data, size);
    else decode_texture(data, size);
    return 0;
}
