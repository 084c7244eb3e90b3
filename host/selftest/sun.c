/* An environment map most of whose light comes from next to nowhere. */
#include <math.h>
#include <stdlib.h>

#include "gltf/model.h"
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

/* A white floor under a map that is 1 everywhere but in one texel, the sun. All of the irradiance divided by pi. */
ec_result ec_selftest_sun(ec_selftest *t, ec_error *err)
{
    const uint32_t width = t->full ? 4096 : 512, height = width / 2, y = height / 5;
    const float sun = 1e6f;
    ec_scene *scene;
    float *rgb = malloc((size_t)width * height * 3 * sizeof *rgb);
    if (!rgb) return ec_fail(err, "out of memory for a map of %ux%u", width, height);
    for (size_t i = 0; i < 3 * (size_t)width * height; i++) rgb[i] = i / 3 == (size_t)y * width + width / 3 ? sun : 1;
    if (ec_shot_floor(&scene, err) != EC_OK) {
        free(rgb);
        return EC_FAILED;
    }
    scene->environment = (ec_environment){.width = width, .height = height, .rgb = rgb};
    scene->has_environment = true;
    ec_render_options o = ec_shot_options(t, 16, 256);
    o.max_depth = 2;
    return ec_shot_only_row(t, "one texel of 1e6, the rest 1", scene, &o, 1 + ((double)sun - 1) * tent_irradiance(width, height, y) / pi, err);
}
