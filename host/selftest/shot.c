#include "selftest/shot.h"

#include <math.h>

#include "base/freed.h"
#include "film/resolve.h"
#include "gltf/model.h"
#include "shared/features.h"

/* Effects that most cases need. Textures, coverage and further lobes are left out: PoCL takes 20 s to build kernels with all effects. */
#define EC_SHOT_EFFECTS                                                                                                          \
    (EC_FEATURE_EMISSION | EC_FEATURE_AREA_LIGHTS | EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_ENVIRONMENT | EC_FEATURE_ENVIRONMENT_MAP | \
     EC_FEATURE_ENVIRONMENT_TURN | EC_FEATURE_SPECULAR | EC_FEATURE_SMOOTH | EC_FEATURE_TRANSMISSION | EC_FEATURE_ABSORPTION |      \
     EC_FEATURE_NESTED | EC_FEATURE_SMOOTH_NORMALS | EC_FEATURE_CULLING | EC_FEATURE_LENS)

void ec_shot_free(ec_shot *shot)
{
    ec_film_destroy(&shot->film);
    free(shot->rgb);
    *shot = (ec_shot){0};
}

ec_render_options ec_shot_options(const ec_selftest *t, uint32_t size, uint32_t spp)
{
    return (ec_render_options){.width = size, .height = size, .spp = spp, .lanes = t->lanes, .compile = EC_COMPILE_FIRST, .more_effects = EC_SHOT_EFFECTS};
}

static ec_result measure(ec_shot *s, ec_error *err)
{
    uint64_t pixels = (uint64_t)s->film.width * s->film.height;
    EC_FREED float *se = malloc(3 * pixels * sizeof *se);
    s->rgb = malloc(3 * pixels * sizeof *s->rgb);
    if (!se || !s->rgb) return ec_fail(err, "out of memory for a picture");
    ec_film_resolve(&s->film, s->rgb, se);
    double sum = 0, variance = 0;
    for (uint64_t i = 0; i < pixels; i++) {
        sum += s->rgb[3 * i + 1];
        variance += (double)se[3 * i + 1] * se[3 * i + 1];
    }
    s->mean = s->stats.invalid_samples || s->film.invalid_count ? NAN : sum / (double)pixels;
    s->noise = sqrt(variance) / (double)pixels;
    return EC_OK;
}

ec_result ec_shot_take(ec_selftest *t, const ec_scene *scene, const ec_render_options *options, ec_shot *shot, ec_error *err)
{
    *shot = (ec_shot){0};
    ec_result result = ec_render(t->cl, scene, options, NULL, NULL, &shot->film, &shot->stats, NULL, err);
    if (result == EC_OK) result = measure(shot, err);
    if (result != EC_OK) ec_shot_free(shot);
    return result;
}

ec_result ec_shot_row(ec_selftest *t, const char *what, const ec_scene *scene, const ec_render_options *options, double expected,
                      ec_error *err)
{
    ec_shot shot;
    EC_TRY(ec_shot_take(t, scene, options, &shot, err));
    double tolerance = fmin(4 * shot.noise, 0.02 * fabs(expected)) + EC_SHOT_ROUNDING * fabs(expected);
    ec_result result = ec_selftest_value(t, what, expected, shot.mean, shot.noise, tolerance, err);
    ec_shot_free(&shot);
    return result;
}

ec_result ec_shot_only_row(ec_selftest *t, const char *what, ec_scene *scene, const ec_render_options *options, double expected,
                           ec_error *err)
{
    ec_result result = ec_shot_row(t, what, scene, options, expected, err);
    ec_scene_free(scene);
    return result;
}

ec_result ec_shot_floor(ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_material white = ec_material_lambert(1, 0);
    ec_model_quad(m, ec_model_material(m, &white), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
    ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 1, 0}, (double[3]){0, 0, 0}, 0.5);
    return ec_model_scene(m, scene, err);
}

ec_result ec_shot_lamp(ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_material material = ec_material_lambert(0, 0.1);
    ec_model_quad(m, ec_model_material(m, &material), (double[3]){-1, -1, 0}, (double[3]){2, 0, 0}, (double[3]){0, 2, 0});
    ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 1}, (double[3]){0, 0, 0}, 0.5);
    return ec_model_scene(m, scene, err);
}

ec_result ec_shot_box(double albedo, ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_material walls = ec_material_lambert(albedo, 1);
    ec_model_box(m, ec_model_material(m, &walls), (double[3]){-1, -1, -1}, (double[3]){1, 1, 1}, true);
    ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.3, 0.2, 0.1}, (double[3]){-1, -0.4, -0.7}, 0.9);
    return ec_model_scene(m, scene, err);
}
