/* One long render as many short ones: its batches are independent of each other, so every `n` of them make up a render of its
 * own, and all the others together are its converged picture. A hundred renders for the price of one set-up.
 *
 *     case_batches batches = case_render_batches(scene, &options);        options.spp and options.batch say how many
 *     ec_film film = case_film_of(&batches, first, n);
 *     double truth = case_truth_without(&batches, &film, i);              value i of 3 a pixel
 *     ec_film_destroy(&film);
 *     case_batches_free(&batches); */
#ifndef EC_TESTS_SUPPORT_BATCHES_H
#define EC_TESTS_SUPPORT_BATCHES_H

#include "support/render_case.h"

typedef struct case_batches {
    ec_film film;              /* all of them; also what the progress function looks at while they come in */
    uint32_t width, height, count, samples;
    uint64_t values;           /* 3 a pixel */
    float *data;               /* `values` a batch */
    double *previous;          /* the film's mean before the newest batch */
} case_batches;

/* The newest batch is what moved the mean. Its values were floats, and the mean keeps twice their digits: nothing is lost. */
static inline bool case_take_batch(void *user, const ec_progress *progress)
{
    case_batches *b = user;
    (void)progress;
    uint32_t n = b->film.batch_count;
    if (n == b->count) return true;
    if (n != b->count + 1) exit(1);
    ec_film_show(&b->film);
    float *to = b->data + b->count * b->values;
    for (uint64_t i = 0; i < b->values; i++) {
        to[i] = (float)(b->film.mean[i] * n - b->previous[i] * (n - 1));
        b->previous[i] = b->film.mean[i];
    }
    b->count = n;
    return true;
}

static inline case_batches case_render_batches(const ec_scene *scene, const ec_render_options *options)
{
    ec_error err = {0};
    ec_render_stats stats;
    case_batches b = {.width = options->width, .height = options->height, .samples = options->batch,
                      .values = 3ull * options->width * options->height};
    b.data = malloc(b.values * (options->spp / options->batch) * sizeof *b.data);
    b.previous = calloc(b.values, sizeof *b.previous);
    if (!b.data || !b.previous) exit(1);
    if (ec_render(case_cl(), scene, options, case_take_batch, &b, &b.film, &stats, NULL, &err) != EC_OK) case_end("render", &err);
    case_take_batch(&b, NULL); /* the last one ends the render without a word */
    CHECK_MSG(stats.invalid_samples == 0, "%llu samples are not finite", (unsigned long long)stats.invalid_samples);
    return b;
}

static inline void case_batches_free(case_batches *b)
{
    ec_film_destroy(&b->film);
    free(b->data);
    free(b->previous);
    memset(b, 0, sizeof *b);
}

static inline ec_film case_film_of(const case_batches *b, uint32_t first, uint32_t n)
{
    ec_error err = {0};
    ec_film film;
    if (ec_film_create(&film, b->width, b->height, b->samples, &err) != EC_OK) case_end("film", &err);
    for (uint32_t i = first; i < first + n; i++)
        if (ec_film_add_batch(&film, b->data + (i % b->count) * b->values, &err) != EC_OK) case_end("film", &err);
    return film;
}

static inline double case_truth_without(const case_batches *b, const ec_film *film, uint64_t i)
{
    double n = film->batch_count, all = b->count;
    return (b->film.mean[i] * all - film->mean[i] * n) / (all - n);
}

#endif
