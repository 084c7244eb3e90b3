/* tier: full */
/* Normals: the shading normal decides how much light arrives, the geometric one from which side. And frames around normals. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gltf/model.h"
#include "robust/cases.h"
#include "robust/exact_hit.h"
#include "selftest/shot.h"
#include "selftest/tracer.h"

#define NORMALS 32768u

/* A smooth ball of few facets, with a lamp outside and the camera inside: all light that the camera sees came through the surface. */
static ec_result smooth_leak_case(ec_selftest *t, ec_error *err)
{
    enum { SIZE = 16 };
    uint32_t lit = 0, spp = 1024;
    for (int metal = 0; metal < 2; metal++) {
        ec_model *m = ec_model_new();
        ec_scene *scene;
        ec_shot shot;
        ec_render_options o = ec_shot_options(t, SIZE, spp);
        if (m) {
            ec_material ball = metal ? ec_material_default() : ec_material_lambert(0.9, 0), glow = ec_material_lambert(0, 1000);
            ball.roughness = 0.3f;
            ball.double_sided = true;
            ec_model_sphere(m, ec_model_material(m, &ball), (double[3]){0, 0, 0}, 1, 1, true);
            ec_model_box(m, ec_model_material(m, &glow), (double[3]){-2, -2, -2}, (double[3]){2, 2, 2}, true);
            ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.1, 0.2, 0.3}, (double[3]){-1, -0.4, -0.7}, 2);
        }
        EC_TRY(ec_model_scene(m, &scene, err));
        ec_result result = ec_shot_take(t, scene, &o, &shot, err);
        ec_scene_free(scene);
        EC_TRY(result);
        for (int i = 0; i < SIZE * SIZE; i++) lit += !(shot.rgb[3 * i] == 0);
        ec_shot_free(&shot);
    }
    return ec_selftest_none(t, "", lit, 2 * (uint64_t)SIZE * SIZE * spp, "paths", err);
}

/* Frisvad's singular pole, its neighbours an ulp away, and random normals. */
static void put_normals(float *normals)
{
    static const float near[][3] = {{0, 0, -1}, {0x1p-24f, 0, -1}, {0, -0x1p-24f, -1}, {0x1p-12f, 0, -0x1.fffffep-1f},
                                    {0, 0, 1}, {-0.0f, 0, -1}, {1, 0, -0.0f}, {1, 0, 0}, {0, 1, 0x1p-126f}, {0, -1, -0x1p-126f},
                                    {0x1.6a09e6p-12f, 0x1.6a09e6p-12f, -0x1.fffffep-1f}};
    enum { NEAR = sizeof near / sizeof near[0] };
    uint64_t random = 11;
    for (uint32_t i = 0; i < NORMALS; i++) {
        const double nowhere[3] = {0, 0, 0};
        double d[3];
        float n[3];
        ec_direction(&random, d);
        if (i % 4 == 1) d[0] *= pow(10, -ec_random_between(&random, 0, 8)), d[1] *= pow(10, -ec_random_between(&random, 0, 8));
        ec_float_direction(nowhere, d, n);
        for (uint32_t k = 0; k < 3; k++) normals[k * NORMALS + i] = i < NEAR ? near[i][k] : n[k];
    }
}

/* Deviation from an orthonormal frame, beyond n's own deviation from unit length (its rounding, which the frame can only pass on). */
static double askew(const float *normals, const float *frames, uint32_t i)
{
    double v[3][3], worst = 0;
    for (uint32_t k = 0; k < 3; k++) {
        v[0][k] = normals[k * NORMALS + i];
        v[1][k] = frames[k * NORMALS + i];
        v[2][k] = frames[(3 + k) * NORMALS + i];
    }
    for (int a = 0; a < 3; a++)
        for (int b = a == 0; b <= a; b++) worst = ec_worse(worst, fabs(ec_dot(v[a], v[b]) - (a == b)));
    return worst;
}

/* Duff et al. 2017: no direction is singular. The tolerance is four ulp of 1. */
static ec_result frame_case(ec_selftest *t, ec_error *err)
{
    float *normals = calloc(3 * NORMALS, sizeof *normals), *frames = calloc(6 * NORMALS, sizeof *frames);
    uint32_t wave = NORMALS, at = 0;
    double worst = 0;
    char note[64];
    char *source = kernel_flatten("robust/frame.cl"), options[32];
    cl_program program = NULL;
    snprintf(options, sizeof options, "-DLANES=%u", t->lanes);
    ec_result result = normals && frames && source ? ec_program_build(t->cl, "frame", source, options, &program, err)
                                                   : ec_fail(err, "no memory for %u normals, or no kernel", NORMALS);
    free(source);
    if (result == EC_OK) {
        const ec_array arrays[] = {EC_SCALAR(wave), EC_IN(normals, 3 * NORMALS), EC_OUT(frames, 6 * NORMALS)};
        put_normals(normals);
        result = ec_kernel_call(t->cl, program, "frame", wave / t->lanes, 64, arrays, 3, err);
    }
    for (uint32_t i = 0; i < NORMALS && result == EC_OK; i++) {
        double off = askew(normals, frames, i);
        if (!(off <= worst)) worst = off, at = i;
    }
    if (result == EC_OK)
        snprintf(note, sizeof note, "at n = (%g, %g, %g)", (double)normals[at], (double)normals[wave + at],
                 (double)normals[2 * wave + at]);
    if (program) clReleaseProgram(program);
    free(normals);
    free(frames);
    EC_TRY(result);
    return ec_selftest_largest(t, "", worst, 8 * 0x1p-24, note, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"rays/smooth leak", false, smooth_leak_case, "light through a surface whose bent normal decides the side"},
        {"rays/frame", false, frame_case, "a frame that is singular at -z (Frisvad 2012; Duff et al. 2017)"},
    };
    return RUN_CASES(cases);
}
