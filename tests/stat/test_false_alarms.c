/* `eclat compare` on renders of one scene that differ in their seeds alone: how often does it say that they differ by more than
 * noise? Stated is at most 1 in 100 at p < 0.01, and 5 in 100 below 0.05. And a picture one per cent brighter is found.
 *
 * Each scene is rendered once with 1600 batches of 16 samples, of which pairs are made: 16 batches against 16, 50 pairs, and 16
 * against 320 others, 100 pairs, twenty to a reference. Over all scenes more than the stated share and three standard errors
 * would be a fault; in one scene 9 % below 0.05 and 4 % below 0.01, which 150 pairs exceed by chance in one case of 100.
 *
 * ctest label: long */
#include "film/noise_test.h"
#include "support/batches.h"

enum { BATCHES = 16, LONG = 320, ALL = 1600 };

typedef struct alarm_case {
    const char *name, *path, *environment;
    uint32_t width, height, max_depth;
    uint32_t bright_batches; /* as many as it takes for 1 % to be 4 standard errors of the mean or more; 0: too noisy for that */
} alarm_case;

typedef struct render {
    ec_measured measured;
    float *rgb;
} render;

static render make_render(const case_batches *batches, uint32_t first, uint32_t n)
{
    ec_film film = case_film_of(batches, first, n);
    render r = {.rgb = malloc(2 * batches->values * sizeof(float))};
    ec_film_resolve(&film, r.rgb, r.rgb + batches->values);
    ec_film_destroy(&film);
    r.measured = (ec_measured){batches->width, batches->height, r.rgb, r.rgb + batches->values, NULL, n, (double)n * batches->samples, 0};
    return r;
}

static ec_noise_test compare(const render *a, const render *b)
{
    ec_noise_test test;
    ec_error err = {0};
    if (ec_test_noise(&a->measured, &b->measured, &test, &err) != EC_OK) case_end("compare", &err);
    return test;
}

typedef struct tally {
    int pairs, at_one, at_five, mean_at_five;
} tally;

static void add_pair(const render *a, const render *b, tally *sum)
{
    ec_noise_test test = compare(a, b);
    sum->pairs++;
    sum->at_one += test.p < 0.01;
    sum->at_five += test.p < 0.05;
    sum->mean_at_five += test.p_mean < 0.05;
    CHECK_MSG(test.exact_unequal == 0, "%llu exact values differ", (unsigned long long)test.exact_unequal);
}

static void equal_lengths(const case_batches *batches, tally *sum)
{
    for (uint32_t i = 0; i + 2 * BATCHES <= ALL; i += 2 * BATCHES) {
        render a = make_render(batches, i, BATCHES), b = make_render(batches, i + BATCHES, BATCHES);
        add_pair(&a, &b, sum);
        free(a.rgb);
        free(b.rgb);
    }
}

static void against_long_ones(const case_batches *batches, tally *sum)
{
    for (uint32_t k = 0; k < ALL / LONG; k++) {
        render reference = make_render(batches, k * LONG, LONG);
        for (uint32_t i = 0; i < LONG; i += BATCHES) {
            render a = make_render(batches, (k + 1) * LONG + i, BATCHES);
            add_pair(&a, &reference, sum);
            free(a.rgb);
        }
        free(reference.rgb);
    }
}

static void brighter(const alarm_case *c, const case_batches *batches)
{
    if (!c->bright_batches) return;
    render a = make_render(batches, 0, c->bright_batches), b = make_render(batches, ALL / 2, c->bright_batches);
    double before = compare(&a, &b).p;
    for (uint64_t i = 0; i < 2 * batches->values; i++) a.rgb[i] *= 1.01f; /* its standard errors too */
    ec_noise_test test = compare(&a, &b);
    printf("%-26s 1 %% brighter, %u batches: p %.2g (before %.2g), mean off by %.1f standard errors\n", c->name, c->bright_batches, test.p,
           before, test.mean_t[1]);
    CHECK_MSG(test.p < EC_NOISE_SIGNIFICANCE, "%s: 1 %% brighter is not found, p %g", c->name, test.p);
    free(a.rgb);
    free(b.rgb);
}

static void check_case(const alarm_case *c, tally *all)
{
    if (!case_present(c->path) || (c->environment && !case_present(c->environment))) {
        printf("%-26s not there\n", c->name);
        return;
    }
    ec_scene *scene = case_load(c->path, c->environment);
    ec_render_options o = case_options(c->width, c->height, ALL * 16);
    o.batch = 16;
    o.max_depth = c->max_depth;
    o.seed = 11;
    case_batches batches = case_render_batches(scene, &o);
    tally equal = {0}, longer = {0};
    equal_lengths(&batches, &equal);
    against_long_ones(&batches, &longer);
    tally sum = {equal.pairs + longer.pairs, equal.at_one + longer.at_one, equal.at_five + longer.at_five, equal.mean_at_five + longer.mean_at_five};
    printf("%-26s below 0.01: %d of %d pairs, %d of %d against long renders; below 0.05: %d, %d (mean alone %d)\n", c->name, equal.at_one,
           equal.pairs, longer.at_one, longer.pairs, equal.at_five, longer.at_five, sum.mean_at_five);
    CHECK_MSG(sum.at_one <= 0.04 * sum.pairs && sum.at_five <= 0.09 * sum.pairs, "%s", c->name);
    brighter(c, &batches);
    all->pairs += sum.pairs, all->at_one += sum.at_one, all->at_five += sum.at_five, all->mean_at_five += sum.mean_at_five;
    case_batches_free(&batches);
    ec_scene_free(scene);
}

int main(void)
{
    static const char studio[] = SHARED("assets/env/pmndrs-assets/studio.hdr");
    static const alarm_case cases[] = {
        {"cornell-box", OWN_SCENE("cornell-box/cornell-box.gltf"), NULL, 32, 32, 5, 64},
        {"plates under studio.hdr", OWN_SCENE("furnace/plates.gltf"), studio, 32, 32, 4, 64},
        {"spheres under studio.hdr", OWN_SCENE("furnace/spheres.gltf"), studio, 48, 16, 0, 0},
        {"veach-plates", OWN_SCENE("veach-plates/veach-plates.gltf"), NULL, 32, 32, 4, 640},
        {"ring, caustic", OWN_SCENE("ring/ring.gltf"), NULL, 48, 32, 0, 256},
    };
    tally all = {0};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) check_case(&cases[i], &all);
    printf("all scenes: of %d pairs %d below 0.01, %d below 0.05; the mean alone %d\n", all.pairs, all.at_one, all.at_five, all.mean_at_five);
    CHECK(all.at_one <= 0.01 * all.pairs + 3 * sqrt(0.01 * all.pairs) && all.at_five <= 0.05 * all.pairs + 3 * sqrt(0.05 * all.pairs));
    CHECK_MSG(all.mean_at_five >= 0.02 * all.pairs, "a test that never raises an alarm tests nothing");
    TEST_END();
}
