/* tier: long */
/* `eclat compare` on renders of one scene that differ only in their seeds: counts how often it reports more than noise. It claims at most 1
 * in 100 at p < 0.01, and 5 in 100 below 0.05. A picture one per cent brighter must be found.
 *
 * Each scene is rendered 100 times with 256 samples. Pairs are one against one (50), and one against the replicates of twenty others joined
 * (100, twenty to a reference). Over all scenes, more than the claimed share and three standard errors is a fault; in one scene 9 % below
 * 0.05 and 4 % below 0.01, which 150 pairs exceed by chance in one case of 100. */
#include "film/noise_test.h"
#include "support/batches.h"

enum { SPP = 256, LONG = 20, ALL = 100 };

typedef struct alarm_case {
    const char *name, *path, *environment;
    uint32_t width, height, max_depth;
    uint32_t bright_renders; /* so many that 1 % is at least 4 standard errors of the mean; 0: too noisy for that */
} alarm_case;

typedef struct render {
    ec_measured measured;
    float *rgb;
} render;

/* The mean of n renders from `first` on: its replicate r is the mean of their replicates r. */
static render make_render(const case_batches *renders, uint32_t first, uint32_t n)
{
    const uint32_t replicates = renders->replicates;
    const uint64_t values = renders->values;
    render out = {.rgb = calloc(2 * values, sizeof(float))};
    for (uint64_t k = 0; k < values; k++) {
        double x[EC_REPLICATES_MOST] = {0}, mean = 0, m2 = 0;
        for (uint32_t r = 0; r < replicates; r++) {
            for (uint32_t i = 0; i < n; i++) x[r] += (double)case_replicate(renders, (first + i) % ALL, r)[k / 3 * EC_BATCH_FIELDS + k % 3] / n;
            mean += x[r] / replicates;
        }
        for (uint32_t r = 0; r < replicates; r++) m2 += (x[r] - mean) * (x[r] - mean);
        out.rgb[k] = (float)mean;
        out.rgb[values + k] = (float)sqrt(m2 / (replicates * (replicates - 1.0)));
    }
    out.measured = (ec_measured){renders->width, renders->height, out.rgb, out.rgb + values, NULL, replicates, (double)n * SPP, 0};
    return out;
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

static void equal_lengths(const case_batches *renders, tally *sum)
{
    for (uint32_t i = 0; i + 2 <= ALL; i += 2) {
        render a = make_render(renders, i, 1), b = make_render(renders, i + 1, 1);
        add_pair(&a, &b, sum);
        free(a.rgb);
        free(b.rgb);
    }
}

static void against_long_ones(const case_batches *renders, tally *sum)
{
    for (uint32_t k = 0; k < ALL / LONG; k++) {
        render reference = make_render(renders, k * LONG, LONG);
        for (uint32_t i = 0; i < LONG; i++) {
            render a = make_render(renders, (k + 1) * LONG + i, 1);
            add_pair(&a, &reference, sum);
            free(a.rgb);
        }
        free(reference.rgb);
    }
}

static void brighter(const alarm_case *c, const case_batches *batches)
{
    if (!c->bright_renders) return;
    render a = make_render(batches, 0, c->bright_renders), b = make_render(batches, ALL / 2, c->bright_renders);
    double before = compare(&a, &b).p;
    for (uint64_t i = 0; i < 2 * batches->values; i++) a.rgb[i] *= 1.01f; /* its standard errors are brighter too */
    ec_noise_test test = compare(&a, &b);
    printf("%-26s 1 %% brighter, %u renders: p %.2g (before %.2g), mean off by %.1f standard errors\n", c->name, c->bright_renders, test.p,
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
    ec_render_options o = case_defaults(c->width, c->height, SPP);
    o.max_depth = c->max_depth;
    o.seed = 11;
    case_batches batches = case_render_many(scene, &o, ALL);
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
        {"cornell-box", OWN_SCENE("cornell-box/cornell-box.gltf"), NULL, 32, 32, 5, 4},
        {"plates under studio.hdr", OWN_SCENE("furnace/plates.gltf"), studio, 32, 32, 4, 4},
        {"spheres under studio.hdr", OWN_SCENE("furnace/spheres.gltf"), studio, 48, 16, 0, 0},
        {"veach-plates", OWN_SCENE("veach-plates/veach-plates.gltf"), NULL, 32, 32, 4, 40},
        {"ring, caustic", OWN_SCENE("ring/ring.gltf"), NULL, 48, 32, 0, 16},
    };
    tally all = {0};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) check_case(&cases[i], &all);
    printf("all scenes: of %d pairs %d below 0.01, %d below 0.05; the mean alone %d\n", all.pairs, all.at_one, all.at_five, all.mean_at_five);
    CHECK(all.at_one <= 0.01 * all.pairs + 3 * sqrt(0.01 * all.pairs) && all.at_five <= 0.05 * all.pairs + 3 * sqrt(0.05 * all.pairs));
    CHECK_MSG(all.mean_at_five >= 0.02 * all.pairs, "a test that never raises an alarm tests nothing");
    TEST_END();
}
