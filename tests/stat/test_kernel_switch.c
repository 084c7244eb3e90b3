/* tiers: quick, full, long */
/* Kernels change during a render, at any wave: no bit of the picture changes. */
#include "base/random.h"
#include "pack/scene_view.h"
#include "support/render_case.h"

enum { WIDTH = 160, HEIGHT = 120, SPP = 16, SCENES = 10 };

/* A wave of the first kernels is smaller than these pictures. */
static ec_render_options options(void)
{
    ec_render_options o = case_options(WIDTH, HEIGHT, SPP);
    o.replicates = 8;
    o.lanes = 4;
    return o;
}

/* A scene by the name of its folder in scenes/, or by its path. */
static ec_scene *load(const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/%s/%s.gltf", ECLAT_SOURCE_DIR, name, name);
    return case_load(*name == '/' ? name : path, NULL);
}

/* more: effects that are built in though the scene may not need them, so that scenes share kernels. */
static void check_scene(const char *name, uint64_t more, int moments, uint64_t *random)
{
    ec_scene *scene = load(name);
    ec_render_options o = options();
    o.more_effects = more;
    case_image expected = case_render(scene, &o);
    CHECK(expected.stats.begun == EC_BEGUN_FAST && expected.stats.fast_after_seconds == 0);
    for (int i = 0; i < moments; i++) {
        o.waves_until_fast = i == 0 ? 100000 : 1 + (uint32_t)(12 * ec_random_unit(random)); /* never, or soon */
        case_image image = case_render(scene, &o);
        CHECK_MSG(case_same_bits(&image.film, &expected.film), "%s: other bits where kernels change before wave %u", name, o.waves_until_fast);
        CHECK(image.stats.begun == EC_BEGUN_NARROW && (image.stats.fast_after_seconds > 0) == (i > 0));
        case_free(&image);
    }
    case_free(&expected);
    ec_scene_free(scene);
}

static uint64_t effects_of(const char *const names[SCENES])
{
    uint64_t all = 0;
    for (int i = 0; i < SCENES; i++) {
        ec_scene *scene = load(names[i]);
        ec_effects called;
        ec_error err = {0};
        CHECK_OK(ec_scene_calls(scene, &called, &err), err);
        all |= called.bits;
        ec_scene_free(scene);
    }
    return all;
}

/* Checks every step-th scene, from the first on. */
static void check_scenes(const char *const names[SCENES], int first, int step, int moments, uint64_t *random)
{
    const uint64_t all = effects_of(names);
    for (int i = first; i < SCENES; i += step) check_scene(names[i], all, moments, random);
}

int main(void)
{
    static const char *const scenes[SCENES] = {"cornell-box", "showcase", "lamps", "drink", "toy", "soap-film", "velvet", "spheres", "prism", "brushed-metal"};
    static const char *const others[SCENES] = {"car-paint", "curl", "glass", "ladder", "six-lamps", "vase", "veach-plates", "terminator",
                                               SHARED("assets/gltf/DamagedHelmet/glTF-Binary/DamagedHelmet.glb"),
                                               SHARED("assets/gltf/Suzanne/glTF/Suzanne.gltf")};
    uint64_t random = 23;
    if (test_tier("quick")) check_scene(scenes[0], 0, 4, &random);
    if (test_tier("full")) check_scenes(scenes, 1, 2, 2, &random);
    if (test_tier("long")) check_scenes(scenes, 1, 1, 6, &random);
    if (test_tier("long")) check_scenes(others, 0, 1, 4, &random);
    TEST_END();
}
