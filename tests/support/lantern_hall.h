/* Many lamps, few of which matter at any place: a hall of chambers, each with lanterns of many colours and powers. */
#ifndef EC_TESTS_SUPPORT_LANTERN_HALL_H
#define EC_TESTS_SUPPORT_LANTERN_HALL_H

#include "base/random.h"
#include "gltf/model.h"
#include "support/render_case.h"

/* side x side chambers of 2 m, 1.5 m high, open to each other by half of each wall. Each chamber has `each` lanterns, octahedra of eight
 * triangles; every third one is a two-sided sheet of two. The camera is in a chamber in the middle; there is no roof. */
static inline ec_scene *lantern_hall(int side, int each)
{
    ec_error err = {0};
    ec_scene *scene;
    ec_model *m = ec_model_new();
    ec_material grey = ec_material_lambert(0.6, 0), lamp = ec_material_lambert(0.2, 1);
    int32_t wall = ec_model_material(m, &grey), lamps[6];
    uint64_t state = 11;
    double half = side;
    for (int i = 0; i < 6; i++) {
        double power = pow(10, i % 3 - 1);
        lamp.emission[0] = (float)(60 * power), lamp.emission[1] = (float)(40 * power), lamp.emission[2] = (float)(20 * power * (i + 1));
        lamp.double_sided = i >= 3;
        lamps[i] = ec_model_material(m, &lamp);
    }
    ec_model_quad(m, wall, (double[3]){-half, 0, half}, (double[3]){2 * half, 0, 0}, (double[3]){0, 0, -2 * half});
    for (int i = 0; i <= side; i++)
        for (int j = 0; j < side; j++) {
            double x = 2 * i - half, z = 2 * j - half;
            ec_model_box(m, wall, (double[3]){x - 0.05, 0, z}, (double[3]){x + 0.05, 1.5, z + 1.2}, false);
            ec_model_box(m, wall, (double[3]){z, 0, x - 0.05}, (double[3]){z + 1.2, 1.5, x + 0.05}, false);
        }
    for (int i = 0; i < side * side * each; i++) {
        double at[3], room[2] = {2 * (i / each % side) - half, 2 * (i / each / side) - half}, r = 0.01 + 0.02 * ec_random_unit(&state);
        for (int k = 0; k < 3; k++) at[k] = (k == 1 ? 0.1 : room[k / 2] + 0.15) + (k == 1 ? 1.2 : 1.7) * ec_random_unit(&state);
        int kind = (int)(3 * ec_random_unit(&state));
        if (i % 3) ec_model_sphere(m, lamps[kind], at, r, 0, false);
        else ec_model_quad(m, lamps[3 + kind], at, (double[3]){r, 0, 0}, (double[3]){0, r, 2 * r * ec_random_unit(&state) - r});
    }
    double x = 1 - half + 2 * (side / 2);
    ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){x + 0.8, 1.4, x + 0.8}, (double[3]){x - 0.7, 0.2, x - 0.5}, 1.1);
    if (ec_model_scene(m, &scene, &err) != EC_OK) case_end("lantern hall", &err);
    return scene;
}

#endif
