/* tier: full */
/* Effects other than glass and metal in their hardest cases: coats and sheen at grazing angles, diffuse transmission, dispersive glass.
 * They share one build of kernels. */
#include <math.h>
#include <stdio.h>

#include "robust/cases.h"
#include "gltf/model.h"
#include "robust/scatter.h"
#include "selftest/shot.h"
#include "shared/features.h"

static ec_render_options options(const ec_selftest *t, uint32_t spp)
{
    ec_render_options o = ec_shot_options(t, 16, spp);
    o.more_effects |= EC_FEATURE_CLEARCOAT | EC_FEATURE_SHEEN | EC_FEATURE_DIFFUSE_TRANSMISSION | EC_FEATURE_DISPERSION;
    return o;
}

/* A wide plate of the material at z = 0, seen at one angle. `lamp`: radiance 1 behind it and none before it; otherwise 1 from everywhere. */
static ec_result plate(const ec_material *material, double cosine, bool lamp, ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    if (m) {
        ec_material black = ec_material_lambert(0, 1);
        ec_model_quad(m, ec_model_material(m, material), (double[3]){-90, -90, 0}, (double[3]){180, 0, 0}, (double[3]){0, 180, 0});
        if (lamp)
            ec_model_quad(m, ec_model_material(m, &black), (double[3]){-90, -90, -0.1}, (double[3]){180, 0, 0},
                          (double[3]){0, 180, 0});
        ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){20 * sqrt(1 - cosine * cosine), 0, 20 * cosine},
                        (double[3]){0, 0, 0}, 1e-5);
    }
    EC_TRY(ec_model_scene(m, scene, err));
    if (lamp) return EC_OK;
    for (int k = 0; k < 3; k++) (*scene)->environment.constant[k] = 1;
    (*scene)->has_environment = true;
    return EC_OK;
}

/* Estevez and Kulla 2017 at roughness 1, where the powers in the distribution and the fit are simple. */
static double shadowing(double cosine)
{
    double x = cosine < 0.5 ? cosine : 1 - cosine;
    double L = 21.5473 / (1 + 3.82987 * pow(x, 0.19823)) - 1.97760 * x - 4.32054;
    double half = 21.5473 / (1 + 3.82987 * pow(0.5, 0.19823)) - 1.97760 * 0.5 - 4.32054;
    return exp(cosine < 0.5 ? L : 2 * half - L);
}

/* E by the midpoint rule on n x n directions. */
static double sheen_albedo(double cosine, int n)
{
    double sum = 0, wo[3] = {sqrt(1 - cosine * cosine), 0, cosine}, own = shadowing(cosine);
    for (int band = 0; band < n; band++) {
        double z = (band + 0.5) / n, r = sqrt(1 - z * z), masked = 4 * cosine * (1 + own + shadowing(z));
        for (int sector = 0; sector < n; sector++) {
            double phi = EC_PI_DOUBLE * (sector + 0.5) / n, h[3] = {wo[0] + r * cos(phi), r * sin(phi), wo[2] + z};
            double sine2 = h[0] * h[0] + h[1] * h[1], D = 3 * sqrt(sine2 / (sine2 + h[2] * h[2])) / (2 * EC_PI_DOUBLE);
            sum += D / masked * 2 * EC_PI_DOUBLE / n / n;
        }
    }
    return sum;
}

/* Light that a white base returns from under white fibres: 1 - E, the smaller of both directions'. */
static double under_sheen(double cosine)
{
    enum { BANDS = 200 };
    double sum = 0, own = sheen_albedo(cosine, BANDS);
    for (int band = 0; band < BANDS; band++) {
        double z = (band + 0.5) / BANDS;
        sum += 2 * z * (1 - fmax(own, sheen_albedo(z, BANDS))) / BANDS;
    }
    return sum;
}

/* White fibres alone return the formula's value at all angles. On a white base, the light that they let pass returns too, with the error of
 * the fibres' table, 0.5 %. */
static ec_result sheen_case(ec_selftest *t, ec_error *err)
{
    static const double cosines[] = {1, 0.1, 0.01};
    for (int i = 0; i < 6; i++) {
        double cosine = cosines[i % 3];
        ec_material m = ec_material_lambert(i / 3, 0);
        ec_render_options o = options(t, 1024);
        ec_scene *scene;
        ec_shot shot;
        char what[48];
        for (int k = 0; k < 3; k++) m.sheen[k] = 1;
        m.sheen_roughness = 1;
        EC_TRY(plate(&m, cosine, false, &scene, err));
        snprintf(what, sizeof what, "%s, cos %g", i / 3 ? "on white" : "alone", cosine);
        ec_result result = ec_shot_take(t, scene, &o, &shot, err);
        ec_scene_free(scene);
        EC_TRY(result);
        double expected = sheen_albedo(cosine, 600) + (i / 3 ? under_sheen(cosine) : 0);
        result = ec_selftest_value(t, what, expected, shot.mean, shot.noise, 4 * shot.noise + (i / 3 ? 0.005 : 1e-4), err);
        ec_shot_free(&shot);
        EC_TRY(result);
    }
    return EC_OK;
}

/* A coat over black reflects 0.04 + 0.96 (1 - c)^5, also just above and below the width that counts as smooth, where masking takes 1e-8.
 * Over white, all light returns. */
static ec_result coat_case(ec_selftest *t, ec_error *err)
{
    static const double cosines[] = {1, 0.1, 0.01};
    for (int i = 0; i < 8; i++) {
        double cosine = i < 6 ? cosines[i % 3] : 0.5, share = 0.04 + 0.96 * pow(1 - cosine, 5);
        ec_material m = ec_material_lambert(i / 3 == 1, 0);
        ec_render_options o = options(t, 1024);
        ec_scene *scene;
        char what[48];
        m.coat = 1;
        m.coat_roughness = i < 6 ? 0 : (float)sqrt(i == 6 ? 0.99e-4 : 1.01e-4);
        EC_TRY(plate(&m, cosine, false, &scene, err));
        if (i < 6) snprintf(what, sizeof what, "over %s, cos %g", i / 3 ? "white" : "black", cosine);
        else snprintf(what, sizeof what, "of width %s", i == 6 ? "0.99e-4, smooth" : "1.01e-4, rough");
        EC_TRY(ec_shot_only_row(t, what, scene, &o, i / 3 == 1 ? 1 : share, err));
    }
    return EC_OK;
}

/* A white sheet before a wide lamp transmits its share of the light, and returns all light that comes from everywhere. Beyond the lamp's
 * edge, 0.1 behind and 90 away, is 1e-6 of the light. */
static ec_result diffuse_transmission_case(ec_selftest *t, ec_error *err)
{
    static const double shares[] = {0, 0.25, 1};
    for (int i = 0; i < 6; i++) {
        double share = shares[i % 3];
        ec_material m = ec_material_lambert(1, 0);
        ec_render_options o = options(t, 256);
        ec_scene *scene;
        char what[48];
        m.double_sided = true;
        m.diffuse_transmission = (float)share;
        for (int k = 0; k < 3; k++) m.transmission_color[k] = 1;
        EC_TRY(plate(&m, 0.6, i < 3, &scene, err));
        snprintf(what, sizeof what, i < 3 ? "share %g, passes" : "share %g, passes and returns", share);
        EC_TRY(ec_shot_only_row(t, what, scene, &o, i < 3 ? share : 1, err));
    }
    return EC_OK;
}

/* Index at the lines C, d and F (656.27, 587.56, 486.13 nm) by Cauchy's A + B / lambda^2, with 20 / V = dispersion. */
static double index_of(double d, double dispersion, int channel)
{
    static const double wavelength[3] = {0.65627, 0.58756, 0.48613};
    double at[3];
    for (int k = 0; k < 3; k++) at[k] = 1 / (wavelength[k] * wavelength[k]);
    return d + (d - 1) * dispersion / 20 * (at[channel] - at[1]) / (at[2] - at[0]);
}

/* A slab head-on before a lamp: its faces reflect each colour with that colour's index. A refracted path carries one of three colours,
 * which makes all the noise; the tolerance for all colours is green's. Index 1 has no dispersion. */
static ec_result dispersion_case(ec_selftest *t, ec_error *err)
{
    static const char *const colours[] = {"red", "green", "blue"};
    static const double indices[] = {1.5, 1};
    for (int i = 0; i < 2; i++) {
        ec_material glass = ec_material_default(), lamp = ec_material_lambert(0, 1);
        ec_model *m = ec_model_new();
        ec_render_options o = options(t, 4096);
        ec_scene *scene;
        ec_shot shot;
        glass.metallic = glass.roughness = 0;
        glass.transmission = 1;
        glass.volume = true;
        glass.ior = (float)indices[i];
        glass.dispersion = 4;
        if (m) {
            ec_model_box(m, ec_model_material(m, &glass), (double[3]){-90, -90, -0.4}, (double[3]){90, 90, 0}, false);
            ec_model_quad(m, ec_model_material(m, &lamp), (double[3]){-90, -90, -1}, (double[3]){180, 0, 0},
                          (double[3]){0, 180, 0});
            ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 20}, (double[3]){0, 0, 0}, 1e-5);
        }
        EC_TRY(ec_model_scene(m, &scene, err));
        ec_result result = ec_shot_take(t, scene, &o, &shot, err);
        ec_scene_free(scene);
        EC_TRY(result);
        for (int k = 0; k < 3 && result == EC_OK; k++) {
            double n = index_of(indices[i], 4, k), F = pow((n - 1) / (n + 1), 2), sum = 0,
                   pixels = (double)shot.film.width * shot.film.height;
            char what[48];
            for (uint32_t p = 0; p < (uint32_t)pixels; p++) sum += shot.rgb[3 * p + (uint32_t)k] / pixels;
            snprintf(what, sizeof what, "index %g, %s passes", indices[i], colours[k]);
            result = ec_selftest_value(t, what, 1 - 2 * F / (1 + F), sum, shot.noise, 4 * shot.noise + 1e-5, err);
        }
        ec_shot_free(&shot);
        EC_TRY(result);
    }
    return EC_OK;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/sheen", false, sheen_case, "velvet that glows or goes black at its rim"},
        {"scatter/coat", false, coat_case, "lacquer that makes light, or goes black at its rim"},
        {"scatter/diffuse transmission", false, diffuse_transmission_case, "leaves that lose light or shine on both sides"},
        {"scatter/dispersion", false, dispersion_case, "colours whose sum is not white (Cauchy's index by colour)"},
    };
    return RUN_CASES(cases);
}
