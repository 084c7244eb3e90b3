/* tier: full */
/* Environment maps whose light comes from next to nowhere. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gltf/model.h"
#include "robust/cases.h"
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

/* A floor under a map that is `sky` everywhere but in rows [dark, height), which are 0, and in one texel, the sun. */
static ec_result sun_row(ec_selftest *t, const char *what, uint32_t width, uint32_t height, uint32_t dark, float sky,
                         float sun, uint32_t sun_y, double expected, ec_error *err)
{
    ec_scene *scene;
    EC_TRY(ec_shot_floor(&scene, err));
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
static ec_result sun_case(ec_selftest *t, ec_error *err)
{
    const uint32_t width = 4096, height = width / 2, y = height / 5;
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

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"environment/sun", false, sun_case, "float tables lose dim texels, 0/0 in black rows (pbrt, Mitsuba)"},
    };
    return RUN_CASES(cases);
}
