/* tier: full */
/* Glass in glass, and nearly smooth surfaces: small pictures of known radiance. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "robust/cases.h"
#include "gltf/model.h"
#include "selftest/shot.h"

static void sheet(ec_model *m, double z, double radiance)
{
    ec_material lambert = ec_material_lambert(0, radiance);
    ec_model_quad(m, ec_model_material(m, &lambert), (double[3]){-90, -90, z}, (double[3]){180, 0, 0}, (double[3]){0, 180, 0});
}

/* As many nested slabs as eclat tells apart, with alternating indices: 64 interfaces. Those between two bodies reflect 0.0036. */
static ec_result slabs_in_slabs(ec_selftest *t, ec_error *err)
{
    enum { SLABS = 32 };
    double sum = 0, outside = 1;
    ec_model *m = ec_model_new();
    ec_scene *scene;
    for (int i = 0; i < SLABS; i++) {
        double index = i % 2 ? 1.33 : 1.5, r = (outside - index) / (outside + index), in = 0.005 * i;
        ec_material material = ec_material_glass(index, 0, 0);
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

/* A slab of another index within one of 1.5: four faces. In a clear stack, R / (1 - R) is the sum of the faces' F / (1 - F). */
static ec_result slab_in_slab_case(ec_selftest *t, ec_error *err)
{
    static const double inner[4] = {1.33, 1, 1.5, 1.5 * (1 + 1e-6)};
    for (int i = 0; i < 4; i++) {
        ec_model *m = ec_model_new();
        ec_scene *scene;
        char what[48];
        ec_material outside = ec_material_glass(1.5, 0, 0), inside = ec_material_glass(inner[i], 0, 0);
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

/* Light that grows to the right and to the top, without steps by which a narrow lobe would differ from a mirror's single direction. */
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

/* Below a width of 1e-4, which for glass is multiplied by |index - 1| from either side, a surface counts as smooth: other code, the same
 * picture. */
static ec_result continuity_case(ec_selftest *t, ec_error *err)
{
    ec_material smooth = ec_material_default(), rough = smooth;
    smooth.roughness = (float)sqrt(0.99e-4);
    rough.roughness = (float)sqrt(1.01e-4);
    EC_TRY(same(t, "metal, width 0.99e-4 and 1.01e-4", smooth, rough, err));
    return same(t, "glass, width 1.98e-4 and 3.03e-4", ec_material_glass(1.5, sqrt(1.98e-4), 0), ec_material_glass(1.5, sqrt(3.03e-4), 0), err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/slab in slab", false, slab_in_slab_case, "liquid in glass that refracts as if in air (Schmidt and Budge 2002)"},
        {"scatter/continuity", false, continuity_case, "a jump in brightness where roughness gets to 0"},
    };
    return RUN_CASES(cases);
}
