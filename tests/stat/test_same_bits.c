/* tiers: quick, full */
/* The picture is a function of scene, seed and options, not of how it is computed: LANES, acceleration structure, grid density, wave size,
 * built-in effects and time of day change no bit of the film. (Threads: tests/cli/test_render.py.) */
#include "accel/accel.h"
#include "pack/pack.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

enum { WIDTH = 48, HEIGHT = 36, SCENES = 3 };

/* A program of 4 lanes compiles in two thirds of the time of a program of one lane. */
static ec_render_options base_options(void)
{
    ec_render_options o = case_options(WIDTH, HEIGHT, 8);
    o.seed = 5;
    o.lanes = 4;
    o.accel = "bvh8";
    return o;
}

static void check_one(const ec_scene *scene, const case_image *expected, const ec_render_options *o, const char *what)
{
    case_image image = case_render(scene, o);
    CHECK_MSG(case_same_bits(&image.film, &expected->film), "%s: lanes %u, %s, %g cells a reference, wave %u, effects %llx: other bits",
              what, o->lanes, o->accel ? o->accel : "auto", (double)o->grid_density, o->wave,
              (unsigned long long)image.stats.effects.built);
    case_free(&image);
}

/* Renders twice, in other waves, and once with another seed, to see that the comparison finds a difference. */
static void check_base(const char *what, const ec_scene *scene, const case_image *expected)
{
    static const uint32_t waves[] = {512, 4096, 5000};
    ec_render_options o = base_options();
    printf("%s: %s\n", what, case_effects(expected));
    check_one(scene, expected, &o, what);
    for (int i = 0; i < 3; i++) {
        o.wave = waves[i];
        check_one(scene, expected, &o, what);
    }
    o = base_options();
    o.seed = 6;
    case_image other = case_render(scene, &o);
    CHECK(!case_same_bits(&other.film, &expected->film));
    case_free(&other);
}

/* Packets use the accelerator whose kernels are as wide as shading; the others' kernels have 8 lanes. */
static void check_width(const char *what, const ec_scene *scene, const case_image *expected, uint32_t lanes, uint64_t effects)
{
    ec_render_options o = base_options();
    o.accel = "bvh2";
    o.lanes = lanes;
    o.more_effects = effects;
    check_one(scene, expected, &o, what);
}

/* With the effects of all these scenes, so that they share programs. */
static void check_accels(const char *what, const ec_scene *scene, const case_image *expected, uint64_t all_scenes)
{
    static const float densities[] = {0.01f, 1.0f, 300.0f, 10000.0f};
    ec_render_options o = base_options();
    CHECK(expected->stats.effects.built != all_scenes);
    o.more_effects = all_scenes;
    for (int a = 0; a < EC_ACCEL_COUNT; a++) {
        o.accel = ec_accels[a].name;
        if (ec_accels[a].lanes) check_one(scene, expected, &o, what);
    }
    o.accel = "grid";
    for (int i = 0; i < 4; i++) {
        o.grid_density = densities[i];
        check_one(scene, expected, &o, what);
    }
    o = case_quick(case_with_all_effects(base_options()));
    check_one(scene, expected, &o, what);
}

/* A plate that fills the view below a sky: all hits are of one material, which kernels of several lanes need not group, and then all rays miss. */
static void check_one_material(void)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 0.5, 0), (double[3]){-9, 0, 9}, (double[3]){18, 0, 0}, (double[3]){0, 0, -18});
    gltf_camera(w, (double[3]){0, 1, 0}, (double[3]){0, 0, 0}, 1e-4);
    ec_scene *scene = case_load(gltf_write(w, "plate"), "0.1,0.2,0.3");
    free(w);
    const ec_render_options o = base_options();
    case_image expected = case_render(scene, &o);
    CHECK(expected.mean[0] > 0);
    check_width("plate", scene, &expected, 1, 0);
    case_free(&expected);
    ec_scene_free(scene);
}

/* The first scene gets the effect of punctual lights, which others need; it needs few more effects. */
int main(void)
{
    static const char *const names[SCENES] = {"cornell-box", "lamps", "drink"};
    ec_scene *scenes[SCENES] = {
        case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL),
        case_load(OWN_SCENE("lamps/lamps.gltf"), "0.1,0.2,0.3"), /* every effect of core glTF */
        case_load(OWN_SCENE("drink/drink.gltf"), NULL),          /* bodies in bodies, rough ones, a pane */
    };
    static const uint32_t widths[2][2] = {{16, 1}, {8, 4}};
    const bool is_full = test_tier("full");
    const int count = is_full ? SCENES : 1;
    if (!is_full) check_one_material();
    uint64_t all_scenes = EC_FEATURE_PUNCTUAL_LIGHTS;
    case_image expected[SCENES] = {0};
    const ec_render_options o = base_options();
    for (int i = 0; i < count; i++) {
        expected[i] = case_render(scenes[i], &o);
        CHECK(expected[i].mean[0] > 0);
        all_scenes |= expected[i].stats.effects.built; /* also effects that a scene needs once its lamps are known, such as a light tree */
    }
    for (int l = 0; l < 2; l++) check_width(names[0], scenes[0], &expected[0], widths[is_full][l], 0);
    for (int i = is_full; i < count; i++) {
        check_base(names[i], scenes[i], &expected[i]);
        check_accels(names[i], scenes[i], &expected[i], all_scenes);
        for (uint32_t lanes = 8; is_full && lanes <= 16; lanes *= 2) check_width(names[i], scenes[i], &expected[i], lanes, all_scenes);
    }
    for (int i = 0; i < SCENES; i++) {
        if (i < count) case_free(&expected[i]);
        ec_scene_free(scenes[i]);
    }
    TEST_END();
}
