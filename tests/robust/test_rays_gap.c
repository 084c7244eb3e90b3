/* tier: full */
/* Rays that leave a surface do not start behind the next surface. */
#include <math.h>
#include <stdio.h>

#include "robust/cases.h"
#include "gltf/model.h"
#include "selftest/shot.h"

/* A tenth of a turn about a skew axis: no coordinate stays a round number. */
static void tilt(double m[16])
{
    const double axis[3] = {0.36, 0.48, 0.8}, c = cos(0.6), s = sin(0.6);
    for (int k = 0; k < 16; k++) m[k] = k == 15;
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++) m[4 * column + row] = axis[row] * axis[column] * (1 - c) + (row == column ? c : 0);
    for (int k = 0; k < 3; k++) {
        m[4 * k + (k + 1) % 3] += s * axis[(k + 2) % 3];
        m[4 * ((k + 1) % 3) + k] -= s * axis[(k + 2) % 3];
    }
}

/* Two plates, a lamp behind the upper one, and a camera between them. The largest coordinate is 2, and below 4 when rotated: both have the
 * ulp 2^-22. */
static ec_result plates(double gap, bool tilted, ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    double turned[16];
    tilt(turned);
    if (m) {
        ec_material plate = ec_material_lambert(0.8, 0), glow = ec_material_lambert(0, 100);
        plate.double_sided = true;
        int32_t plates = ec_model_material(m, &plate);
        ec_model_place(m, tilted ? turned : NULL);
        ec_model_quad(m, plates, (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        ec_model_quad(m, plates, (double[3]){-1, gap, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
        ec_model_quad(m, ec_model_material(m, &glow), (double[3]){-0.5, 4, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.1, gap / 2, 0.05}, (double[3]){0.3, gap / 2 - 1, 0.1}, 1.2);
    }
    return ec_model_scene(m, scene, err);
}

enum { SIZE = 8, SAMPLES = 1024 };

static ec_result lit_pixels(ec_selftest *t, double ulps, bool tilted, uint32_t *lit, ec_error *err)
{
    ec_scene *scene;
    ec_shot shot;
    ec_render_options o = ec_shot_options(t, SIZE, SAMPLES);
    EC_TRY(plates(ulps * 0x1p-22, tilted, &scene, err));
    ec_result result = ec_shot_take(t, scene, &o, &shot, err);
    ec_scene_free(scene);
    EC_TRY(result);
    *lit = 0;
    for (int i = 0; i < SIZE * SIZE; i++) *lit += !(shot.rgb[3 * i] == 0);
    ec_shot_free(&shot);
    return EC_OK;
}

/* A gap below four ulp has no room for a camera. Offsets that are too large pass through the plate: those of Waechter and Binder are 25
 * times as long. */
static ec_result gap_case(ec_selftest *t, ec_error *err)
{
    for (int tilted = 0; tilted < 2; tilted++) {
        uint32_t lit = 0, sum = 0, shots = 0;
        double ulps = 16384;
        char note[64];
        for (; ulps >= 64; ulps /= 2, shots++) {
            EC_TRY(lit_pixels(t, ulps, tilted, &lit, err));
            sum += lit;
        }
        for (; ulps >= 4 && !lit; ulps /= 2) EC_TRY(lit_pixels(t, ulps, tilted, &lit, err));
        snprintf(note, sizeof note, "paths; dark from %g ulp of the largest coordinate", 2 * ulps * (lit ? 2 : 1));
        EC_TRY(ec_selftest_none(t, tilted ? "tilted" : "level", sum, (uint64_t)shots * SIZE * SIZE * SAMPLES, note, err));
    }
    return EC_OK;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"rays/gap", false, gap_case, "light leaks through thin walls by offsets that are too long"},
    };
    return RUN_CASES(cases);
}
