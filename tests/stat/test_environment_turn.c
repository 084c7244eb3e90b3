/* tier: full */
/* Environments with --env-rotate and --env-strength, against maps that are drawn rotated and brighter. */
#include "support/floor_case.h"

enum { WIDTH = 16, HEIGHT = 8, TEXELS = WIDTH * HEIGHT };

/* A map with a bright texel, its columns shifted to the left. */
static void set_map(ec_scene *scene, int moved)
{
    ec_environment *e = &scene->environment;
    free(e->rgb);
    *e = (ec_environment){.width = WIDTH, .height = HEIGHT, .rgb = malloc(3 * TEXELS * sizeof(float))};
    if (!e->rgb) exit(1);
    uint32_t state = 7;
    for (int i = 0; i < 3 * TEXELS; i++) {
        state = state * 1664525u + 1013904223u;
        int x = i / 3 % WIDTH, y = i / 3 / WIDTH;
        e->rgb[3 * (y * WIDTH + (x + WIDTH - moved) % WIDTH) + i % 3] = (float)(state >> 8) / 16777216.0f + (x == 3 && y == 2 ? 40 : 0);
    }
    scene->has_environment = true;
}

static ec_render_options options(ec_sample sample)
{
    ec_render_options o = case_options(16, 16, 1024);
    o.sample = sample;
    o.max_depth = 3;
    return o;
}

/* The camera sees the sky itself. Noise comes only from the width of pixels, and both sides have the same random numbers. */
static void check_seen(ec_scene *scene, ec_scene *other, const char *what)
{
    ec_render_options o = options(EC_SAMPLE_MIS);
    o.camera = 1;
    case_image a = case_render(scene, &o), b = case_render(other, &o);
    double worst = 0;
    for (int i = 0; i < 3 * 16 * 16; i++) worst = fmax(worst, fabs((double)a.rgb[i] - b.rgb[i]));
    printf("%s: seen itself, off by %.1e of 40\n", what, worst);
    CHECK_MSG(worst < 40 * 16 * 1e-6, "%s: off by %g", what, worst); /* u is precise to about 1e-6, and a texel is 1 / 16 wide */
    case_free(&a);
    case_free(&b);
}

static void check_lit(const ec_scene *scene, const ec_scene *other, ec_sample sample, const char *what)
{
    ec_render_options o = options(sample), p = options(EC_SAMPLE_MIS);
    p.seed = 1;
    case_image a = case_render(scene, &o), b = case_render(other, &p);
    case_check_same(&a, &b, 4, what);
    case_free(&a);
    case_free(&b);
}

int main(void)
{
    gltf_writer *w = gltf_new();
    int grey = gltf_lambert(w, 0.6, 0);
    gltf_quad(w, grey, (double[3]){-3, 0, 3}, (double[3]){6, 0, 0}, (double[3]){0, 0, -6});
    gltf_quad(w, grey, (double[3]){0.5, 0, -0.5}, (double[3]){0, 0, 1}, (double[3]){0, 1, 0}); /* its shadow shows the light's direction */
    gltf_camera(w, (double[3]){0, 3, 0}, (double[3]){0, 0, 0}, 0.8);
    gltf_camera(w, (double[3]){0, 0.5, -4}, (double[3]){0.3, 1.5, -5}, 1.2);
    const char *path = gltf_write(w, "environment-turn");
    ec_scene *turned = case_load(path, "1,1,1"), *drawn = case_load(path, "1,1,1");
    free(w);

    set_map(turned, 0); /* 90 degrees are 4 columns */
    ec_scene_adjust_environment(turned, 90, 1, NULL);
    set_map(drawn, 4);
    check_seen(turned, drawn, "turned by 90 degrees");
    check_lit(turned, drawn, EC_SAMPLE_MIS, "turned by 90 degrees, mis");
    check_lit(turned, drawn, EC_SAMPLE_LIGHT, "turned by 90 degrees, light");
    check_lit(turned, drawn, EC_SAMPLE_BSDF, "turned by 90 degrees, bsdf");
    ec_scene_adjust_environment(turned, -67.5, 1, NULL); /* in addition to that */
    set_map(drawn, 1);
    check_seen(turned, drawn, "turned twice");

    memcpy(turned->environment.turn, (float[9]){0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f}, sizeof turned->environment.turn);
    check_lit(turned, turned, EC_SAMPLE_LIGHT, "turned about any axis, light"); /* the functions from directions to the map and back agree */
    check_lit(turned, turned, EC_SAMPLE_BSDF, "turned about any axis, bsdf");

    set_map(turned, 1);
    ec_render_options o = options(EC_SAMPLE_MIS);
    case_image once = case_render(turned, &o);
    ec_scene_adjust_environment(turned, 720, 4, NULL);
    CHECK(!turned->environment.turned);
    case_image bright = case_render(turned, &o);
    uint32_t other = 0;
    for (int i = 0; i < 3 * 16 * 16; i++) other += bright.rgb[i] != 4 * once.rgb[i];
    CHECK_MSG(!other, "%u values are not four times as bright", other);
    CHECK(strstr(case_effects(&once), "environment-map") && !strstr(case_effects(&once), "rotation"));
    ec_scene_adjust_environment(turned, 0, 0, NULL);
    CHECK(!turned->has_environment && !turned->environment.rgb);
    case_free(&once);
    case_free(&bright);
    ec_scene_free(turned);
    ec_scene_free(drawn);
    TEST_END();
}
