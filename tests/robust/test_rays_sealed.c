/* tier: full */
/* Rays in a closed room of planes without thickness stay in it. */
#include <math.h>
#include <stdio.h>

#include "gltf/model.h"
#include "robust/cases.h"
#include "selftest/shot.h"

enum { SIZE = 16, SAMPLES = 2048, SEGMENTS = 12 };

/* How the walls of a room meet: at shared corners; or in strips, the edge of one along those of three others. */
typedef enum meeting { SHARED, TILED } meeting;
static const char *const meeting_names[] = {"shared corners", "strips"};

typedef struct place {
    const char *name;
    bool tilted;
    double far;   /* where else there is something: what is large has coarse floats */
    double tall;  /* height of the room, whose floor is 2 x 2 */
} place;
static const place places[] = {{"level", false, 0, 2}, {"tilted", true, 0, 2}, {"low", true, 0, 0.02}, {"far", true, 1000, 2}};
enum { PLACES = sizeof places / sizeof *places };

/* A turn of `angle` about a skew axis: no coordinate of what is in it stays round. */
static void turn(double angle, double m[16])
{
    const double axis[3] = {0.36, 0.48, 0.8}, c = cos(angle), s = sin(angle);
    for (int k = 0; k < 16; k++) m[k] = k == 15;
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++) m[4 * column + row] = axis[row] * axis[column] * (1 - c) + (row == column ? c : 0);
    for (int k = 0; k < 3; k++) {
        m[4 * k + (k + 1) % 3] += s * axis[(k + 2) % 3];
        m[4 * ((k + 1) % 3) + k] -= s * axis[(k + 2) % 3];
    }
}

/* Corner k of a box: bit i of k says at which end of axis i. */
static void shared_walls(ec_model *m, int32_t material, const float half[3])
{
    static const uint32_t corners[36] = {0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5};
    float positions[24];
    for (int k = 0; k < 24; k++) positions[k] = (k / 3 >> k % 3 & 1) ? half[k % 3] : -half[k % 3];
    ec_model_add(m, material, &(ec_model_mesh){.vertex_count = 8, .index_count = 36, .positions = positions, .indices = corners});
}

/* Walls of three strips, none of whose corners is on those of another wall but at the room's ends. */
static void tiled_walls(ec_model *m, int32_t material, const float half[3])
{
    for (int axis = 0; axis < 3; axis++)
        for (int strip = 0; strip < 6; strip++) {
            static const double cuts[3][4] = {{-1, -0.25, 0.375, 1}, {-1, -0.5, 0.625, 1}, {-1, 0.125, 0.25, 1}};
            double at[3], u[3] = {0}, v[3] = {0};
            int a = (axis + 1) % 3, b = (axis + 2) % 3, k = strip / 2;
            at[axis] = strip % 2 ? half[axis] : -half[axis];
            at[a] = cuts[axis][k] * half[a], at[b] = -half[b];
            u[a] = (cuts[axis][k + 1] - cuts[axis][k]) * half[a], v[b] = 2 * half[b];
            ec_model_quad(m, material, at, u, v);
        }
}

static ec_result sealed_room(meeting how, const place *where, ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    double turned[16];
    turn(0.6, turned);
    if (m) {
        const float half[3] = {1, (float)(where->tall / 2), 1};
        ec_material wall = ec_material_lambert(0.9, 0);
        wall.double_sided = true;
        int32_t walls = ec_model_material(m, &wall);
        ec_model_place(m, where->tilted ? turned : NULL);
        if (how == SHARED)
            shared_walls(m, walls, half);
        else
            tiled_walls(m, walls, half);
        double away = where->far;
        if (away > 0)
            ec_model_quad(m, walls, (double[3]){away, away, away}, (double[3]){1, 0, 0}, (double[3]){0, 1, 0});
        ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.3, 0.2 * half[1], 0.4}, (double[3]){-0.5, -half[1], -0.7}, 2.4);
    }
    EC_TRY(ec_model_scene(m, scene, err));
    ec_result result = ec_scene_set_environment(*scene, "1,1,1", NULL, err);
    if (result != EC_OK) ec_scene_free(*scene);
    return result;
}

static ec_result room_row(ec_selftest *t, meeting how, const place *where, const char *accel, uint32_t lanes, ec_error *err)
{
    ec_scene *scene;
    ec_shot shot;
    ec_render_options o = ec_shot_options(t, SIZE, SAMPLES);
    char name[96];
    snprintf(name, sizeof name, "%s, %s, %s, %u", meeting_names[how], where->name, accel, lanes);
    o.max_depth = SEGMENTS;
    o.accel = accel;
    o.lanes = lanes;
    EC_TRY(sealed_room(how, where, &scene, err));
    ec_result result = ec_shot_take(t, scene, &o, &shot, err);
    ec_scene_free(scene);
    EC_TRY(result);
    uint64_t lit = 0;
    for (int i = 0; i < SIZE * SIZE; i++) lit += !(shot.rgb[3 * i] == 0);
    char note[64];
    snprintf(note, sizeof note, "of %d pixels; mean %.3g", SIZE * SIZE, shot.mean);
    uint64_t rays = shot.stats.rays;
    ec_shot_free(&shot);
    return ec_selftest_none(t, name, lit, rays, note, err);
}

/* Walls that share corners have no gaps wherever they are. Those of strips have some where rounding moves their corners: not here. */
static ec_result sealed_case(ec_selftest *t, ec_error *err)
{
    static const char *const accels[] = {"bvh8", "bvh2", "grid", "kdtree", "none", "twolevel"};
    static const uint32_t lanes[] = {1, 8, 16};
    for (int k = 0; k < 18; k++)
        for (int how = SHARED; how <= TILED; how++) {
            const place *where = &places[how == SHARED ? k % PLACES : k % 3];
            EC_TRY(room_row(t, how, where, accels[k % 6], lanes[k / 6], err));
        }
    return EC_OK;
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"rays/sealed", false, sealed_case, "the sun shines into closed rooms along their edges"},
    };
    return RUN_CASES(cases);
}
