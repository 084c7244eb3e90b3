/* A closed room with a lamp, a block and a ball, at any place and of any size. Pictures and hits must not depend on these. */
#ifndef EC_TESTS_ROBUST_ROOM_H
#define EC_TESTS_ROBUST_ROOM_H

#include "gltf/model.h"

typedef struct ec_room {
    double scale;          /* factor of the coordinates in the file; 0 counts as 1 */
    double offset;         /* added to all coordinates */
    double matrix[16];     /* matrix of the node above; only its linear part may rotate, mirror or be the identity */
    bool has_matrix;
} ec_room;

static inline double ec_room_factor(const ec_room *room) { return room->scale > 0 ? room->scale : 1; }

/* Converts to the file's coordinates. */
static inline void ec_room_in_file(const ec_room *room, const double p[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = ec_room_factor(room) * p[k] + room->offset;
}

static inline void ec_room_box(ec_model *m, const ec_room *room, int32_t material, const double low[3], const double high[3], bool inwards)
{
    double from[3], to[3];
    ec_room_in_file(room, low, from);
    ec_room_in_file(room, high, to);
    ec_model_box(m, material, from, to, inwards);
}

/* In its own frame the room reaches from -1 to 1. */
static inline ec_result ec_room_scene(const ec_room *room, ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    double scale = ec_room_factor(room), at[3], target[3];
    if (m) {
        ec_material white = ec_material_lambert(0.7, 0), glow = ec_material_lambert(0.2, 5), metal = ec_material_default();
        metal.roughness = 0.4f;
        int32_t walls = ec_model_material(m, &white);
        if (room->has_matrix) ec_model_place(m, room->matrix);
        ec_room_box(m, room, walls, (double[3]){-1, -1, -1}, (double[3]){1, 1, 1}, true);
        ec_room_box(m, room, walls, (double[3]){-0.7, -0.99, -0.6}, (double[3]){-0.1, 0.1, 0.03}, false);
        ec_room_in_file(room, (double[3]){-0.3, 0.98, -0.25}, at);
        ec_model_quad(m, ec_model_material(m, &glow), at, (double[3]){0.5 * scale, 0, 0}, (double[3]){0, 0, 0.7 * scale});
        ec_room_in_file(room, (double[3]){0.4, -0.5, 0.1}, at);
        ec_model_sphere(m, ec_model_material(m, &metal), at, 0.4 * scale, 2, false);
        ec_room_in_file(room, (double[3]){0.1, 0.2, 0.9}, at);
        ec_room_in_file(room, (double[3]){0, -0.2, -0.5}, target);
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, at, target, 1.1);
    }
    return ec_model_scene(m, scene, err);
}

/* Transforms a point or direction of that frame by scale and matrix. */
static inline void ec_room_moved(const ec_room *room, const double p[3], double moved[3])
{
    for (int row = 0; row < 3; row++) {
        moved[row] = room->has_matrix ? 0 : ec_room_factor(room) * p[row];
        for (int column = 0; column < 3 && room->has_matrix; column++)
            moved[row] += room->matrix[4 * column + row] * ec_room_factor(room) * p[column];
    }
}

#endif
