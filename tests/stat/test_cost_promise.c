/* tier: full */
/* `eclat render --error` agrees with `eclat cost`. On four scenes, pictures of 1, 2, 4, … samples a pixel are measured as in a study, and a
 * render stops at an error target. The error that the study predicts for as many samples, and the error that the render states, agree
 * within 4 of their standard errors, which a correct program exceeds in one run of ten thousand, and a tenth for the straight line between
 * two points of the curve. */
#include "support/cost_reference.h"

enum { PICTURES = 12, MOST = 256, REFERENCE = 2048 };

typedef struct promise_case {
    const char *name, *path;
    uint32_t width, height, max_depth;
    double target;
} promise_case;

/* Numbers of pictures are fixed, not times, so that the figures are the same in every run. */
static ec_cost_row measure(ec_cost_study *study)
{
    ec_cost_row row = {.rung = {.options = study->options, .unbiased = true}};
    ec_cost_runner runner = {0};
    ec_cost_tally tally = {0};
    ec_render_stats stats;
    ec_error err = {0};
    double seconds;
    uint32_t index = 0;
    CHECK_OK(ec_cost_runner_open(study, &row.rung, &runner, &stats, &seconds, &err), err);
    CHECK_OK(ec_cost_tally_create(&study->reference, runner.pixels, &tally, &err), err);
    for (uint32_t samples = 1; samples <= MOST; samples *= 2) {
        ec_cost_tally_begin(&tally, samples);
        for (int i = 0; i < PICTURES; i++) {
            CHECK_OK(ec_cost_runner_take(&runner, ec_session_seed(1, EC_COST_STREAM_RUNGS, index++), samples, &seconds, &err), err);
            ec_cost_tally_add(&tally, runner.mean);
        }
        ec_cost_tally_end(&tally, &row);
    }
    ec_cost_tally_free(&tally);
    ec_cost_runner_close(&runner);
    return row;
}

/* Squared error after so many samples, interpolated between two points of the curve; and its relative standard error. */
static double curve_at(const ec_cost_row *row, double samples, double *se)
{
    uint32_t i = 1;
    while (i + 1 < row->point_count && row->points[i].samples < samples) i++;
    const ec_cost_point *a = &row->points[i - 1], *b = &row->points[i];
    const double part = log(samples / a->samples) / log((double)b->samples / a->samples);
    *se = fmax(a->mse_se / a->mse, b->mse_se / b->mse);
    return a->mse * pow(b->mse / a->mse, part);
}

static void check(const promise_case *c)
{
    ec_render_options o = case_defaults(c->width, c->height, 0);
    o.max_depth = c->max_depth;
    ec_scene *scene = case_load(c->path, NULL);
    ec_cost_study study = {.cl = case_cl(), .scene = scene, .options = o, .reference = cost_reference(scene, &o, REFERENCE)};
    const ec_cost_row row = measure(&study);
    o.error_target = c->target;
    o.seed = 77;
    case_image image = case_render(scene, &o);
    double se;
    const double samples = (double)image.stats.samples_per_pixel, predicted = curve_at(&row, samples, &se);
    const double stated = image.stats.film.error * image.stats.film.error, spread = hypot(se, ec_film_estimate_error(&image.film).spread);
    printf("%-14s %4.0f samples for a bound of %g %%: error %.2f %% stated, %.2f %% predicted (+- %.0f %% of squares)\n", c->name, samples,
           100 * c->target, 100 * image.stats.film.error, 100 * sqrt(predicted), 100 * spread);
    CHECK(!strcmp(image.stats.stopped_by, "error") && image.stats.film.error_bound <= c->target && samples <= MOST);
    CHECK_MSG(fabs(log(stated / predicted)) <= 4 * spread + 0.1, "%s: %g stated, %g predicted", c->name, stated, predicted);
    case_free(&image);
    ec_cost_reference_free(&study.reference);
    ec_scene_free(scene);
}

int main(void)
{
    static const promise_case cases[] = {
        {"cornell-box", OWN_SCENE("cornell-box/cornell-box.gltf"), 32, 32, 5, 0.1},
        {"veach-plates", OWN_SCENE("veach-plates/veach-plates.gltf"), 32, 32, 3, 1.5},
        {"box", OWN_SCENE("furnace/box-materials.gltf"), 32, 32, 0, 0.05},
        {"showcase", OWN_SCENE("showcase/showcase.gltf"), 36, 24, 0, 0.25},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) check(&cases[i]);
    TEST_END();
}
