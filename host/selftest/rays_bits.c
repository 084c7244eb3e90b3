/* The way of computing a picture must not show in it: every lane width and accelerator gives the same bits. */
#include <stdio.h>
#include <string.h>

#include "accel/accel.h"
#include "gltf/model.h"
#include "selftest/shot.h"

enum { SIZE = 16, NUMBERS = 3 * SIZE * SIZE };

/* A floor, a lamp, and a smooth ball in four places: turned, mirrored, sheared, and overlapping another. One accelerator keeps the mesh once, for the
 * others it is written out. */
static ec_result balls(ec_scene **scene, ec_error *err)
{
    static const double places[4][16] = {{0.3, 0, 0.4, 0, 0, 0.5, 0, 0, -0.4, 0, 0.3, 0, -0.8, 0.5, 0, 1},
                                         {-0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0.6, 0.5, 0.2, 1},
                                         {0.3, 0.2, 0, 0, -0.1, 0.4, 0, 0, 0, 0.3, 0.2, 0, 0, 0.4, 0.9, 1},
                                         {0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0.7, 0.6, 0.3, 1}};
    ec_model *m = ec_model_new();
    ec_material white = ec_material_lambert(0.7, 0), glow = ec_material_lambert(0, 5), metal = ec_material_default();
    metal.roughness = 0.4f;
    ec_model_instancing(m, EC_INSTANCING_ON);
    ec_model_quad(m, ec_model_material(m, &white), (double[3]){-2, 0, 2}, (double[3]){4, 0, 0}, (double[3]){0, 0, -4});
    ec_model_quad(m, ec_model_material(m, &glow), (double[3]){-1, 2, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
    int32_t material = ec_model_material(m, &metal);
    for (int i = 0; i < 4; i++) {
        ec_model_place(m, places[i]);
        if (i) ec_model_repeat(m);
        else ec_model_sphere(m, material, (double[3]){0, 0, 0}, 1, 2, true);
    }
    ec_model_place(m, NULL);
    ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0, 1.6, 3}, (double[3]){0, 0.4, 0}, 0.8);
    return ec_model_scene(m, scene, err);
}

static ec_result compare(ec_selftest *t, const ec_scene *scene, const ec_render_options *o, const ec_shot *first, uint64_t *other, char *note,
                         size_t size, ec_error *err)
{
    ec_shot shot;
    uint64_t before = *other;
    EC_TRY(ec_shot_take(t, scene, o, &shot, err));
    for (size_t i = 0; i < NUMBERS; i++) *other += memcmp(&shot.rgb[i], &first->rgb[i], sizeof shot.rgb[i]) != 0;
    if (!before && *other) snprintf(note, size, "first with %u lanes through %s", o->lanes, o->accel ? o->accel : "auto");
    ec_shot_free(&shot);
    return EC_OK;
}

/* Renders the balls with the defaults and the kernels that most cases share, then in other ways, with kernels for the effects needed, which must not
 * show either. lanes, accels: NULL keeps the default. */
static ec_result same_balls(ec_selftest *t, const uint32_t *lanes, const char *const *accels, uint32_t count, ec_error *err)
{
    ec_render_options o = ec_shot_options(t, SIZE, 16);
    uint64_t other = 0;
    char note[80] = "";
    ec_scene *scene;
    ec_shot first = {0};
    EC_TRY(balls(&scene, err));
    ec_result result = ec_shot_take(t, scene, &o, &first, err);
    o.more_effects = 0;
    for (uint32_t i = 0; i < count && result == EC_OK; i++) {
        if (lanes) o.lanes = lanes[i];
        if (accels) o.accel = accels[i];
        result = compare(t, scene, &o, &first, &other, note, sizeof note, err);
    }
    ec_scene_free(scene);
    ec_shot_free(&first);
    EC_TRY(result);
    return ec_selftest_none(t, "", other, (uint64_t)count * NUMBERS, note, err);
}

ec_result ec_selftest_lane_widths(ec_selftest *t, ec_error *err)
{
    static const uint32_t widths[] = {1, 4, 8, 16};
    return same_balls(t, widths, NULL, 4, err);
}

ec_result ec_selftest_accelerators(ec_selftest *t, ec_error *err)
{
    const char *names[EC_ACCEL_COUNT];
    for (int a = 0; a < EC_ACCEL_COUNT; a++) names[a] = ec_accels[a].name;
    return same_balls(t, NULL, names, EC_ACCEL_COUNT, err);
}
