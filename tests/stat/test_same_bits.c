/* tiers: quick, full */
/* The picture is a function of scene, seed and options, not of how it was computed: LANES, acceleration structure, density of its
 * grid, wave size, effects built in, and the time of day change no bit of any number in the film. (Threads: tests/cli/test_render.py.) */
#include "accel/accel.h"
#include "pack/pack.h"
#include "support/render_case.h"

enum { WIDTH = 48, HEIGHT = 36, SCENES = 3 };

/* A program of one lane takes the least time to compile. */
static ec_render_options base_options(void)
{
    ec_render_options o = case_options(WIDTH, HEIGHT, 8);
    o.seed = 5;
    o.lanes = 1;
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

/* With no effects but the scene's own, and with those of all the scenes, which so share programs. `widths` of packets with the
 * accelerator whose kernels are as wide as what shades; the others' are of 8 lanes. All effects are built in with 4. */
static void check_scene(const char *what, const ec_scene *scene, uint64_t all_scenes, int widths)
{
    static const uint32_t lanes[] = {16, 1, 8, 4}, waves[] = {512, 4096, 5000};
    static const float densities[] = {0.01f, 1.0f, 300.0f, 10000.0f};
    ec_render_options o = base_options();
    case_image expected = case_render(scene, &o);
    CHECK(expected.mean[0] > 0 && expected.stats.effects.built != all_scenes);
    printf("%s: %s\n", what, case_effects(&expected));
    check_one(scene, &expected, &o, what); /* twice in a row */
    for (int i = 0; i < 3; i++) {
        o.wave = waves[i];
        check_one(scene, &expected, &o, what);
    }
    o = base_options();
    o.seed = 6; /* and the comparison can see a difference */
    case_image other = case_render(scene, &o);
    CHECK(!case_same_bits(&other.film, &expected.film));
    case_free(&other);

    o = base_options();
    o.accel = "bvh2";
    for (int l = 0; l < widths; l++) {
        o.lanes = lanes[l];
        o.more_effects = widths > 1 ? 0 : all_scenes;
        check_one(scene, &expected, &o, what);
    }
    o = base_options();
    o.more_effects = all_scenes;
    for (int a = 0; a < EC_ACCEL_COUNT; a++) {
        o.accel = ec_accels[a].name;
        if (ec_accels[a].lanes) check_one(scene, &expected, &o, what);
    }
    o.accel = "grid";
    for (int i = 0; i < 4; i++) {
        o.grid_density = densities[i];
        check_one(scene, &expected, &o, what);
    }
    o = case_quick(case_with_all_effects(base_options()));
    check_one(scene, &expected, &o, what);
    case_free(&expected);
}

int main(void)
{
    static const char *const names[SCENES] = {"cornell-box", "lamps", "drink"};
    ec_scene *scenes[SCENES] = {
        case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL),
        case_load(OWN_SCENE("lamps/lamps.gltf"), "0.1,0.2,0.3"), /* every effect of core glTF */
        case_load(OWN_SCENE("drink/drink.gltf"), NULL),          /* bodies in bodies, rough ones, a pane */
    };
    const bool is_full = test_tier("full");
    uint64_t all_scenes = EC_FEATURE_PUNCTUAL_LIGHTS; /* which the first one has not: alone, it is built for few effects more */
    for (int i = 0; i == 0 || (is_full && i < SCENES); i++) {
        ec_effects called;
        ec_error err = {0};
        CHECK_OK(ec_scene_calls(scenes[i], &called, &err), err);
        all_scenes |= called.bits;
    }
    for (int i = 0; i < SCENES; i++) {
        if (i == 0 || is_full) check_scene(names[i], scenes[i], all_scenes, i ? 1 : is_full ? 4 : 2);
        ec_scene_free(scenes[i]);
    }
    TEST_END();
}
