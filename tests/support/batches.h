/* Renders one scene many times with different seeds in a single session. Each render has the replicates and samples that `eclat render`
 * would take; all others together are its converged picture.
 *
 *     case_batches renders = case_render_many(scene, &options, count);    options.spp samples a pixel in each: whole rounds
 *     ec_film film = case_film_of(&renders, i);
 *     double truth = case_truth_without(&renders, i, k);                  value k of 3 a pixel
 *     ec_film_destroy(&film);
 *     case_batches_free(&renders); */
#ifndef EC_TESTS_SUPPORT_BATCHES_H
#define EC_TESTS_SUPPORT_BATCHES_H

#include "film/pixel.h"
#include "render/session.h"
#include "support/render_case.h"

typedef struct case_batches {
    uint32_t width, height, count, replicates, samples;
    uint64_t values;           /* 3 a pixel */
    float *data;               /* EC_BATCH_FIELDS a pixel, replicate and render */
    double *sum;               /* sum of all renders' means, `values` numbers */
} case_batches;

/* Takes all samples of replicate r of render i in one batch. In a session of one seed, further replicate numbers are independent
 * replicates. */
static inline void case_take_replicate(case_batches *b, ec_session *session, uint32_t seed, uint32_t r, float *into)
{
    ec_error err = {0};
    ec_session_batch batch = {.seed = seed, .replicate = r, .samples = b->samples / b->replicates, .batch = into};
    if (ec_session_take(session, &batch, &err) != EC_OK) case_end("render", &err);
    CHECK_MSG(batch.invalid == 0, "%llu values are not finite", (unsigned long long)batch.invalid);
}

static inline float *case_replicate(const case_batches *b, uint32_t i, uint32_t r)
{
    return b->data + ((uint64_t)i * b->replicates + r) * b->values / 3 * EC_BATCH_FIELDS;
}

static inline case_batches case_render_many(const ec_scene *scene, const ec_render_options *options, uint32_t count)
{
    ec_error err = {0};
    ec_render_stats stats;
    ec_session *session = NULL;
    case_batches b = {.width = options->width, .height = options->height, .count = count, .replicates = ec_render_replicates(options),
                      .samples = options->spp, .values = 3ull * options->width * options->height};
    b.data = malloc(b.values / 3 * EC_BATCH_FIELDS * b.replicates * count * sizeof *b.data);
    b.sum = calloc(b.values, sizeof *b.sum);
    if (!b.data || !b.sum || b.samples % b.replicates) exit(1);
    if (ec_session_open(case_cl(), scene, options, b.samples / b.replicates, &session, &stats, &err) != EC_OK) case_end("set-up", &err);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t r = 0; r < b.replicates; r++) {
            float *batch = case_replicate(&b, i, r);
            case_take_replicate(&b, session, ec_render_seed(options->seed + i), r, batch);
            for (uint64_t k = 0; k < b.values; k++) b.sum[k] += (double)batch[k / 3 * EC_BATCH_FIELDS + k % 3] / b.replicates;
        }
    ec_session_close(session);
    return b;
}

static inline void case_batches_free(case_batches *b)
{
    free(b->data);
    free(b->sum);
    memset(b, 0, sizeof *b);
}

/* Converts to the sums that a film has after these samples came batch by batch. */
static inline ec_film case_film_of(const case_batches *b, uint32_t i)
{
    ec_error err = {0};
    ec_film film;
    uint32_t before;
    ec_film_part part = {.count = ec_schedule_find(b->replicates, b->samples, &before)};
    if (before || part.count > EC_FILM_FIRST) exit(1);
    if (ec_film_create(&film, b->width, b->height, b->replicates, &err) != EC_OK) case_end("film", &err);
    if (!ec_sums_create(&part.sums, b->replicates, 0, b->values / 3)) exit(1);
    for (uint32_t r = 0; r < b->replicates; r++) ec_sums_add(&part.sums, case_replicate(b, i, r), r, 1, b->values / 3);
    if (ec_film_insert(&film, &part, &err) != EC_OK) case_end("film", &err);
    return film;
}

static inline double case_mean_of(const case_batches *b, uint32_t i, uint64_t k)
{
    double sum = 0;
    for (uint32_t r = 0; r < b->replicates; r++) sum += case_replicate(b, i, r)[k / 3 * EC_BATCH_FIELDS + k % 3];
    return sum / b->replicates;
}

static inline double case_truth_without(const case_batches *b, uint32_t i, uint64_t k)
{
    return (b->sum[k] - case_mean_of(b, i, k)) / (b->count - 1.0);
}

#endif
