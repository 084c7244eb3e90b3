/* Glass and nearly smooth surfaces in small pictures whose radiance is known. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/model.h"
#include "selftest/shot.h"

static ec_material glass(double ior, double roughness, double absorption)
{
    ec_material m = ec_material_default();
    m.metallic = 0;
    m.roughness = (float)roughness;
    m.transmission = 1;
    m.volume = true;
    m.ior = (float)ior;
    for (int k = 0; k < 3; k++) m.absorption[k] = (float)absorption;
    return m;
}

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

/* A slab 0.4 thick, seen head-on; behind it a lamp of 1, or black and light from everywhere else. */
static ec_result slab(ec_selftest *t, const char *what, ec_material material, bool lamp, double expected, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_scene *scene;
    if (m) {
        ec_model_box(m, ec_model_material(m, &material), (double[3]){-90, -90, -0.4}, (double[3]){90, 90, 0}, false);
        sheet(m, -1, lamp);
        ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 20}, (double[3]){0, 0, 0}, 1e-5);
    }
    EC_TRY(ec_model_scene(m, &scene, err));
    if (!lamp) shine_from_everywhere(scene);
    ec_render_options o = ec_shot_options(t, 16, 256);
    return ec_shot_only_row(t, what, scene, &o, expected, err);
}

/* Light goes to and fro between the faces: R = 2 F / (1 + F), T = 1 - R. Index 1 reflects nothing and is not seen. */
ec_result ec_selftest_slabs(ec_selftest *t, ec_error *err)
{
    double F = 0.04, R = 2 * F / (1 + F), sigma = 2;
    EC_TRY(slab(t, "reflects", glass(1.5, 0, 0), false, R, err));
    EC_TRY(slab(t, "passes", glass(1.5, 0, 0), true, 1 - R, err));
    EC_TRY(slab(t, "index 1, absorbs", glass(1, 0, sigma), true, exp(-sigma * 0.4), err));
    EC_TRY(slab(t, "index 1, passes", glass(1, 0, 0), true, 1, err));
    EC_TRY(slab(t, "index 1, absorbs all", glass(1, 0, 1e30), true, 0, err)); /* attenuation distance 0; the row above: infinite */
    return slab(t, "index 1 + 1e-6, passes", glass(1 + 1e-6, 0, 0), true, 1, err);
}

/* As many slabs in one another as are told apart, of indices in turn: 64 interfaces, of which those between two bodies reflect 0.0036. */
static ec_result slabs_in_slabs(ec_selftest *t, ec_error *err)
{
    enum { SLABS = 32 };
    double sum = 0, outside = 1;
    ec_model *m = ec_model_new();
    ec_scene *scene;
    for (int i = 0; i < SLABS; i++) {
        double index = i % 2 ? 1.33 : 1.5, r = (outside - index) / (outside + index), in = 0.005 * i;
        ec_material material = glass(index, 0, 0);
        if (m)
            ec_model_box(m, ec_model_material(m, &material), (double[3]){-90 + i, -90 + i, -0.4 + in},
                         (double[3]){90 - i, 90 - i, -in}, false);
        sum += 2 * r * r / (1 - r * r);
        outside = index;
    }
    if (m) {
        sheet(m, -1, true);
        ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 20}, (double[3]){0, 0, 0}, 1e-5);
    }
    EC_TRY(ec_model_scene(m, &scene, err));
    ec_render_options o = ec_shot_options(t, 16, 256);
    return ec_shot_only_row(t, "64 interfaces, pass", scene, &o, 1 / (1 + sum), err);
}

/* A slab of another index within one of 1.5: four faces. Of a clear stack, R / (1 - R) is the sum of the faces' F / (1 - F). */
ec_result ec_selftest_slab_in_slab(ec_selftest *t, ec_error *err)
{
    static const double inner[4] = {1.33, 1, 1.5, 1.5 * (1 + 1e-6)};
    for (int i = 0; i < 4; i++) {
        ec_model *m = ec_model_new();
        ec_scene *scene;
        char what[48];
        ec_material outside = glass(1.5, 0, 0), inside = glass(inner[i], 0, 0);
        double r = (1.5 - inner[i]) / (1.5 + inner[i]), sum = 2 * 0.04 / 0.96 + 2 * r * r / (1 - r * r);
        if (m) {
            ec_model_box(m, ec_model_material(m, &outside), (double[3]){-90, -90, -0.6}, (double[3]){90, 90, 0}, false);
            ec_model_box(m, ec_model_material(m, &inside), (double[3]){-80, -80, -0.4}, (double[3]){80, 80, -0.2}, false);
            sheet(m, -1, true);
            ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 20}, (double[3]){0, 0, 0}, 1e-5);
        }
        EC_TRY(ec_model_scene(m, &scene, err));
        ec_render_options o = ec_shot_options(t, 16, 256);
        snprintf(what, sizeof what, "%.8g in 1.5, passes", inner[i]);
        EC_TRY(ec_shot_only_row(t, what, scene, &o, 1 / (1 + sum), err));
    }
    return slabs_in_slabs(t, err);
}

/* Whatever clear glass does with white light from everywhere, each path brings 1. Without roulette there is no noise: what is missing
 * is lost, or in there for a thousand segments. */
ec_result ec_selftest_nested_glass(ec_selftest *t, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_scene *scene;
    if (m) {
        ec_material outer = glass(1.5, 0, 0), inner = glass(2.4, 0, 0);
        ec_model_sphere(m, ec_model_material(m, &outer), (double[3]){0}, 1, 3, false);
        ec_model_sphere(m, ec_model_material(m, &inner), (double[3]){0}, 0.6, 3, false);
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){2, 3, 4}, (double[3]){0, 0, 0}, 0.3);
    }
    EC_TRY(ec_model_scene(m, &scene, err));
    shine_from_everywhere(scene);
    ec_render_options o = ec_shot_options(t, 16, 64);
    o.survival = 1;
    o.max_depth = 1000;
    return ec_shot_only_row(t, "", scene, &o, 1, err);
}

/* Brighter to the right and to the top, without steps that a narrow lobe could tell from a mirror's single direction. */
static ec_result slope(ec_scene *scene, ec_error *err)
{
    enum { W = 256, H = 128 };
    float *rgb = malloc(3 * W * H * sizeof *rgb);
    if (!rgb) return ec_fail(err, "out of memory for an environment");
    for (int i = 0; i < 3 * W * H; i++)
        rgb[i] = (float)(2 + sin(2 * 3.14159265358979 * (i / 3 % W + 0.5) / W) + cos(3.14159265358979 * (i / 3 / W + 0.5) / H));
    scene->environment = (ec_environment){.width = W, .height = H, .rgb = rgb};
    scene->has_environment = true;
    return EC_OK;
}

/* A faceted ball of the material in that light. */
static ec_result take(ec_selftest *t, ec_material material, ec_shot *shot, ec_error *err)
{
    ec_model *m = ec_model_new();
    ec_scene *scene;
    if (m) {
        ec_model_sphere(m, ec_model_material(m, &material), (double[3]){0}, 1, 2, false);
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){2, 3, 4}, (double[3]){0, 0, 0}, 0.3);
    }
    EC_TRY(ec_model_scene(m, &scene, err));
    ec_result result = slope(scene, err);
    ec_render_options o = ec_shot_options(t, 32, 128);
    if (result == EC_OK) result = ec_shot_take(t, scene, &o, shot, err);
    ec_scene_free(scene);
    return result;
}

static ec_result same(ec_selftest *t, const char *what, ec_material smooth, ec_material rough, ec_error *err)
{
    ec_shot a, b;
    EC_TRY(take(t, smooth, &a, err));
    ec_result result = take(t, rough, &b, err);
    if (result == EC_OK) {
        double noise = hypot(a.noise, b.noise);
        result = ec_selftest_value(t, what, a.mean, b.mean, noise, 4 * noise + 1e-5 * a.mean, err);
        ec_shot_free(&b);
    }
    ec_shot_free(&a);
    return result;
}

/* Under a width of 1e-4, and of glass times |index - 1| from either side, a surface counts as smooth: other code, the same picture. */
ec_result ec_selftest_continuity(ec_selftest *t, ec_error *err)
{
    ec_material smooth = ec_material_default(), rough = smooth;
    smooth.roughness = (float)sqrt(0.99e-4);
    rough.roughness = (float)sqrt(1.01e-4);
    EC_TRY(same(t, "metal, width 0.99e-4 and 1.01e-4", smooth, rough, err));
    return same(t, "glass, width 1.98e-4 and 3.03e-4", glass(1.5, sqrt(1.98e-4), 0), glass(1.5, sqrt(3.03e-4), 0), err);
}
