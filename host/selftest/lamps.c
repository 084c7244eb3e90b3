/* Lamps whose light on a floor, or straight into the camera, is known. */
#include <math.h>

#include "gltf/model.h"
#include "selftest/shot.h"

/* Looks down on a white floor of 2 half x 2 half, at a square of 2 size x 2 size around the origin. */
static ec_model *floor_model(double half, double size)
{
    ec_model *m = ec_model_new();
    ec_material white = ec_material_lambert(1, 0);
    ec_model_quad(m, ec_model_material(m, &white), (double[3]){-half, 0, half}, (double[3]){2 * half, 0, 0}, (double[3]){0, 0, -2 * half});
    ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0.5, 0}, (double[3]){0, 0, 0}, size);
    return m;
}

/* Two unit squares face to face at distance 1 (Siegel and Howell, C-11): the floor's radiance is the form factor times the lamp's. */
ec_result ec_selftest_facing_squares(ec_selftest *t, ec_error *err)
{
    ec_model *m = floor_model(0.5, 0.5);
    ec_scene *scene;
    ec_material lamp = ec_material_lambert(0, 1);
    ec_model_quad(m, ec_model_material(m, &lamp), (double[3]){-0.5, 1, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
    EC_TRY(ec_model_scene(m, &scene, err));
    ec_render_options o = ec_shot_options(t, 16, 256);
    o.max_depth = 2;
    return ec_shot_only_row(t, "", scene, &o, 0.19982489, err);
}

/* Punctual lights have no noise: the floor's radiance is E / pi. */
ec_result ec_selftest_punctual(ec_selftest *t, ec_error *err)
{
    static const char *const names[] = {"point", "spot", "directional"};
    for (int i = 0; i < 3; i++) {
        ec_light light = {.type = (ec_light_type)i, .intensity = {3, 3, 3}, .cos_inner = 0.9f, .cos_outer = 0.8f};
        ec_model *m = floor_model(1, 1e-6);
        ec_scene *scene;
        ec_model_light(m, &light, (double[3]){1.2, 1.6, 0}, (double[3]){0, 0, 0});
        EC_TRY(ec_model_scene(m, &scene, err));
        ec_render_options o = ec_shot_options(t, 4, 16);
        ec_shot shot;
        ec_result result = ec_shot_take(t, scene, &o, &shot, err);
        ec_scene_free(scene);
        EC_TRY(result);
        /* 3 W/sr at distance 2, or 3 W/m^2, at cos 0.8; some twenty operations, and the camera's field of view changes it by 1e-6. */
        double expected = 3 * 0.8 / 3.14159265358979323846 / (i == EC_LIGHT_DIRECTIONAL ? 1 : 4);
        result = ec_selftest_value(t, names[i], expected, shot.mean, shot.noise, expected * (20 * 0x1p-24 + 2e-6), err);
        ec_shot_free(&shot);
        EC_TRY(result);
    }
    return EC_OK;
}

/* A camera that sees only a lamp: every sample is its radiance. Samples are summed in float batch by batch, and batches averaged in float in groups
 * (film/parts.h). */
ec_result ec_selftest_sums(ec_selftest *t, ec_error *err)
{
    ec_scene *scene;
    EC_TRY(ec_shot_lamp(&scene, err));
    ec_render_options o = ec_shot_options(t, 4, 65536);
    o.max_depth = 1;
    return ec_shot_only_row(t, "65 536 samples a pixel", scene, &o, (double)0.1f, err);
}
