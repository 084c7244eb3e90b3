/* Do the intervals of single pixels hold the truth as often as they say? Each scene is rendered 100 times at 256 samples a pixel
 * in 16 batches; the truth is the mean of the other 99 renders. Counted are values (pixel and channel) that are not exact and
 * whose pixel is not flagged as heavy-tailed: 94 to 96 % of them have to be held.
 *
 * The truth's own noise, a hundredth of the render's variance, makes for 0.1 % too few. The count itself is good to 0.1 %.
 *
 * `lamps` has a bulb smaller than a pixel that lights a whole room from behind a shade: 14 pixels of 15 are flagged, and the few
 * others, of which no neighbour has met the worst paths, hold the truth less often: 91 %. That may not get worse.
 *
 * ctest label: long */
#include "film/interval.h"
#include "support/batches.h"

enum { RENDERS = 100, BATCHES = 16, BATCH = 16 };

typedef struct coverage_case {
    const char *name, *path, *environment;
    uint32_t width, height, max_depth;
    double least, most, least_kept; /* % */
} coverage_case;

typedef struct tally {
    uint64_t values, kept, held, plain_held, flagged, flagged_held;
} tally;

static void count_values(const case_batches *batches, const ec_film *film, tally *sum)
{
    uint64_t values = batches->values;
    float *low = malloc(4 * values * sizeof *low), *high = low + values, *heavy = high + values, *se = heavy + values;
    double t = ec_student_t_quantile(0.975, film->batch_count - 1.0);
    ec_film_interval_rows(film, 0, film->height, low, high, heavy);
    ec_film_resolve(film, NULL, se);
    for (uint64_t i = 0; i < values; i++) {
        double truth = case_truth_without(batches, film, i), mean = film->mean[i];
        if (batches->film.m2[i / 3 * 4 + i % 3] <= 1e-10 * mean * mean) continue; /* exact but for rounding */
        int is_held = low[i] <= truth && truth <= high[i];
        sum->values++;
        sum->kept += !heavy[i / 3];
        sum->held += is_held && !heavy[i / 3];
        sum->plain_held += fabs(mean - truth) <= t * se[i] && !heavy[i / 3];
        sum->flagged_held += is_held && heavy[i / 3];
    }
    free(low);
}

static void check_case(const coverage_case *c)
{
    if (!case_present(c->path) || (c->environment && !case_present(c->environment))) {
        printf("%-26s not there\n", c->name);
        return;
    }
    ec_scene *scene = case_load(c->path, c->environment);
    ec_render_options o = case_options(c->width, c->height, RENDERS * BATCHES * BATCH);
    o.batch = BATCH;
    o.max_depth = c->max_depth;
    o.seed = 7;
    case_batches batches = case_render_batches(scene, &o);
    tally sum = {0};
    for (uint32_t i = 0; i < RENDERS; i++) {
        ec_film film = case_film_of(&batches, i * BATCHES, BATCHES);
        count_values(&batches, &film, &sum);
        ec_film_destroy(&film);
    }
    double held = 100.0 * (double)sum.held / (double)sum.kept, kept = 100.0 * (double)sum.kept / (double)sum.values;
    printf("%-26s %6.2f %% of %5.1f %% unflagged (t-interval %6.2f %%), flagged %6.2f %%\n", c->name, held, kept,
           100.0 * (double)sum.plain_held / (double)sum.kept, 100.0 * (double)sum.flagged_held / (double)(sum.values - sum.kept));
    CHECK_MSG(held >= c->least && held <= c->most, "%s: %.2f %% of unflagged values", c->name, held);
    CHECK_MSG(kept >= c->least_kept, "%s: only %.1f %% are unflagged", c->name, kept); /* flagging all would be easy */
    case_batches_free(&batches);
    ec_scene_free(scene);
}

int main(void)
{
    static const char studio[] = SHARED("assets/env/pmndrs-assets/studio.hdr");
    static const coverage_case cases[] = {
        {"box of emitting walls", OWN_SCENE("furnace/box-materials.gltf"), NULL, 32, 32, 0, 94, 96, 80},
        {"cornell-box", OWN_SCENE("cornell-box/cornell-box.gltf"), NULL, 32, 32, 5, 94, 96, 80},
        {"plates under studio.hdr", OWN_SCENE("furnace/plates.gltf"), studio, 32, 32, 4, 94, 96, 90},
        {"spheres under studio.hdr", OWN_SCENE("furnace/spheres.gltf"), studio, 60, 20, 0, 94, 96, 50},
        {"veach-plates, glossy", OWN_SCENE("veach-plates/veach-plates.gltf"), NULL, 48, 32, 4, 94, 96, 55},
        {"ring, caustic", OWN_SCENE("ring/ring.gltf"), NULL, 48, 32, 0, 94, 96, 50},
        {"showcase", OWN_SCENE("showcase/showcase.gltf"), NULL, 36, 24, 0, 94, 96, 50},
        {"lamps", OWN_SCENE("lamps/lamps.gltf"), NULL, 24, 24, 0, 90, 96, 4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) check_case(&cases[i]);
    TEST_END();
}
