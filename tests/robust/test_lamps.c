/* tier: full */
/* Lamps of every size and distance: the light that a surface gets from them is known. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gltf/model.h"
#include "report/names.h"
#include "robust/cases.h"
#include "selftest/shot.h"
#include "shared/features.h"

static const double pi = 3.14159265358979323846;

/* Form factor from an element under the corner of a rectangle a x b at height h, parallel to it (Siegel and Howell, C-13). */
static double corner_factor(double a, double b, double h)
{
    double p = hypot(a, h), q = hypot(b, h);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2 * pi);
}

/* Form factor to a rectangle perpendicular to the element's plane, at distance d, with the nearest corner in front of it: `high` up, `wide`
 * along (C-14). */
static double wall_factor(double high, double wide, double d)
{
    return (atan(wide / d) - d / hypot(high, d) * atan(wide / hypot(high, d))) / (2 * pi);
}

/* A white Lambertian floor, larger than anything on it. Its radiance is the form factor times the lamp's radiance. */
static ec_model *floor_model(double half)
{
    ec_model *m = ec_model_new();
    if (!m) return NULL;
    ec_material white = ec_material_lambert(1, 0);
    ec_model_quad(m, ec_model_material(m, &white), (double[3]){-half, 0, half}, (double[3]){2 * half, 0, 0},
                  (double[3]){0, 0, -2 * half});
    return m;
}

/* A camera at height y that sees a square of 2 x size about the origin. */
static void look_down(ec_model *m, double y, double size)
{
    ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, y, 0}, (double[3]){0, 0, 0}, size);
}

/* A lamp of 2 a x 2 a that shines down from height h, made of parts x parts quads. */
static void add_lamp(ec_model *m, double a, double h, double radiance, int parts)
{
    ec_material material = ec_material_lambert(0, radiance);
    size_t n = (size_t)parts + 1, used = 0;
    float *positions = malloc(3 * n * n * sizeof *positions);
    uint32_t *indices = malloc(6 * (size_t)parts * (size_t)parts * sizeof *indices);
    for (size_t i = 0; positions && i < n * n; i++) {
        positions[3 * i] = (float)(-a + 2 * a * (double)(i % n) / parts);
        positions[3 * i + 1] = (float)h;
        positions[3 * i + 2] = (float)(-a + 2 * a * (double)(i / n) / parts);
    }
    for (size_t i = 0; indices && i + n < n * n; i++) {
        if (i % n == (size_t)parts) continue;
        const size_t corner[6] = {i, i + 1, i + n + 1, i, i + n + 1, i + n};
        for (int k = 0; k < 6; k++) indices[used++] = (uint32_t)corner[k];
    }
    /* Writes the model; without memory it has no vertices, and loading fails. */
    ec_model_add(m, ec_model_material(m, &material), &(ec_model_mesh){.vertex_count = (uint32_t)(n * n), .index_count = (uint32_t)used,
                                                                      .positions = positions, .indices = indices});
    free(positions);
    free(indices);
}

/* Finishes the model, renders its direct light and returns a row of it. */
static ec_result rounded_row(ec_selftest *t, ec_model *m, const char *what, uint32_t spp, ec_sample sample,
                             double expected, double rounding, ec_error *err)
{
    ec_scene *scene;
    EC_TRY(ec_model_scene(m, &scene, err));
    ec_render_options o = ec_shot_options(t, 16, spp);
    o.max_depth = 2;
    o.sample = sample;
    ec_shot shot = {0};
    ec_result result = ec_shot_take(t, scene, &o, &shot, err);
    ec_scene_free(scene);
    EC_TRY(result);
    const double tolerance = fmin(4 * shot.noise, 0.02 * expected) + rounding * expected;
    result = ec_selftest_value(t, what, expected, shot.mean, shot.noise, tolerance, err);
    ec_shot_free(&shot);
    return result;
}

static ec_result direct_row(ec_selftest *t, ec_model *m, const char *what, uint32_t spp, ec_sample sample,
                            double expected, ec_error *err)
{
    return rounded_row(t, m, what, spp, sample, expected, EC_SHOT_ROUNDING, err);
}

/* Directions sampled towards a triangle straight above are off by u edge / height (lib/spherical_triangle.h). Their cosines, which vary
 * around the true ones, are off by half the square of that. */
static double near_rounding(double edge, double height)
{
    const double angle = 0x1p-24 * edge / height;
    return EC_SHOT_ROUNDING + 0.5 * angle * angle;
}

static ec_result near_lamp_case(ec_selftest *t, ec_error *err)
{
    static const double heights[] = {1, 0.1, 1e-2, 1e-3, 1e-6};
    static const ec_sample samples[] = {EC_SAMPLE_MIS, EC_SAMPLE_LIGHT};
    for (int s = 0; s < 2; s++)
        for (int i = 0; i < 5; i++) {
            double h = heights[i];
            char what[48];
            ec_model *m = floor_model(4);
            if (m) {
                add_lamp(m, 1, h, 1, 1);
                look_down(m, 0.5 * h, fmin(h, 0.1) * 0.01);
            }
            snprintf(what, sizeof what, "%g above, %s", h, ec_sample_names[samples[s]]);
            double rounding = samples[s] == EC_SAMPLE_LIGHT ? near_rounding(2 * sqrt(2), h) : EC_SHOT_ROUNDING;
            EC_TRY(rounded_row(t, m, what, 256, samples[s], 4 * corner_factor(1, 1, h), rounding, err));
        }
    return EC_OK;
}

static ec_result tiny_lamp_case(ec_selftest *t, ec_error *err)
{
    for (double a = 1e-2; a > 5e-7; a *= 1e-2) {
        char what[32];
        ec_model *m = floor_model(4);
        double radiance = (double)(float)(1 / (4 * a * a));
        if (m) {
            add_lamp(m, (double)(float)a, 1, radiance, 1);
            look_down(m, 0.5, 1e-3);
        }
        snprintf(what, sizeof what, "%g across at 1", 2 * a);
        EC_TRY(direct_row(t, m, what, 64, EC_SAMPLE_MIS, radiance * 4 * corner_factor((double)(float)a, (double)(float)a, 1), err));
    }
    return EC_OK;
}

/* Half of the lamp is below the surface's horizon. */
static ec_result horizon_lamp_case(ec_selftest *t, ec_error *err)
{
    ec_model *m = floor_model(0.5);
    if (m) {
        ec_material lamp = ec_material_lambert(0, 1);
        ec_model_quad(m, ec_model_material(m, &lamp), (double[3]){1, -2, -1.5}, (double[3]){0, 0, 3}, (double[3]){0, 4, 0});
        look_down(m, 0.5, 1e-3);
    }
    return direct_row(t, m, "", 256, EC_SAMPLE_MIS, 2 * wall_factor(2, 1.5, 1), err);
}

/* A single-sided lamp shines up, with a floor below it. */
static ec_result lamp_back_case(ec_selftest *t, ec_error *err)
{
    ec_model *m = floor_model(4);
    if (m) {
        ec_material lamp = ec_material_lambert(0, 1);
        ec_model_quad(m, ec_model_material(m, &lamp), (double[3]){-1, 1, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        look_down(m, 0.5, 1e-3);
    }
    return direct_row(t, m, "", 16, EC_SAMPLE_MIS, 0, err);
}

/* The lamp's solid angle is the whole hemisphere: the result is exactly its radiance. */
static ec_result surrounding_lamp_case(ec_selftest *t, ec_error *err)
{
    ec_model *m = floor_model(0.5);
    if (m) {
        ec_material lamp = ec_material_lambert(0, 1);
        ec_model_box(m, ec_model_material(m, &lamp), (double[3]){-2, -2, -2}, (double[3]){2, 2, 2}, true);
        look_down(m, 0.5, 1e-3);
    }
    return direct_row(t, m, "", 256, EC_SAMPLE_MIS, 1, err);
}

/* The table of lights has as many entries as the lamp has parts. */
static ec_result many_lamps_case(ec_selftest *t, ec_error *err)
{
    enum { PARTS = 707 };
    ec_model *m = floor_model(4);
    char what[32];
    if (m) {
        add_lamp(m, 1, 1, 1, PARTS);
        look_down(m, 0.5, 1e-3);
    }
    snprintf(what, sizeof what, "%d", 2 * PARTS * PARTS);
    return direct_row(t, m, what, 64, EC_SAMPLE_MIS, 4 * corner_factor(1, 1, 1), err);
}

/* A black wall before a white sky. */
static ec_result occlusion_case(ec_selftest *t, ec_error *err)
{
    ec_model *m = floor_model(0.5);
    ec_scene *scene;
    if (m) {
        ec_material black = ec_material_lambert(0, 0);
        ec_model_quad(m, ec_model_material(m, &black), (double[3]){1, 0, -100}, (double[3]){0, 0, 200}, (double[3]){0, 1, 0});
        look_down(m, 0.5, 1e-3);
    }
    EC_TRY(ec_model_scene(m, &scene, err));
    for (int k = 0; k < 3; k++) scene->environment.constant[k] = 1;
    scene->has_environment = true;
    ec_render_options o = ec_shot_options(t, 16, 256);
    o.max_depth = 2;
    return ec_shot_only_row(t, "", scene, &o, 1 - 2 * wall_factor(1, 100, 1), err);
}

/* A point light behind panes: each reflects Schlick's F = 0.04 + 0.96 (1 - c)^5, with a dozen roundings. */
static ec_result panes_case(ec_selftest *t, ec_error *err)
{
    static const int counts[2] = {1, 64};
    for (int i = 0; i < 2; i++) {
        ec_light light = {.type = EC_LIGHT_POINT, .intensity = {3, 3, 3}};
        ec_material pane = ec_material_default();
        ec_model *m = floor_model(1);
        ec_scene *scene;
        char what[32];
        pane.metallic = pane.roughness = 0;
        pane.transmission = 1;
        if (m) {
            int32_t material = ec_model_material(m, &pane);
            for (int k = 0; k < counts[i]; k++)
                ec_model_quad(m, material, (double[3]){-30, 0.6 + 0.9 * k / counts[i], 30}, (double[3]){60, 0, 0},
                              (double[3]){0, 0, -60});
            ec_model_light(m, &light, (double[3]){1.2, 1.6, 0}, (double[3]){0, 0, 0});
            look_down(m, 0.5, 1e-6);
        }
        EC_TRY(ec_model_scene(m, &scene, err));
        ec_render_options o = ec_shot_options(t, 4, 16);
        ec_shot shot;
        o.max_depth = 2 + (uint32_t)counts[i]; /* no light by reflections */
        o.more_effects |= EC_FEATURE_PANES;
        ec_result result = ec_shot_take(t, scene, &o, &shot, err);
        ec_scene_free(scene);
        EC_TRY(result);
        double expected = 3 * 0.8 / 4 / pi * pow(0.96 * (1 - pow(0.2, 5)), counts[i]);
        snprintf(what, sizeof what, "%d before a point", counts[i]);
        result = ec_selftest_value(t, what, expected, shot.mean, shot.noise,
                                   expected * ((20 + 12 * counts[i]) * 0x1p-24 + 2e-6), err);
        ec_shot_free(&shot);
        EC_TRY(result);
    }
    return EC_OK;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"lights/near lamp", false, near_lamp_case, "1/d^2 explodes next to a lamp (Arvo 1995; pbrt's 3e-4 sr)"},
        {"lights/tiny lamp", false, tiny_lamp_case, "1 - cos of a small angle is 0: small lamps go out"},
        {"lights/through the horizon", false, horizon_lamp_case, "light from below the surface's own horizon"},
        {"lights/back of a lamp", false, lamp_back_case, "single-sided lamps that shine from both sides"},
        {"lights/all around", false, surrounding_lamp_case, "lamps that fill the hemisphere"},
        {"lights/many", false, many_lamps_case, "tables of lights whose probabilities are not those sampled"},
        {"lights/occlusion", false, occlusion_case, "shadow rays that miss a wall (ambient occlusion, closed form)"},
        {"lights/panes", false, panes_case, "points and suns that light nothing behind a window"},
    };
    return RUN_CASES(cases);
}
