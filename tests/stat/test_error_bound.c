/* The stated error against the real one: a scene is rendered 100 times with different seeds; the real relative RMS error,
 * against a converged picture, must lie under error_bound in 95 +- 4 of them, and `error` must equal it on average.
 *
 * Real error: sqrt(mean_p (Y_p - R_p)^2) / mean R in luminance. R has an error of its own, independent of the renders', so
 * mean_p SE(R_p)^2 is subtracted from the mean square. With 400 times a render's samples it is a four-hundredth of it. */
#include "support/render_case.h"

enum { RENDERS = 100 };

typedef struct bound_case {
    const char *name, *path, *environment;
    uint32_t size, spp, batches, max_depth;
    ec_sampler_type sampler;
} bound_case;

static double luminance(const float *rgb)
{
    return ec_luminance((double[3]){rgb[0], rgb[1], rgb[2]});
}

typedef struct truth {
    case_image image;
    double mean, own_square; /* mean luminance; mean square of the reference's own standard errors */
} truth;

static truth converge(const ec_scene *scene, const bound_case *c)
{
    ec_render_options o = case_options(c->size, c->size, 400 * c->spp);
    o.batch = o.spp / 64;
    o.max_depth = c->max_depth;
    o.seed = 1000003;
    truth t = {.image = case_render(scene, &o)};
    ec_film_error e = ec_film_estimate_error(&t.image.film);
    t.mean = e.mean_luminance;
    t.own_square = pow(e.error * e.mean_luminance, 2);
    return t;
}

static double real_error(const case_image *image, const truth *t)
{
    double sum = 0, pixels = (double)image->width * image->height;
    for (size_t p = 0; p < (size_t)pixels; p++) {
        double d = luminance(image->rgb + 3 * p) - luminance(t->image.rgb + 3 * p);
        sum += d * d;
    }
    return sqrt(fmax(sum / pixels - t->own_square, 0)) / t->mean;
}

static void check_case(const bound_case *c)
{
    if (!case_present(c->path) || (c->environment && !case_present(c->environment))) {
        printf("%s: not there: %s\n", c->name, c->path);
        return;
    }
    ec_scene *scene = case_load(c->path, c->environment);
    truth t = converge(scene, c);
    int covered = 0;
    double stated_square = 0, real_square = 0, bound_sum = 0;
    for (int i = 0; i < RENDERS; i++) {
        ec_render_options o = case_options(c->size, c->size, c->spp);
        o.batch = c->spp / c->batches;
        o.max_depth = c->max_depth;
        o.sampler = c->sampler;
        o.seed = (uint64_t)i;
        case_image image = case_render(scene, &o);
        double real = real_error(&image, &t);
        covered += real <= image.stats.error_bound;
        real_square += real * real / RENDERS;
        stated_square += image.stats.error * image.stats.error / RENDERS;
        bound_sum += image.stats.error_bound / RENDERS;
        case_free(&image);
    }
    double ratio = sqrt(stated_square / real_square);
    printf("%-28s %2u batches: real error %5.2f %%, stated / real %.4f, bound / stated %.4f, under the bound %d of %d\n", c->name,
           c->batches, 100 * sqrt(real_square), ratio, bound_sum / sqrt(stated_square), covered, RENDERS);
    CHECK_MSG(covered >= 91 && covered <= 99, "%s, %u batches: %d of %d under the bound", c->name, c->batches, covered, RENDERS);
    /* The mean of 100 squares of relative spread about sqrt(2 / nu), nu of the order of 100, is good to 1.5 %. */
    CHECK_MSG(fabs(ratio - 1) < 0.04, "%s, %u batches: stated / real error %.4f", c->name, c->batches, ratio);
    case_free(&t.image);
    ec_scene_free(scene);
}

int main(void)
{
    static const char cornell[] = OWN_SCENE("cornell-box/cornell-box.gltf"), plates[] = OWN_SCENE("furnace/plates.gltf"),
                      veach[] = OWN_SCENE("veach-plates/veach-plates.gltf"),
                      studio[] = SHARED("assets/env/pmndrs-assets/studio.hdr");
    static const bound_case cases[] = {
        {"cornell-box", cornell, NULL, 32, 64, 16, 5, EC_SAMPLER_SOBOL},
        {"cornell-box", cornell, NULL, 32, 64, 64, 5, EC_SAMPLER_INDEPENDENT},
        {"veach-plates", veach, NULL, 32, 64, 16, 4, EC_SAMPLER_SOBOL},
        {"plates under studio.hdr", plates, studio, 32, 64, 16, 4, EC_SAMPLER_SOBOL},
        {"plates under studio.hdr", plates, studio, 32, 64, 64, 4, EC_SAMPLER_INDEPENDENT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) check_case(&cases[i]);
    TEST_END();
}
