/* Renders glass in small pictures whose radiance is known. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gltf/model.h"
#include "selftest/shot.h"

static void shine_from_everywhere(ec_scene *scene)
{
    for (int k = 0; k < 3; k++) scene->environment.constant[k] = 1;
    scene->has_environment = true;
}

static void sheet(ec_model *m, double z, double radiance)
{
    ec_material lambert = ec_material_lambert(0, radiance);
    ec_model_quad(m, ec_model_material(m, &lambert), (double[3]){-90, -90, z}, (double[3]){180, 0, 0}, (double[3]){0, 180, 0});
}

/* A slab 0.4 thick, seen head-on. Behind it is a lamp of radiance 1, or black with light from everywhere else. */
static ec_result slab(ec_selftest *t, const char *what, ec_material material, bool lamp, double expected, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_scene *scene;
    ec_model_box(m, ec_model_material(m, &material), (double[3]){-90, -90, -0.4}, (double[3]){90, 90, 0}, false);
    sheet(m, -1, lamp);
    ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 20}, (double[3]){0, 0, 0}, 1e-5);
    EC_TRY(ec_model_scene(m, &scene, err));
    if (!lamp) shine_from_everywhere(scene);
    ec_render_options o = ec_shot_options(t, 16, 256);
    return ec_shot_only_row(t, what, scene, &o, expected, err);
}

/* Light is reflected to and fro between the faces: R = 2 F / (1 + F), T = 1 - R. Index 1 reflects nothing and is invisible. */
ec_result ec_selftest_slabs(ec_selftest *t, ec_error *err)
{
    double F = 0.04, R = 2 * F / (1 + F), sigma = 2;
    EC_TRY(slab(t, "reflects", ec_material_glass(1.5, 0, 0), false, R, err));
    EC_TRY(slab(t, "passes", ec_material_glass(1.5, 0, 0), true, 1 - R, err));
    EC_TRY(slab(t, "index 1, absorbs", ec_material_glass(1, 0, sigma), true, exp(-sigma * 0.4), err));
    EC_TRY(slab(t, "index 1, passes", ec_material_glass(1, 0, 0), true, 1, err));
    EC_TRY(slab(t, "index 1, absorbs all", ec_material_glass(1, 0, 1e30), true, 0, err)); /* attenuation distance 0; in the row above, infinite */
    return slab(t, "index 1 + 1e-6, passes", ec_material_glass(1 + 1e-6, 0, 0), true, 1, err);
}

/* Renders m in white light from everywhere, where the picture is white and without noise if no light is lost. Paths end only by max_depth: missing
 * light was lost, or is still inside after that many segments. */
static ec_result white_row(ec_selftest *t, ec_model *m, uint32_t max_depth, ec_error *err)
{
    ec_scene *scene;
    ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){2, 3, 4}, (double[3]){0, 0, 0}, 0.3);
    EC_TRY(ec_model_scene(m, &scene, err));
    shine_from_everywhere(scene);
    ec_render_options o = ec_shot_options(t, 16, 64);
    o.survival = 1;
    o.max_depth = max_depth;
    return ec_shot_only_row(t, "", scene, &o, 1, err);
}

/* Whatever clear glass does with that light, each path brings 1. */
ec_result ec_selftest_nested_glass(ec_selftest *t, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_material outer = ec_material_glass(1.5, 0, 0), inner = ec_material_glass(2.4, 0, 0);
    ec_model_sphere(m, ec_model_material(m, &outer), (double[3]){0}, 1, 3, false);
    ec_model_sphere(m, ec_model_material(m, &inner), (double[3]){0}, 0.6, 3, false);
    return white_row(t, m, 1000, err);
}

/* Milk that absorbs nothing loses no light either, in spite of hundreds of events and total internal reflection. */
ec_result ec_selftest_milk(ec_selftest *t, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_material milk = ec_material_glass(1.33, 0, 20);
    for (int k = 0; k < 3; k++) milk.scatter[k] = 1;
    milk.scatter_anisotropy = 0.7f;
    ec_model_sphere(m, ec_model_material(m, &milk), (double[3]){0}, 1, 3, false);
    return white_row(t, m, 10000, err);
}
