/* tier: quick */
/* Built-in environments: their amount and direction of light, and names that are refused. */
#include <math.h>

#include "scene/built_in.h"
#include "scene/scene.h"
#include "support/test.h"

#define PI 3.14159265358979323846

static ec_error err;

/* Integrals: radiance over all directions; irradiance of a horizontal plate from above, without the sun (radiance above `sun`) in `sky`. */
typedef struct light {
    double mean[3], flat[3], sky[3], brightest, towards[3];
} light;

static light light_of(const char *spec, double sun)
{
    light l = {.brightest = 0};
    ec_made_map map;
    CHECK_OK(ec_built_in_make(spec, &map, &err), err);
    for (uint32_t y = 0; y < map.height; y++)
        for (uint32_t x = 0; x < map.width; x++) {
            const float *rgb = map.rgb + 3 * ((size_t)y * map.width + x);
            const double w = ec_made_map_solid_angle(&map, y);
            double d[3];
            ec_made_map_direction(&map, x, y, d);
            if (rgb[1] > l.brightest) l.brightest = rgb[1], memcpy(l.towards, d, sizeof d);
            for (int c = 0; c < 3; c++) {
                CHECK(isfinite(rgb[c]) && rgb[c] >= 0);
                l.mean[c] += rgb[c] * w / (4 * PI);
                if (d[1] > 0) l.flat[c] += rgb[c] * w * d[1];
                if (d[1] > 0 && rgb[1] < sun) l.sky[c] += rgb[c] * w * d[1];
            }
        }
    free(map.rgb);
    return l;
}

static double luminance(const double rgb[3]) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

static void the_studio_is_grey_and_as_bright_as_white(void)
{
    const light l = light_of("studio", INFINITY);
    for (int c = 0; c < 3; c++) CHECK_MSG(fabs(l.mean[c] - 1) < 1e-4, "mean radiance %g", l.mean[c]);
    CHECK(l.towards[0] != 0 && l.brightest < 20);
}

/* A white plate gets pi from a sun at the zenith. With the sun at 45 degrees the sky gives 7 to 20 % (clear skies of CIE S 011: about 15
 * %), and is bluer than the sun. A sun near the horizon is red. */
static void the_sky_is_lit_by_its_sun(void)
{
    const light zenith = light_of("sky:0,90", 100), half = light_of("sky:30,45", 100), low = light_of("sky:-90,3", 100);
    const double share = luminance(half.sky) / luminance(half.flat);
    CHECK_MSG(fabs(luminance(zenith.flat) / PI - 1) < 0.01, "%g", luminance(zenith.flat) / PI);
    CHECK_MSG(share > 0.07 && share < 0.2, "the sky's share is %g", share);
    CHECK(half.sky[2] > 1.3 * half.sky[1] && half.sky[1] > 1.3 * half.sky[0]);
    CHECK(luminance(low.flat) < 0.1 * luminance(half.flat));
    CHECK(low.flat[0] - low.sky[0] > 3 * (low.flat[2] - low.sky[2]));
    /* azimuth from +z towards +x */
    const double at45[3] = {0.5 * sqrt(0.5), sqrt(0.5), sqrt(0.75 * 0.5)}, at3[3] = {-cos(3 * PI / 180), sin(3 * PI / 180), 0};
    for (int k = 0; k < 3; k++) CHECK(fabs(half.towards[k] - at45[k]) < 0.006 && fabs(low.towards[k] - at3[k]) < 0.006);
}

static void other_words_are_refused_or_files(void)
{
    static const char *const bad[] = {"sky:", "sky:1", "sky:1,91", "sky:1,-1", "sky:1,2,3", "sky:nan,2", "sky:1,2x", "sky:1e9,2", "sky:0x10,2"};
    ec_scene scene = {.environment = {.constant = {1, 2, 3}}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        CHECK_MSG(ec_is_built_in(bad[i]) && ec_scene_set_environment(&scene, bad[i], NULL, &err) == EC_FAILED, "%s", bad[i]);
        CHECK_MSG(strstr(err.text, "sky:AZIMUTH,ELEVATION"), "%s", err.text);
    }
    CHECK(!ec_is_built_in("./studio") && !ec_is_built_in("studio.exr") && !ec_is_built_in("sky.hdr") && !ec_is_built_in("1,1,1"));
    CHECK(scene.environment.constant[2] == 3 && !scene.has_environment); /* unchanged */
    CHECK_OK(ec_scene_set_environment(&scene, "studio", NULL, &err), err);
    CHECK(scene.has_environment && scene.environment.width == 512 && scene.environment.rgb);
    free(scene.environment.rgb);
}

int main(void)
{
    the_studio_is_grey_and_as_bright_as_white();
    the_sky_is_lit_by_its_sun();
    other_words_are_refused_or_files();
    TEST_END();
}
