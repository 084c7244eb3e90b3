/* The Cornell box against the Mitsuba 3.9 reference (ASSETS.md): 256 x 256, depth 8, 16 384 samples in 64 batches, with its
 * standard errors. Every direct-light strategy and both samplers converge to it. Samples by strategy so that the mean's
 * standard error stays well under the 0.1 % that is allowed: BSDF sampling meets the small lamp seldom. */
#include "support/render_case.h"

typedef struct cornell_case {
    const char *name;
    ec_strategy strategy;
    ec_sampler_type sampler;
    uint32_t spp;
} cornell_case;

static void compare(const cornell_case *c, const ec_scene *scene, const ztest_picture *reference)
{
    ec_render_options o = case_options(256, 256, c->spp);
    o.max_depth = 8;
    o.batch = c->spp / 16;
    o.strategy = c->strategy;
    o.sampler = c->sampler;
    case_image image = case_render(scene, &o);
    ztest_picture picture = case_picture(&image);
    /* With 16 batches of few samples a dark pixel's standard error can miss the rare bright path; the reference knows it.
     * Only for BSDF sampling, whose variance is no smaller than Mitsuba's MIS: Sobol's may be smaller. */
    ztest_options options = {0};
    char map[512];
    snprintf(map, sizeof map, "%s/cornell-%s-errors.exr", ECLAT_TEST_OUT, c->name);
    ztest_result r = ztest_compare(&picture, reference, &options, map);
    CHECK_MSG(r.pass, "%s: %s", c->name, r.text);
    for (int k = 0; k < 3; k++) /* the tolerance must not hide behind noise */
        CHECK_MSG(r.mean_se[k] < 0.002 * r.reference_mean[k], "%s: standard error of the mean %.3f %%", c->name,
                  100 * r.mean_se[k] / r.reference_mean[k]);
    printf("%-18s %5u spp %5.1f s  %s\n", c->name, c->spp, image.stats.seconds, r.text);
    case_free(&image);
}

int main(void)
{
    static const char scene_path[] = SHARED("reference/cornell-box/cornell-box.gltf");
    static const char reference_path[] = SHARED("reference/cornell-box/reference.exr");
    if (!case_present(scene_path) || !case_present(reference_path)) TEST_SKIP("no %s", reference_path);
    static const cornell_case cases[] = {
        {"mis-sobol", EC_STRATEGY_MIS, EC_SAMPLER_SOBOL, 512},
        {"mis-independent", EC_STRATEGY_MIS, EC_SAMPLER_INDEPENDENT, 512},
        {"nee-sobol", EC_STRATEGY_NEE, EC_SAMPLER_SOBOL, 256},
        {"nee-independent", EC_STRATEGY_NEE, EC_SAMPLER_INDEPENDENT, 256},
        {"bsdf-sobol", EC_STRATEGY_BSDF, EC_SAMPLER_SOBOL, 1024},
        {"bsdf-independent", EC_STRATEGY_BSDF, EC_SAMPLER_INDEPENDENT, 1024},
    };
    ec_error err = {{0}};
    ztest_picture reference = {0};
    CHECK_OK(ztest_load(reference_path, 63, &reference, &err), err);
    ec_scene *scene = case_load(scene_path, NULL);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) compare(&cases[i], scene, &reference);
    ec_scene_free(scene);
    ztest_free(&reference);
    TEST_END();
}
