/* tiers: quick, full */
/* Kernels change while a picture is rendered, at any wave, and no bit of it changes. */
#include "base/random.h"
#include "support/render_case.h"

enum { WIDTH = 160, HEIGHT = 120, SPP = 16 };

/* A wave of the first kernels is smaller than these pictures are. */
static ec_render_options options(void)
{
    ec_render_options o = case_options(WIDTH, HEIGHT, SPP);
    o.replicates = 8;
    o.lanes = 4;
    return o;
}

static void check_scene(const char *name, int moments, uint64_t *random)
{
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/%s/%s.gltf", ECLAT_SOURCE_DIR, name, name);
    ec_scene *scene = case_load(path, NULL);
    ec_render_options o = options();
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

int main(void)
{
    static const char *const scenes[] = {"cornell-box", "showcase", "lamps", "drink", "toy", "soap-film", "velvet", "spheres", "prism", "brushed-metal"};
    uint64_t random = 23;
    if (test_tier("quick")) check_scene(scenes[0], 4, &random);
    for (size_t i = 1; test_tier("full") && i < sizeof scenes / sizeof scenes[0]; i++) check_scene(scenes[i], 6, &random);
    TEST_END();
}
