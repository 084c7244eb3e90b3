/* tiers: full, long */
/* The Cornell box against the Mitsuba 3.9 reference: 256 x 256, depth 8, 16 384 samples in 64 batches, with standard errors. All strategies
 * for direct light and both samplers converge to it. BSDF sampling finds the small lamp by one path of fifty, so that 16 batches of a
 * single dark pixel say little about its variance: it is compared in squares of 8 x 8 pixels. */
#include "support/render_case.h"

typedef struct cornell_case {
    const char *tier, *name;
    ec_sample sample;
    ec_sampler_type sampler;
    uint32_t spp, block; /* samples a pixel; side of a compared square in pixels */
} cornell_case;

static void compare(const cornell_case *c, const ec_scene *scene, const ztest_picture *reference)
{
    ec_render_options o = case_options(256, 256, c->spp);
    o.max_depth = 8;
    o.sample = c->sample;
    o.sampler = c->sampler;
    case_image image = case_render(scene, &o);
    ztest_picture picture = case_picture(&image), compared = case_blocks(&picture, c->block), blocks = case_blocks(reference, c->block);
    char map[512];
    snprintf(map, sizeof map, "%s/cornell-%s-errors.exr", ECLAT_TEST_OUT, c->name);
    ztest_result r = ztest_compare(&compared, &blocks, NULL, map);
    CHECK_MSG(r.pass, "%s: %s", c->name, r.text);
    for (int k = 0; k < 3; k++) /* the tolerance must not be mere noise */
        CHECK_MSG(r.mean_se[k] < 0.002 * r.reference_mean[k], "%s: standard error of the mean %.3f %%", c->name,
                  100 * r.mean_se[k] / r.reference_mean[k]);
    printf("%-18s %5u spp %5.1f s  %s\n", c->name, c->spp, image.stats.seconds, r.text);
    ztest_free(&compared);
    ztest_free(&blocks);
    case_free(&image);
}

int main(void)
{
    static const char scene_path[] = SHARED("reference/cornell-box/cornell-box.gltf");
    static const char reference_path[] = SHARED("reference/cornell-box/reference.exr");
    if (!case_present(scene_path) || !case_present(reference_path)) TEST_SKIP("no %s", reference_path);
    static const cornell_case cases[] = {
        {"full", "mis-sobol", EC_SAMPLE_MIS, EC_SAMPLER_SOBOL, 256, 1},
        {"long", "mis-independent", EC_SAMPLE_MIS, EC_SAMPLER_INDEPENDENT, 256, 1},
        {"long", "light-sobol", EC_SAMPLE_LIGHT, EC_SAMPLER_SOBOL, 256, 1},
        {"full", "light-independent", EC_SAMPLE_LIGHT, EC_SAMPLER_INDEPENDENT, 256, 1},
        {"full", "bsdf-sobol", EC_SAMPLE_BSDF, EC_SAMPLER_SOBOL, 512, 8},
        {"long", "bsdf-independent", EC_SAMPLE_BSDF, EC_SAMPLER_INDEPENDENT, 512, 8},
    };
    ec_error err = {0};
    ztest_picture reference = {0};
    CHECK_OK(ztest_load(reference_path, 63, &reference, &err), err);
    ec_scene *scene = case_load(scene_path, NULL);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        if (test_tier(cases[i].tier)) compare(&cases[i], scene, &reference);
    ec_scene_free(scene);
    ztest_free(&reference);
    TEST_END();
}
