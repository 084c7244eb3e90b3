/* Renders an environment map most of whose light comes from almost a single point. */
#include "selftest/sun.h"

#include <math.h>
#include <stdlib.h>

#include "selftest/shot.h"

static const double pi = 3.14159265358979323846;

/* The tent spans two texels in each direction. Its longitude integrates to one texel; its latitude by Simpson's rule over each half. */
double ec_sun_irradiance(uint32_t width, uint32_t height, uint32_t y)
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

ec_result ec_sun_row(ec_selftest *t, const char *what, const ec_sun_map *map, double expected, ec_error *err)
{
    const size_t width = map->width, texels = width * map->height;
    ec_scene *scene;
    EC_TRY(ec_shot_floor(&scene, err));
    float *rgb = malloc(3 * texels * sizeof *rgb);
    ec_result result = rgb ? EC_OK : ec_fail(err, "out of memory for a map of %ux%u", map->width, map->height);
    if (rgb) {
        for (size_t i = 0; i < 3 * texels; i++) rgb[i] = i / 3 / width < map->dark ? map->sky : 0;
        for (int k = 0; k < 3; k++) rgb[3 * (map->sun_y * width + width / 3) + (size_t)k] = map->sun;
        scene->environment = (ec_environment){.width = map->width, .height = map->height, .rgb = rgb};
        scene->has_environment = true;
        ec_render_options o = ec_shot_options(t, 16, 256);
        o.max_depth = 2;
        result = ec_shot_row(t, what, scene, &o, expected, err);
    }
    ec_scene_free(scene);
    return result;
}

/* The floor is white, so its radiance is the irradiance divided by pi. */
ec_result ec_selftest_sun(ec_selftest *t, ec_error *err)
{
    const uint32_t width = t->full ? 4096 : 512, height = width / 2, y = height / 5;
    const ec_sun_map map = {.width = width, .height = height, .dark = height, .sky = 1, .sun = 1e6f, .sun_y = y};
    return ec_sun_row(t, "one texel of 1e6, the rest 1", &map, 1 + (1e6 - 1) * ec_sun_irradiance(width, height, y) / pi, err);
}
