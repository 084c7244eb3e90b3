/* Scenes whose radiance is known without rendering: energy is neither lost nor created, however long a path. */
#include <math.h>
#include <stdio.h>

#include "gltf/model.h"
#include "report/names.h"
#include "selftest/shot.h"

ec_result ec_selftest_furnace(ec_selftest *t, ec_error *err)
{
    static const double albedos[] = {0.5, 0.8};
    static const ec_sample samples[] = {EC_SAMPLE_MIS, EC_SAMPLE_BSDF, EC_SAMPLE_HEMISPHERE};
    for (int a = 0; a < 2; a++) {
        ec_scene *scene;
        ec_result result = ec_shot_box(albedos[a], &scene, err);
        for (int s = 0; s < 3 && result == EC_OK; s++) {
            char what[64];
            ec_render_options o = ec_shot_options(t, 16, 256);
            o.sample = samples[s];
            snprintf(what, sizeof what, "albedo %g, %s", albedos[a], ec_sample_names[samples[s]]);
            result = ec_shot_row(t, what, scene, &o, 1 / (1 - albedos[a]), err);
        }
        ec_scene_free(scene);
        EC_TRY(result);
    }
    return EC_OK;
}

/* GGX of reflectance 1 scatters once: the expected values are its directional albedo under uniform light, by quadrature. */
ec_result ec_selftest_metal(ec_selftest *t, ec_error *err)
{
    static const double alphas[] = {0.1, 0.5, 1}, cosines[] = {1, 0.5, 0.1};
    static const double albedo[3][3] = {{0.98830, 0.96921, 0.88346}, {0.68785, 0.69825, 0.86010}, {0.30685, 0.45069, 0.76021}};
    for (int a = 0; a < 3; a++) {
        ec_model *m = ec_model_new();
        ec_scene *scene;
        ec_material metal = ec_material_default();
        metal.roughness = (float)sqrt(alphas[a]);
        ec_model_quad(m, ec_model_material(m, &metal), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        for (int c = 0; c < 3; c++)
            ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC,
                            (double[3]){sqrt(1 - cosines[c] * cosines[c]), cosines[c], 0}, (double[3]){0, 0, 0},
                            1e-2);
        EC_TRY(ec_model_scene(m, &scene, err));
        for (int k = 0; k < 3; k++) scene->environment.constant[k] = 1;
        scene->has_environment = true;
        ec_result result = EC_OK;
        for (int c = 0; c < 3 && result == EC_OK; c++) {
            char what[48];
            ec_render_options o = ec_shot_options(t, 16, 256);
            ec_shot shot;
            o.camera = (uint32_t)c;
            snprintf(what, sizeof what, "alpha %g, cos %g", alphas[a], cosines[c]);
            if ((result = ec_shot_take(t, scene, &o, &shot, err)) != EC_OK) break;
            /* the table's last digit, plus four standard errors */
            result = ec_selftest_value(t, what, albedo[a][c], shot.mean, shot.noise, 1e-5 + fmin(4 * shot.noise, 0.01), err);
            ec_shot_free(&shot);
        }
        ec_scene_free(scene);
        EC_TRY(result);
    }
    return EC_OK;
}
