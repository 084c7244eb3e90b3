/* tiers: quick, full */
/* Direct light against closed forms: Lambert's formula, inverse squares, environments. Scenes are made here, so that every number in a
 * check is beside its derivation. (Lamps that touch the surface they light: test_near_lamps.c.) */
#include "support/floor_case.h"

/* Radiance 1 from triangles on a Lambertian floor of albedo 0.5; numbers from Nori's polylum.py. */
static void check_polylum(uint32_t spp)
{
    static const double expected[3] = {0.0898394, 0.02292, 0.0534198};
    for (int i = 0; i < 3; i++) {
        char path[512];
        snprintf(path, sizeof path, SHARED("assets/classic/gltf/direct-nori/polylum%d.gltf"), i + 1);
        if (case_present(path)) check_point(path, NULL, expected[i], SKILLED, spp, 4e-3);
    }
}

/* Triangles anywhere above the floor, from a fixed sequence. */
static void check_random_triangles(void)
{
    uint32_t state = 12345;
    for (int i = 0; i < 6; i++) {
        double p[3][3], e[2][3];
        for (int v = 0; v < 9; v++) {
            state = state * 1664525u + 1013904223u;
            p[v / 3][v % 3] = (state >> 8) / 16777216.0 * 2 - (v % 3 == 1 ? -0.3 : 1);
        }
        for (int k = 0; k < 3; k++) {
            e[0][k] = p[1][k] - p[0][k];
            e[1][k] = p[2][k] - p[0][k];
        }
        double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                       e[0][0] * e[1][1] - e[0][1] * e[1][0]};
        int faces_floor = n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2] < 0;
        gltf_writer *w = floor_scene(0.2);
        float positions[9];
        for (int v = 0; v < 9; v++) positions[v] = (float)p[v / 3][v % 3];
        gltf_triangles(w, gltf_lambert(w, 0, 2), &(gltf_mesh){3, positions, NULL, NULL, NULL});
        char name[64];
        snprintf(name, sizeof name, "direct-triangle-%d", i);
        double expected = faces_floor ? 0.6 * 2 / PI * lambert((const double(*)[3])p, 3, up) : 0; /* no light from behind */
        check_point(gltf_write(w, name), NULL, expected, SKILLED, 8192, 5e-3);
        free(w);
    }
}

/* A bulb of eight triangles, whose sides that face away are never sampled. It is beside the point, above it, or so near that some triangles
 * are below the horizon of others. One side is bright. */
static void check_bulb(int i)
{
    static const double middles[3][3] = {{0.4, 1.2, -0.3}, {0, 0.7, 0}, {0.9, 0.35, 0.2}};
    const double r = 0.3, *middle = middles[i];
    gltf_writer *w = floor_scene(0.2);
    const int materials[2] = {gltf_lambert(w, 0, 2), gltf_lambert(w, 0, 5)};
    double expected = 0;
    for (int side = 0; side < 8; side++) {
        double p[3][3];
        float positions[9];
        const int sign[3] = {side & 1 ? 1 : -1, side & 2 ? 1 : -1, side & 4 ? 1 : -1}, is_odd = sign[0] * sign[1] * sign[2] < 0;
        for (int v = 0; v < 3; v++)
            for (int k = 0; k < 3; k++) p[v][k] = middle[k] + (k == (is_odd ? 2 - v : v) ? sign[k] * r : 0);
        for (int v = 0; v < 9; v++) positions[v] = (float)p[v / 3][v % 3];
        gltf_triangles(w, materials[side == 7], &(gltf_mesh){3, positions, NULL, NULL, NULL});
        double facing = 0; /* the side of the plane on which the origin is */
        for (int k = 0; k < 3; k++) facing += sign[k] * (middle[k] + sign[k] * r / 3);
        if (facing < 0) expected += 0.6 * (side == 7 ? 5 : 2) / PI * lambert((const double(*)[3])p, 3, up);
    }
    char name[64];
    snprintf(name, sizeof name, "direct-bulb-%d", i);
    const char *path = gltf_write(w, name);
    check_point(path, NULL, expected, SKILLED, 8192, 5e-3);
    ec_scene *scene = case_load(path, NULL);
    ec_render_options o = case_options(8, 8, 16);
    o.max_depth = 2;
    case_image image = case_render(scene, &o);
    CHECK(strstr(case_effects(&image), "lamp-pairs"));
    case_free(&image);
    ec_scene_free(scene);
    free(w);
}

/* KHR_lights_punctual, 1 cd = 1 W/sr: albedo / pi times I cos / d^2, exactly. */
static void check_punctual(void)
{
    static const double position[3] = {1, 2, 2}; /* d = 3, cos = 2/3 */
    static const double towards[3] = {-1, -2, -2};
    const double plain = 0.6 / PI * (2.0 / 3) / 9;
    gltf_writer *w = floor_scene(0.5);
    gltf_light(w, position, towards, "{\"type\":\"point\",\"intensity\":90}");
    check_point(gltf_write(w, "direct-point"), NULL, 90 * plain, ALL, 16, 1e-5);
    free(w);

    w = floor_scene(0.5); /* range 4: (1 - (d / r)^4) / d^2 */
    gltf_light(w, position, towards, "{\"type\":\"point\",\"intensity\":90,\"range\":4}");
    check_point(gltf_write(w, "direct-point-range"), NULL, 90 * plain * (1 - pow(0.75, 4)), ALL, 16, 1e-5);
    free(w);

    w = floor_scene(0.5); /* beyond its range */
    gltf_light(w, position, towards, "{\"type\":\"point\",\"intensity\":90,\"range\":2.9}");
    check_point(gltf_write(w, "direct-point-out-of-range"), NULL, 0, ALL, 16, 1e-5);
    free(w);

    /* Spots rotated away by 0.2 rad (within the plane of axis and y): inside the inner cone, between both cones, outside. */
    static const double inner[3] = {0.3, 0.1, 0.05}, outer[3] = {0.5, 0.4, 0.1};
    double axis[3], length = 3, side[3] = {-2 / sqrt(5), 1 / sqrt(5), 0}; /* perpendicular to `towards` */
    for (int i = 0; i < 3; i++) {
        char json[160], name[64];
        for (int k = 0; k < 3; k++) axis[k] = cos(0.2) * towards[k] / length + sin(0.2) * side[k];
        double t = (cos(0.2) - cos(outer[i])) / (cos(inner[i]) - cos(outer[i]));
        t = fmin(fmax(t, 0), 1);
        snprintf(json, sizeof json, "{\"type\":\"spot\",\"intensity\":90,\"spot\":{\"innerConeAngle\":%g,\"outerConeAngle\":%g}}",
                 inner[i], outer[i]);
        w = floor_scene(0.5);
        gltf_light(w, position, axis, json);
        snprintf(name, sizeof name, "direct-spot-%d", i);
        ec_scene *scene = case_load(gltf_write(w, name), NULL);
        ec_render_options o = case_options(8, 8, 16);
        o.max_depth = 2;
        case_image image = case_render(scene, &o);
        /* The extension defines an angular attenuation, squared; close cosines lose digits. */
        CHECK_NEAR(image.mean[1], 90 * plain * t * t, 2e-5 * 90 * plain);
        printf("%-40s %.7f, expected %.7f\n", name, image.mean[1], 90 * plain * t * t);
        case_free(&image);
        ec_scene_free(scene);
        free(w);
    }

    w = floor_scene(0.5); /* 5 lx on a plane inclined by cos = 2/3 */
    gltf_light(w, (double[3]){0, 0, 0}, towards, "{\"type\":\"directional\",\"intensity\":5}");
    check_point(gltf_write(w, "direct-directional"), NULL, 0.6 / PI * 5 * 2 / 3, ALL, 16, 1e-5);
    gltf_quad(w, 0, (double[3]){0.2, 1, 0.7}, (double[3]){0.6, 0, 0}, (double[3]){0, 0, 0.6}); /* occludes the light */
    check_point(gltf_write(w, "direct-directional-blocked"), NULL, 0, ALL, 16, 1e-5);
    free(w);
}

/* A single-sided emitter: its front shines, camera rays pass through its back, and it lights nothing behind it. */
static void check_single_sided(void)
{
    for (int turned = 0; turned < 2; turned++) {
        gltf_writer *w = gltf_new();
        gltf_quad(w, gltf_lambert(w, 0.6, 0), (double[3]){-3, 0, 3}, (double[3]){6, 0, 0}, (double[3]){0, 0, -6});
        gltf_camera(w, (double[3]){0, 2, 0}, (double[3]){0, 0, 0}, 1e-5);
        int lamp = gltf_lambert(w, 0, 3);
        if (turned) /* faces the camera above it */
            gltf_quad(w, lamp, (double[3]){-1, 1, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        else
            gltf_quad(w, lamp, (double[3]){-1, 1, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
        /* From above the camera sees the lamp itself, or through its back the floor that it lights from h = 1. */
        check_point(gltf_write(w, turned ? "direct-lamp-front" : "direct-lamp-back"), NULL, turned ? 3 : 0.6 * 3 * 0.5541264, SKILLED,
                    8192, 2e-3);
        free(w);
    }
}

/* A plane that sees only a constant environment L: albedo L. */
static void check_constant_environment(void)
{
    gltf_writer *w = floor_scene(0.5);
    check_point(gltf_write(w, "direct-environment"), "2,2,2", 0.6 * 2, ALL, 1024, 2e-3);
    /* A wall of height 1 along x at z = -1 hides part of the sky. For an infinite wall the hidden part of the irradiance is (1 - d /
     * sqrt(d^2 + h^2)) / 2. Here the wall is 2000 long and black: the ends change less than 1e-6. */
    gltf_quad(w, gltf_lambert(w, 0, 0), (double[3]){-1000, 0, -1}, (double[3]){2000, 0, 0}, (double[3]){0, 1, 0});
    check_point(gltf_write(w, "direct-environment-wall"), "2,2,2", 0.6 * 2 * 0.85355339, ALL, 4096, 2e-3);
    free(w);
}

/* An environment of `background` with one texel of 1000 at (tx, ty) of 64 x 32. Bilinear interpolation makes it a pyramid over 2 x 2
 * texels: E = pi background + sum of (L - background) cos d(omega) over it, by midpoint quadrature. */
static void check_hot_texel(uint32_t tx, uint32_t ty, float background)
{
    enum { WIDTH = 64, HEIGHT = 32, STEPS = 400 };
    static float rgb[3 * WIDTH * HEIGHT];
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) rgb[i] = background;
    for (int k = 0; k < 3; k++) rgb[3 * (ty * WIDTH + tx) + k] = 1000;
    double irradiance = PI * background;
    for (int j = 0; j < STEPS; j++)
        for (int i = 0; i < STEPS; i++) {
            double x = 2 * (i + 0.5) / STEPS - 1, y = 2 * (j + 0.5) / STEPS - 1, hat = (1 - fabs(x)) * (1 - fabs(y));
            double theta = PI * (ty + 0.5 + y) / HEIGHT, area = pow(2.0 / STEPS, 2) * 2 * PI / WIDTH * PI / HEIGHT;
            irradiance += fmax(cos(theta), 0) * sin(theta) * area * hat * (1000 - background);
        }
    char file[512], name[64];
    snprintf(file, sizeof file, "%s/direct-hot-texel.exr", ECLAT_TEST_OUT);
    ec_channel channels[3] = {{.name = "R", .data = rgb, .stride = 3}, {.name = "G", .data = rgb + 1, .stride = 3}, {.name = "B", .data = rgb + 2, .stride = 3}};
    ec_error err = {0};
    CHECK_OK(ec_exr_write(file, WIDTH, HEIGHT, channels, 3, NULL, 0, &err), err);
    gltf_writer *w = floor_scene(0.5);
    snprintf(name, sizeof name, "direct-hot-texel-%u-%u-%g", tx, ty, background);
    check_point(gltf_write(w, name), file, 0.6 / PI * irradiance, SKILLED, 16384, 8e-2);
    free(w);
}

int main(void)
{
    if (test_tier("quick")) {
        check_polylum(8192);
        check_punctual();
        check_constant_environment();
    }
    if (!test_tier("full")) TEST_END();
    check_polylum(16384);
    check_bulb(0);
    check_bulb(1);
    check_bulb(2);
    check_random_triangles();
    check_single_sided();
    check_hot_texel(20, 6, 0.1f);
    check_hot_texel(0, 10, 0); /* across the map's seam */
    check_hot_texel(40, 15, 0); /* half of it is below the horizon */
    TEST_END();
}
