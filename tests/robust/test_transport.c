/* tier: full */
/* Roulette and perfect mirrors in scenes whose radiance is known. */
#include <math.h>
#include <stdio.h>

#include "gltf/model.h"
#include "robust/cases.h"
#include "selftest/shot.h"

/* Sampled by the BSDF and without roulette, the result is the truncated series, without noise: differences are rounding. */
static ec_result deep_paths_case(ec_selftest *t, ec_error *err)
{
    static const uint32_t depths[] = {2, 3, 40, 1000};
    ec_scene *scene;
    ec_result result = ec_shot_box(0.999, &scene, err);
    for (int d = 0; d < 4 && result == EC_OK; d++) {
        char what[32];
        ec_render_options o = ec_shot_options(t, 4, 16);
        ec_shot shot;
        double albedo = (double)0.999f, expected = (1 - pow(albedo, depths[d])) / (1 - albedo);
        o.sample = EC_SAMPLE_BSDF;
        o.survival = 1;
        o.max_depth = depths[d];
        snprintf(what, sizeof what, "%u segments", depths[d]);
        if ((result = ec_shot_take(t, scene, &o, &shot, err)) != EC_OK) break;
        /* beta and the sum are rounded once in each segment */
        result = ec_selftest_value(t, what, expected, shot.mean, shot.noise, expected * 3 * depths[d] * 0x1p-24, err);
        ec_shot_free(&shot);
    }
    ec_scene_free(scene);
    return result;
}

/* Roulette must not change the mean, whatever the survival probability P. It must exceed albedo^2, or endless paths have infinite variance. */
static ec_result roulette_case(ec_selftest *t, ec_error *err)
{
    static const double survivals[] = {0, 0.5, 0.8};
    ec_scene *scene;
    ec_result result = ec_shot_box(0.5, &scene, err);
    for (int i = 0; i < 3 && result == EC_OK; i++) {
        char what[32] = "auto";
        ec_render_options o = ec_shot_options(t, 16, 512);
        o.sample = EC_SAMPLE_BSDF;
        o.survival = survivals[i];
        if (survivals[i] > 0) snprintf(what, sizeof what, "P = %g", survivals[i]);
        result = ec_shot_row(t, what, scene, &o, 2, err);
    }
    ec_scene_free(scene);
    return result;
}

static ec_material mirror(double reflectance)
{
    ec_material m = ec_material_default();
    m.roughness = 0;
    for (int c = 0; c < 3; c++) m.base_color[c] = (float)reflectance;
    return m;
}

/* Four perfect mirrors make floor and ceiling infinite planes: floor 1 / (1 - r1 r2), ceiling r2 times that. Light sampling cannot reach
 * the lamp's images; only paths by mirrors do. */
static ec_result mirrored_plates_case(ec_selftest *t, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_scene *scene;
    if (m) {
        ec_material floor = ec_material_lambert(0.5, 1), ceiling = ec_material_lambert(0.8, 0), wall = mirror(1);
        int32_t walls = ec_model_material(m, &wall);
        ec_model_quad(m, ec_model_material(m, &floor), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        ec_model_quad(m, ec_model_material(m, &ceiling), (double[3]){-1, 1, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
        ec_model_quad(m, walls, (double[3]){-1, 0, -1}, (double[3]){2, 0, 0}, (double[3]){0, 1, 0});
        ec_model_quad(m, walls, (double[3]){1, 0, 1}, (double[3]){-2, 0, 0}, (double[3]){0, 1, 0});
        ec_model_quad(m, walls, (double[3]){-1, 0, 1}, (double[3]){0, 0, -2}, (double[3]){0, 1, 0});
        ec_model_quad(m, walls, (double[3]){1, 0, -1}, (double[3]){0, 0, 2}, (double[3]){0, 1, 0});
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.2, 0.5, 0.1}, (double[3]){0.1, 0, 0.2}, 0.3);
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.2, 0.5, 0.1}, (double[3]){0.1, 1, 0.2}, 0.3);
    }
    EC_TRY(ec_model_scene(m, &scene, err));
    ec_render_options o = ec_shot_options(t, 16, 1024);
    ec_result result = ec_shot_row(t, "floor", scene, &o, 1 / (1 - 0.4), err);
    o.camera = 1;
    if (result == EC_OK) result = ec_shot_row(t, "ceiling", scene, &o, 0.8 / (1 - 0.4), err);
    ec_scene_free(scene);
    return result;
}

/* A zigzag at 45 degrees between two mirrors to a lamp at the end: n reflections, each of Schlick's F = r + (1 - r) (1 - cos)^5. */
static ec_result corridor_case(ec_selftest *t, ec_error *err)
{
    static const int counts[] = {1, 10, 100};
    for (int i = 0; i < 3; i++) {
        int n = counts[i];
        ec_model *m = ec_model_new();
        ec_scene *scene;
        char what[32];
        if (m) {
            ec_material plate = mirror(0.97), lamp = ec_material_lambert(0, 1);
            int32_t plates = ec_model_material(m, &plate);
            double end = n; /* the ray meets a plate at x = 1/2, 3/2, ... */
            ec_model_quad(m, plates, (double[3]){-1, 0, 1}, (double[3]){end + 1, 0, 0}, (double[3]){0, 0, -2});
            ec_model_quad(m, plates, (double[3]){-1, 1, -1}, (double[3]){end + 1, 0, 0}, (double[3]){0, 0, 2});
            ec_model_quad(m, ec_model_material(m, &lamp), (double[3]){end, 0, -1}, (double[3]){0, 0, 2}, (double[3]){0, 1, 0});
            ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0.5, 0}, (double[3]){1, -0.5, 0}, 1e-4);
        }
        EC_TRY(ec_model_scene(m, &scene, err));
        ec_render_options o = ec_shot_options(t, 4, 16);
        ec_shot shot;
        o.survival = 1;
        o.max_depth = (uint32_t)n + 1;
        double r = (double)0.97f, expected = pow(r + (1 - r) * pow(1 - sqrt(0.5), 5), n);
        snprintf(what, sizeof what, "%d reflections", n);
        ec_result result = ec_shot_take(t, scene, &o, &shot, err);
        ec_scene_free(scene);
        EC_TRY(result);
        /* A reflection multiplies by F, of about eight rounded operations. The cosine's own error counts (1 - r) 5 (1 - cos)^4 < 1e-3
         * times. */
        result = ec_selftest_value(t, what, expected, shot.mean, shot.noise, expected * 8 * n * 0x1p-24, err);
        ec_shot_free(&shot);
        EC_TRY(result);
    }
    return EC_OK;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"transport/deep paths", false, deep_paths_case, "throughput drifts over a thousand bounces, or paths end early"},
        {"transport/roulette", false, roulette_case, "roulette that divides by another probability than it plays"},
        {"transport/mirrored plates", false, mirrored_plates_case, "a lamp's images in mirrors counted twice or never met"},
        {"transport/corridor", false, corridor_case, "smooth reflection that leaks or loses its direction"},
    };
    return RUN_CASES(cases);
}
