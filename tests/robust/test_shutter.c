/* tier: full */
/* A shutter with a lamp, and with an occluder, that moves. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "robust/cases.h"
#include "gltf/model.h"
#include "selftest/shot.h"

static const double pi = 3.14159265358979323846;

/* The first quad moves along y: from -1 to 0.5 in the first half of the exposure, to 1 in the second. */
static ec_result set_in_motion(ec_scene *scene, ec_error *err)
{
    static const float ways[] = {-1, 0.5f, 1};
    enum { KEYS = 3, TRIANGLES = 2 };
    ec_motion *m = &scene->motion;
    uint32_t n = scene->vertex_count;
    *m = (ec_motion){.segments = KEYS - 1, .vertex_count = n, .triangle_count = TRIANGLES, .positions = malloc(3 * KEYS * (size_t)n * sizeof(float)),
                     .swept = malloc(6 * TRIANGLES * sizeof(float))};
    if (!m->positions || !m->swept) return ec_fail(err, "out of memory for keys");
    for (uint32_t v = 0; v < n; v++) {
        bool moves = false;
        for (uint32_t i = 0; i < 3 * TRIANGLES; i++) moves |= scene->indices[i] == v;
        for (int key = 0; key < KEYS; key++)
            for (int k = 0; k < 3; k++)
                m->positions[3 * (KEYS * v + (uint32_t)key) + (uint32_t)k] =
                    scene->positions[3 * v + (uint32_t)k] + (moves && k == 1 ? ways[key] : 0);
    }
    for (uint32_t t = 0; t < TRIANGLES; t++)
        for (uint32_t k = 0; k < 3; k++) {
            float *low = &m->swept[6 * t + k], *high = low + 3;
            *low = INFINITY, *high = -INFINITY;
            for (uint32_t i = 0; i < 3 * KEYS; i++) {
                float x = m->positions[3 * (KEYS * scene->indices[3 * t + i % 3] + i / 3) + k];
                *low = fminf(*low, x), *high = fmaxf(*high, x);
            }
        }
    return EC_OK;
}

/* A strip 0.6 wide moves by at 3 per shutter time: it covers a point for a fifth of it. It is a lamp before the camera, or hides the sun
 * from a floor. Both BVHs, whose kernels read times separately. */
static ec_result shutter_case(ec_selftest *t, ec_error *err)
{
    static const char *const accels[] = {"bvh2", "bvh8"};
    for (int i = 0; i < 4; i++) {
        bool shades = i % 2;
        char what[32];
        ec_model *m = ec_model_new();
        ec_scene *scene;
        if (m) {
            ec_material strip = ec_material_lambert(0, shades ? 0 : 1), floor = ec_material_lambert(shades ? 1 : 0, 0);
            ec_light sun = {.type = EC_LIGHT_DIRECTIONAL, .intensity = {0, (float)(pi * sqrt(2)), 0}};
            double x = shades ? 0.5 : -0.5; /* between the floor and the sun, or the camera */
            ec_model_quad(m, ec_model_material(m, &strip), (double[3]){x, -0.3, 1}, (double[3]){1, 0, 0}, (double[3]){0, 0.6, 0});
            ec_model_quad(m, ec_model_material(m, &floor), (double[3]){-5, -5, 0}, (double[3]){10, 0, 0}, (double[3]){0, 10, 0});
            if (shades) ec_model_light(m, &sun, (double[3]){1, 0, 1}, (double[3]){0, 0, 0});
            ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0, 0, 4}, (double[3]){0, 0, 0}, 1e-4);
        }
        EC_TRY(ec_model_scene(m, &scene, err));
        ec_render_options o = ec_shot_options(t, 16, 256);
        ec_result result = set_in_motion(scene, err);
        o.accel = accels[i / 2];
        snprintf(what, sizeof what, "%s, %s", shades ? "shades" : "is seen", o.accel);
        if (result == EC_OK) result = ec_shot_row(t, what, scene, &o, shades ? 0.8 : 0.2, err);
        ec_scene_free(scene);
        EC_TRY(result);
    }
    return EC_OK;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"camera/shutter", false, shutter_case, "things that stand still for some rays while they move for others"},
    };
    return RUN_CASES(cases);
}
