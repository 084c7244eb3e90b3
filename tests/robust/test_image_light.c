/* tier: full */
/* Light of a cube map on a floor (EXT_lights_image_based). */
#include <math.h>
#include <stdlib.h>

#include "robust/cases.h"
#include "gltf/cube.h"
#include "gltf/model.h"
#include "selftest/shot.h"

enum { FACE = 64 };

/* Directions of a face's pixels, from OpenGL 4.6, table 8.19. */
static void face_direction(int face, double s, double t, double d[3])
{
    const double r[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
    for (int k = 0; k < 3; k++) d[k] = r[face][k] / sqrt(1 + s * s + t * t);
}

/* Radiance 1 + a . d in direction d. */
static bool draw_cube(const double a[3], ec_cube *cube)
{
    *cube = (ec_cube){.size = FACE};
    for (int f = 0; f < 6; f++) {
        if (!(cube->face[f] = malloc(3 * sizeof(float) * FACE * FACE))) return false;
        for (int i = 0; i < FACE * FACE; i++) {
            double d[3];
            face_direction(f, (2.0 * (i % FACE) + 1) / FACE - 1, (2.0 * (i / FACE) + 1) / FACE - 1, d);
            for (int k = 0; k < 3; k++) cube->face[f][3 * i + k] = (float)(1 + a[0] * d[0] + a[1] * d[1] + a[2] * d[2]);
        }
    }
    return true;
}

/* Irradiance from spherical harmonics of bands 0 and 1, divided by pi: 1 + 2/3 (R a) . n (Ramamoorthi and Hanrahan 2001). Between pixels h
 * = 2 / FACE apart, bilinear interpolation errs by h^2 / 8 times the second derivative, which is at most 1 along an arc and 2 along a face.
 * It happens twice: when the cube is resampled, and when the map is looked up. Beyond a face's edge a neighbour's pixels are off by half of
 * h / 4 times the slope, over strips h wide. Together that is below h^2 |a|. */
static ec_result cube_row(ec_selftest *t, const char *what, const double a[3], const double q[4], ec_error *err)
{
    double h = 2.0 / FACE, size = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]), tolerance = size * h * h;
    double up = 2 * (q[0] * q[1] + q[3] * q[2]) * a[0] + (1 - 2 * (q[0] * q[0] + q[2] * q[2])) * a[1] +
                2 * (q[1] * q[2] - q[3] * q[0]) * a[2];
    ec_cube cube;
    ec_scene *scene;
    ec_shot shot;
    EC_TRY(ec_shot_floor(&scene, err));
    ec_result result = draw_cube(a, &cube) ? EC_OK : ec_fail(err, "out of memory for a cube");
    if (result == EC_OK) result = ec_cube_environment(&cube, q, &scene->environment, err);
    ec_cube_free(&cube);
    ec_render_options o = ec_shot_options(t, 16, 256);
    o.max_depth = 2;
    scene->has_environment = true;
    if (result == EC_OK) result = ec_shot_take(t, scene, &o, &shot, err);
    ec_scene_free(scene);
    EC_TRY(result);
    result = ec_selftest_value(t, what, 1 + 2.0 / 3 * up, shot.mean, shot.noise, 4 * shot.noise + tolerance + 1e-5, err);
    ec_shot_free(&shot);
    return result;
}

static ec_result image_light_case(ec_selftest *t, ec_error *err)
{
    const double as_it_is[4] = {0, 0, 0, 1}, turned[4] = {0.5, -0.1, 0.7, 0.5}; /* of length 1 */
    EC_TRY(cube_row(t, "one radiance from everywhere", (double[3]){0}, turned, err));
    EC_TRY(cube_row(t, "brighter one way", (double[3]){0.3, 0.6, -0.4}, as_it_is, err));
    return cube_row(t, "brighter one way, turned", (double[3]){0.3, 0.6, -0.4}, turned, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"environment/cube", false, image_light_case, "image-based light mirrored, turned back to front, or seamed (EXT_lights_image_based)"},
    };
    return RUN_CASES(cases);
}
