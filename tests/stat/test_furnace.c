/* tiers: quick, full */
/* Scenes whose radiance is known without rendering (scenes/furnace/README.md). */
#include "report/names.h"
#include "support/render_case.h"

enum { SAMPLE_COUNT = EC_SAMPLE_HEMISPHERE + 1 };

/* A closed Lambertian box that emits 1 everywhere. Segment k adds albedo^(k-1), so d segments give (1 - a^d) / (1 - a), and all give 1 / (1
 * - a): in every pixel, for every strategy, in corners too. */
/* With every second way to sample, or with all. */
static void check_box(const char *path, double albedo, int step, uint32_t spp)
{
    static const uint32_t depths[] = {1, 2, 3, 9, 0};
    if (!case_present(path)) {
        printf("not there: %s\n", path);
        return;
    }
    ec_scene *scene = case_load(path, NULL);
    for (int s = 0; s < SAMPLE_COUNT; s += step)
        for (int d = 0; d < 5; d++) {
            ec_render_options o = case_options(16, 16, spp);
            o.sample = (ec_sample)s;
            o.max_depth = depths[d];
            o.seed = 2;
            o.sampler = d % 2 ? EC_SAMPLER_INDEPENDENT : EC_SAMPLER_SOBOL;
            case_image image = case_render(scene, &o);
            double expected = depths[d] ? (1 - pow(albedo, depths[d])) / (1 - albedo) : 1 / (1 - albedo);
            CASE_NEAR(&image, expected, 4, o.sample == EC_SAMPLE_HEMISPHERE || o.sample == EC_SAMPLE_LIGHT ? 0.005 : 0.002);
            /* Also in each pixel, with Sidak's threshold for 768 values at 1 %: t(15 dof) = 6.6. */
            for (int i = 0; i < 3 * 16 * 16; i++)
                CHECK_MSG(fabs(image.rgb[i] - expected) <= 6.6 * image.se[i] + 1e-5 * expected,
                          "%s %s depth %u value %d: %g +- %g, expected %g", path, ec_sample_names[s], depths[d], i,
                          image.rgb[i], image.se[i], expected);
            if (depths[d] == 0)
                printf("box %.1f %-10s %.6f +- %.6f, expected %g\n", albedo, ec_sample_names[s], image.mean[1], image.mean_se[1],
                       expected);
            case_free(&image);
        }
    ec_scene_free(scene);
}

/* In the closed box, BSDF sampling finds the same radiance by each path: segment k adds albedo^(k - 1), and no ray leaves. So without
 * roulette the picture is the series up to max_depth, without noise, and every sample takes max_depth rays. Exceptions are hits so near a
 * concave edge that the other wall is within their error bound, gamma_9 = 5.4e-7 of the box's half side: such a path may leave. That bound
 * is also the share of two walls' strips by all edges; half of the segments are then missing.
 *
 * With a constant survival P the picture is the whole series, and a sample takes 1 / (1 - P) rays on average, with variance P / (1 - P)^2:
 * a path may end at its first surface. Its noise is finite, since 0.5^2 is less than P. */
static void check_roulette(void)
{
    static const uint32_t depths[] = {2, 3, 9, 40};
    static const double survival[] = {0.5, 0.8};
    const double albedo = 0.5;
    ec_scene *scene = case_load(OWN_SCENE("furnace/box-albedo-0.5.gltf"), NULL);
    ec_render_options o = case_options(16, 16, 256);
    o.sample = EC_SAMPLE_BSDF;
    o.sampler = EC_SAMPLER_INDEPENDENT; /* otherwise the number of rays would vary less */
    o.survival = 1;
    for (int d = 0; d < 4; d++) {
        o.max_depth = depths[d];
        case_image image = case_render(scene, &o);
        CHECK_NEAR(image.mean[1], (1 - pow(albedo, depths[d])) / (1 - albedo), 1e-5);
        CHECK_MSG(image.mean_se[1] < 1e-6, "off, depth %u: noise of %g", depths[d], image.mean_se[1]);
        double whole = (double)depths[d] * (double)image.stats.samples, lost = whole - (double)image.stats.rays;
        CHECK_MSG(lost >= 0 && lost <= 5.4e-7 * depths[d] * whole, "depth %u: %g of %g rays are missing", depths[d], lost, whole);
        printf("box, roulette off, depth %-2u %.6f +- %.1g\n", depths[d], image.mean[1], image.mean_se[1]);
        case_free(&image);
    }
    o.max_depth = 0;
    for (int i = 0; i < 2; i++) {
        o.survival = survival[i];
        case_image image = case_render(scene, &o);
        double rays = (double)image.stats.rays / (double)image.stats.samples, expected = 1 / (1 - survival[i]);
        double se = expected * sqrt(survival[i] / (double)image.stats.samples);
        CASE_NEAR(&image, 1 / (1 - albedo), 4, 0.005);
        CHECK_MSG(fabs(rays - expected) <= 4 * se, "survival %g: %g rays a sample, expected %g +- %g", survival[i], rays, expected, se);
        printf("box, roulette %.1f %.6f +- %.6f, %.4f rays a sample\n", survival[i], image.mean[1], image.mean_se[1], rays);
        case_free(&image);
    }
    ec_scene_free(scene);
}

/* Six emitting walls of different materials: plastics, metals, and mixtures. Strategies must agree. */
static void check_mixed_box(void)
{
    ec_scene *scene = case_load(OWN_SCENE("furnace/box-materials.gltf"), NULL);
    case_image images[SAMPLE_COUNT];
    for (int s = 0; s < SAMPLE_COUNT; s++) {
        ec_render_options o = case_random(24, 2048, (ec_sample)s, (uint64_t)s);
        images[s] = case_render(scene, &o);
    }
    case_check_same(&images[EC_SAMPLE_LIGHT], &images[EC_SAMPLE_MIS], 4, "box of six materials, light and mis");
    case_check_same(&images[EC_SAMPLE_BSDF], &images[EC_SAMPLE_MIS], 1, "box of six materials, bsdf and mis");
    case_check_same(&images[EC_SAMPLE_HEMISPHERE], &images[EC_SAMPLE_MIS], 4, "box of six materials, hemisphere and mis");
    for (int s = 0; s < SAMPLE_COUNT; s++) case_free(&images[s]);
    ec_scene_free(scene);
}

/* Directional albedo in an environment of 1: the table of scenes/furnace/README.md, by quadrature, precise to 1e-5. */
static void check_plates(void)
{
    static const double table[3][4] = {
        {0.8, 0.98830, 0.68785, 0.30685}, {0.8, 0.96921, 0.69825, 0.45069}, {0.8, 0.88346, 0.86010, 0.76021}};
    ec_scene *scene = case_load(OWN_SCENE("furnace/plates.gltf"), "1,1,1");
    for (uint32_t camera = 0; camera < 3; camera++)
        for (int s = 0; s < SAMPLE_COUNT; s++) {
            ec_render_options o = case_options(64, 16, 2048);
            o.camera = camera;
            o.sample = (ec_sample)s;
            case_image image = case_render(scene, &o);
            for (uint32_t plate = 0; plate < 4; plate++) {
                double se, mean = case_region(&image, (uint32_t[4]){16 * plate, 16 * plate + 16, 0, 16}, 1, &se);
                CHECK_MSG(fabs(mean - table[camera][plate]) <= 4 * se + 1e-5 && se < (s == EC_SAMPLE_MIS || s == EC_SAMPLE_BSDF ? 1e-3 : 2e-2),
                          "camera %u, plate %u, %s: %.6f +- %.6f, expected %.5f", camera, plate, ec_sample_names[s], mean, se,
                          table[camera][plate]);
            }
            case_free(&image);
        }
    ec_scene_free(scene);
}

/* White spheres in a white environment. The Lambertian one is invisible, and none gains energy near its centre (for the rim of plastic see
 * scenes/furnace/README.md). A faceted sphere is convex, so shading normals alone bend paths: light below the horizon is lost, never
 * gained. */
static void check_spheres(void)
{
    ec_scene *scene = case_load(OWN_SCENE("furnace/spheres.gltf"), "1,1,1");
    for (int s = 0; s < SAMPLE_COUNT; s++) {
        ec_render_options o = case_options(128, 16, 1024);
        o.sample = (ec_sample)s;
        case_image image = case_render(scene, &o);
        for (uint32_t ball = 0; ball < 8; ball++) {
            /* The central half of a ball: balls are 16 pixels apart in x, and have a radius of 6.4. */
            double se, mean = case_region(&image, (uint32_t[4]){16 * ball + 5, 16 * ball + 11, 5, 11}, 1, &se);
            CHECK_MSG(mean <= 1 + 4 * se + 1e-5, "ball %u, %s: %.6f +- %.6f is more than comes in", ball, ec_sample_names[s], mean, se);
            if (ball == 0) /* it sees the smooth metal beside it, whose single direction every strategy follows */
                CHECK_MSG(fabs(mean - 1) <= 4 * se + 1e-3 && se < 5e-3, "Lambert ball, %s: %.6f +- %.6f", ec_sample_names[s], mean, se);
            if (s == 0) printf("ball %u %.5f +- %.5f\n", ball, mean, se);
        }
        case_free(&image);
    }
    ec_scene_free(scene);
}

int main(void)
{
    if (test_tier("quick")) {
        check_box(OWN_SCENE("furnace/box-albedo-0.8.gltf"), 0.8, 2, 256);
        check_roulette();
    }
    if (test_tier("full")) {
        check_plates();
        check_box(OWN_SCENE("furnace/box-albedo-0.8.gltf"), 0.8, 2, 768);
        check_box(SHARED("assets/classic/gltf/furnace-nori/furnace-albedo-0.5.gltf"), 0.5, 1, 768);
        check_mixed_box();
        check_spheres();
    }
    TEST_END();
}
