/* Environment maps: light that comes from next to nowhere, and a cube's (EXT_lights_image_based). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/cube.h"
#include "scene/model.h"
#include "selftest/shot.h"

static const double pi = 3.14159265358979323846;

/* Integral of cos over the hemisphere about +y of a texel's bilinear tent, of height 1 at the centre of (x, y): it spans two
 * texels each way. Its longitude integrates to one texel; that of its latitude by Simpson's rule over each half. */
static double tent_irradiance(uint32_t width, uint32_t height, uint32_t y)
{
    double step = pi / height, sum = 0;
    const int n = 64;
    for (int half = 0; half < 2; half++)
        for (int i = 0; i <= n; i++) {
            double u = (double)i / n, weight = (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) / (3.0 * n);
            double theta = (y + 0.5 + (half ? u : u - 1)) * step;
            sum += weight * step * (half ? 1 - u : u) * fmax(cos(theta), 0) * sin(theta);
        }
    return sum * 2 * pi / width;
}

/* A white floor, seen from above. */
static ec_result floor_from_above(ec_scene **scene, ec_error *err)
{
    ec_model *m = ec_model_new();
    if (m) {
        ec_material white = ec_material_lambert(1, 0);
        ec_model_quad(m, ec_model_material(m, &white), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 1, 0}, (double[3]){0, 0, 0}, 0.5);
    }
    return ec_model_scene(m, scene, err);
}

/* A floor under a map that is `sky` everywhere but in rows [dark, height), which are 0, and in one texel, the sun. */
static ec_result sun_row(ec_selftest *t, const char *what, uint32_t width, uint32_t height, uint32_t dark, float sky,
                         float sun, uint32_t sun_y, double expected, ec_error *err)
{
    ec_scene *scene;
    EC_TRY(floor_from_above(&scene, err));
    float *rgb = malloc((size_t)width * height * 3 * sizeof *rgb);
    ec_result result = rgb ? EC_OK : ec_fail(err, "out of memory for a map of %ux%u", width, height);
    if (rgb) {
        for (size_t i = 0; i < 3 * (size_t)width * height; i++) rgb[i] = i / 3 / width < dark ? sky : 0;
        for (int k = 0; k < 3; k++) rgb[3 * ((size_t)sun_y * width + width / 3) + (size_t)k] = sun;
        scene->environment = (ec_environment){.width = width, .height = height, .rgb = rgb};
        scene->has_environment = true;
        ec_render_options o = ec_shot_options(t, 16, 256);
        o.max_depth = 2;
        result = ec_shot_row(t, what, scene, &o, expected, err);
    }
    ec_scene_free(scene);
    return result;
}

/* All of the irradiance divided by pi, since the floor is white. */
ec_result ec_selftest_sun(ec_selftest *t, ec_error *err)
{
    uint32_t width = t->full ? 4096 : 512, height = width / 2, y = height / 5;
    double one = tent_irradiance(width, height, y) / pi;
    EC_TRY(sun_row(t, "one texel of 1e6, the rest 1", width, height, height, 1, 1e6f, y, 1 + (1e6 - 1) * one, err));
    EC_TRY(sun_row(t, "one texel of 1e6, the rest 0", width, height, 0, 0, 1e6f, y, 1e6 * one, err));
    /* The rows down to 60 degrees are 1, the others 0; the tent between row and row turns the edge into a ramp of the same cut:
     * its cosine integral is that of an edge at the texels' border, but for the square of a row's height. */
    uint32_t dark = height / 3;
    double edge = pi * dark / height, rows = pi / height, cut = 0;
    for (int i = 0; i < 2; i++) { /* Simpson's rule over the ramp, from 1 to 0 about the border */
        double a = edge + (i - 1) * 0.5 * rows, b = a + 0.5 * rows, middle = 0.5 * (a + b);
        double f[3] = {a, middle, b};
        for (int k = 0; k < 3; k++) cut += (k == 1 ? 4 : 1) / 6.0 * 0.5 * rows * (0.5 - (f[k] - edge) / rows) * sin(2 * f[k]);
    }
    double lit = 0.5 * (1 - cos(2 * (edge - 0.5 * rows)));
    return sun_row(t, "rows of zeros", width, height, dark, 1, 1, 0, lit + cut, err);
}

enum { FACE = 64 };

/* Directions of a face's pixels as OpenGL 4.6 has them, table 8.19. */
static void face_direction(int face, double s, double t, double d[3])
{
    const double r[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
    for (int k = 0; k < 3; k++) d[k] = r[face][k] / sqrt(1 + s * s + t * t);
}

/* 1 + a . d in direction d. */
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

/* What irradiance coefficients of bands 0 and 1 would say: over pi, 1 + 2/3 (R a) . n (Ramamoorthi and Hanrahan 2001). Between pixels
 * h = 2 / FACE apart bilinear interpolation errs by h^2 / 8 times the second derivative, at most 1 along an arc and 2 along a face, each
 * way: when the cube is unrolled, and again when the map is looked up. With what a neighbour's pixels are off past an edge, half of h / 4
 * times the slope over strips h wide, that stays under h^2 |a|. */
static ec_result cube_row(ec_selftest *t, const char *what, const double a[3], const double q[4], ec_error *err)
{
    double h = 2.0 / FACE, size = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]), tolerance = size * h * h;
    double up = 2 * (q[0] * q[1] + q[3] * q[2]) * a[0] + (1 - 2 * (q[0] * q[0] + q[2] * q[2])) * a[1] +
                2 * (q[1] * q[2] - q[3] * q[0]) * a[2];
    ec_cube cube;
    ec_scene *scene;
    ec_shot shot;
    EC_TRY(floor_from_above(&scene, err));
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

ec_result ec_selftest_image_light(ec_selftest *t, ec_error *err)
{
    const double as_it_is[4] = {0, 0, 0, 1}, turned[4] = {0.5, -0.1, 0.7, 0.5}; /* of length 1 */
    EC_TRY(cube_row(t, "one radiance from everywhere", (double[3]){0}, turned, err));
    EC_TRY(cube_row(t, "brighter one way", (double[3]){0.3, 0.6, -0.4}, as_it_is, err));
    return cube_row(t, "brighter one way, turned", (double[3]){0.3, 0.6, -0.4}, turned, err);
}
