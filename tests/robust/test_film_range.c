/* tier: full */
/* Tests the way from samples to files: very bright and very dark ones, and sRGB. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gltf/model.h"
#include "image/image.h"
#include "robust/cases.h"
#include "selftest/shot.h"

/* The camera sees only a lamp: every sample is the lamp's radiance. */
static ec_result lamp(double radiance, ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    if (m) {
        ec_material material = ec_material_lambert(0, radiance);
        ec_model_quad(m, ec_model_material(m, &material), (double[3]){-1, -1, 0}, (double[3]){2, 0, 0}, (double[3]){0, 2, 0});
        ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 1}, (double[3]){0, 0, 0}, 0.5);
    }
    return ec_model_scene(m, scene, err);
}

static ec_result lamp_row(ec_selftest *t, const char *what, double radiance, double expected, uint32_t size,
                          uint32_t spp, ec_error *err)
{
    ec_scene *scene;
    EC_TRY(lamp(radiance, &scene, err));
    ec_render_options o = ec_shot_options(t, size, spp);
    o.max_depth = 1;
    return ec_shot_only_row(t, what, scene, &o, expected, err);
}

/* The camera sees only an environment, whose samples add up to more than a float holds. */
static ec_result bright_sky(ec_selftest *t, double radiance, ec_error *err)
{
    ec_scene *scene;
    EC_TRY(lamp(1, &scene, err));
    for (int k = 0; k < 3; k++) scene->environment.constant[k] = (float)radiance;
    scene->has_environment = true;
    scene->cameras[0].forward[2] = -scene->cameras[0].forward[2];
    ec_render_options o = ec_shot_options(t, 4, 64);
    o.max_depth = 1;
    return ec_shot_only_row(t, "sky of 1e38", scene, &o, (double)(float)radiance, err);
}

/* The loader limits emission to 1e30, with a warning, so that products with it stay finite. */
static ec_result range_case(ec_selftest *t, ec_error *err)
{
    EC_TRY(lamp_row(t, "lamp of 1e38, taken for 1e30", 1e38, 1e30, 4, 64, err));
    EC_TRY(lamp_row(t, "lamp of 2e-38", 2e-38, 2e-38, 4, 64, err));
    return bright_sky(t, 1e38, err);
}

/* An unlit surface with a texture of all 256 sRGB values, one texel a pixel. */
static ec_result ramp(ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    if (m) {
        ec_material paper = ec_material_default();
        paper.unlit = true;
        ec_model_quad(m, ec_model_material(m, &paper), (double[3]){-1, -1, 0}, (double[3]){2, 0, 0}, (double[3]){0, 2, 0});
        ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 1}, (double[3]){0, 0, 0}, 1);
    }
    EC_TRY(ec_model_scene(m, scene, err));
    uint8_t *texels = malloc(4 * 256);
    (*scene)->images = calloc(1, sizeof *(*scene)->images);
    (*scene)->textures = calloc(1, sizeof *(*scene)->textures);
    if (!texels || !(*scene)->images || !(*scene)->textures) {
        free(texels);
        return ec_fail(err, "out of memory for a texture");
    }
    for (int i = 0; i < 4 * 256; i++) texels[i] = (uint8_t)(i % 4 == 3 ? 255 : i / 4);
    (*scene)->images[0] = (ec_image){.width = 16, .height = 16, .rgba8 = texels};
    (*scene)->textures[0] = (ec_texture){.image = 0, .wrap_s = EC_WRAP_CLAMP, .wrap_t = EC_WRAP_CLAMP, .nearest = true};
    (*scene)->image_count = (*scene)->texture_count = 1;
    for (uint32_t i = 0; i < (*scene)->material_count; i++)
        (*scene)->materials[i].textures[EC_SLOT_BASE_COLOR] = (ec_texture_use){.texture = 0, .transform = {1, 0, 0, 0, 1, 0}};
    return EC_OK;
}

static double srgb_decode(double x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }

/* Texture look-up, film and tone mapping: linear radiance is rounded once, and bytes come back unchanged. */
static ec_result srgb_case(ec_selftest *t, ec_error *err)
{
    ec_scene *scene = NULL;
    ec_shot shot = {0};
    uint8_t bytes[3 * 256];
    double worst = 0;
    uint64_t changed = 0;
    ec_render_options o = ec_shot_options(t, 16, 16);
    o.more_effects = 0; /* this scene is the only one with textures */
    ec_result result = ramp(&scene, err);
    if (result == EC_OK) result = ec_shot_take(t, scene, &o, &shot, err);
    ec_scene_free(scene);
    EC_TRY(result);
    ec_tonemap_rgb(shot.rgb, bytes, 256, 0, EC_TONEMAP_NONE);
    for (int i = 0; i < 256; i++) {
        int value = 16 * (15 - i / 16) + i % 16; /* v = 0 is at the quad's bottom, which has the texture's top row */
        double off = fabs((double)shot.rgb[3 * i + 1] - srgb_decode(value / 255.0));
        if (!(off <= worst)) worst = off;
        for (int c = 0; c < 3; c++) changed += bytes[3 * i + c] != value;
    }
    ec_shot_free(&shot);
    EC_TRY(ec_selftest_largest(t, "decoded", worst, 1e-6, NULL, err));
    return ec_selftest_none(t, "bytes that do not come back", changed, 3 * 256, NULL, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"numbers/range", false, range_case, "suns that turn black: sums over 3.4e38"},
        {"numbers/srgb", false, srgb_case, "washed-out textures: gamma 2.2 for sRGB"},
    };
    return RUN_CASES(cases);
}
