#include "jobs/render_plan.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "render/goal.h"

enum { ROUNDS_MORE = 2 }; /* rounds measured beyond those that a forecast needs */

#define ENOUGH_SECONDS 5.0

typedef struct pilot {
    const ec_listener *listener;
    uint64_t pixels;
    double one, two, most;       /* samples of the picture after the first round, the second, and all that are measured */
    bool is_predicted;            /* the number of samples is predicted by the film */
    ec_mark first, last;         /* the end of the first round, and of the last one so far */
} pilot;

static bool watch(void *user, const ec_progress *progress)
{
    pilot *p = user;
    const double done = (double)progress->samples;
    if (p->first.samples == 0 && done >= p->one) p->first = (ec_mark){done, progress->seconds};
    if (done > p->last.samples) p->last = (ec_mark){done, progress->seconds};
    const bool suffices = done >= p->two && !p->is_predicted && progress->seconds > ENOUGH_SECONDS;
    return done < p->most && !suffices && !p->listener->should_stop(p->listener->user);
}

enum { TIMES = 3 }; /* timed, after one untimed run that touches the memory */

/* Times what the render does with each batch. */
static ec_result time_batches(ec_film *film, const float *batch, const float *features, double *seconds, ec_error *err)
{
    double start = 0;
    for (uint32_t i = 0; i <= TIMES; i++) {
        if (i == 1) start = ec_now();
        EC_TRY(ec_film_take(film, &(ec_film_batch){.index = i, .values = batch, .features = features}, err));
        (void)ec_film_estimate_error(film);
    }
    *seconds = (ec_now() - start) / TIMES;
    return EC_OK;
}

/* Times what the render does with each block of batches. */
static ec_result time_blocks(ec_film *film, double *seconds, ec_error *err)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
    *seconds = 0;
    for (uint32_t i = 0; i <= TIMES; i++) {
        ec_film_part part = {.first = EC_FILM_FIRST * i, .count = EC_FILM_FIRST};
        if (!ec_sums_create(&part.sums, film->replicates, ec_film_sets(film, part.first), pixels)) return ec_fail(err, "out of memory for a block of batches");
        const double start = ec_now();
        EC_TRY(ec_film_insert(film, &part, err));
        (void)ec_film_estimate_error(film);
        if (i > 0) *seconds += (ec_now() - start) / TIMES;
    }
    return EC_OK;
}

static ec_result time_sums(const ec_film *like, ec_plan *plan, ec_error *err)
{
    ec_film batches = {0}, blocks = {0};
    const uint64_t pixels = (uint64_t)like->width * like->height;
    const uint32_t sets = like->feature_end == UINT32_MAX ? like->feature_sets : 0;
    float *batch = calloc(pixels, EC_BATCH_FIELDS * sizeof *batch), *features = sets ? calloc(pixels, EC_FILM_FEATURES * sizeof *features) : NULL;
    ec_result result = batch && (features || !sets) ? ec_film_create(&batches, like->width, like->height, like->replicates, err)
                                                    : ec_fail(err, "out of memory for a batch");
    ec_film_want_features(&batches, sets, UINT32_MAX);
    if (result == EC_OK) result = time_batches(&batches, batch, features, &plan->add, err);
    ec_film_destroy(&batches);
    if (result == EC_OK) result = ec_film_create(&blocks, like->width, like->height, like->replicates, err);
    ec_film_want_features(&blocks, sets, UINT32_MAX);
    if (result == EC_OK) result = time_blocks(&blocks, &plan->add_block, err);
    ec_film_destroy(&blocks);
    free(batch);
    free(features);
    return result;
}

static void set_rounds(pilot *p, uint32_t replicates)
{
    const uint32_t first = (uint32_t)ec_schedule_round(replicates, 0), second = (uint32_t)ec_schedule_round(replicates, first);
    uint32_t last = second;
    while (!ec_schedule_has_pilot(replicates, last)) last = (uint32_t)ec_schedule_round(replicates, last);
    for (int more = 0; more < ROUNDS_MORE; more++) last = (uint32_t)ec_schedule_round(replicates, last);
    p->one = (double)(ec_schedule_samples(replicates, first) * p->pixels); /* the first round also warms up the device */
    p->two = (double)(ec_schedule_samples(replicates, second) * p->pixels);
    p->most = (double)(ec_schedule_samples(replicates, last) * p->pixels);
}

ec_result ec_render_plan(ec_render_job *job, ec_plan *plan, ec_error *err)
{
    const ec_listener *listener = job->listener;
    ec_render_options options = job->request->options;
    const uint32_t replicates = ec_render_replicates(&options);
    pilot p = {.listener = listener, .pixels = (uint64_t)options.width * options.height, .is_predicted = !options.spp};
    set_rounds(&p, replicates);
    options.adaptive = false;
    options.compile = EC_COMPILE_FIRST; /* so that the kernels measured are those that all will use */
    ec_cl cl = {0};
    EC_TRY(ec_cl_open(job->devices, &cl, err));
    listener->begin(listener->user, &options, true);
    ec_say(&listener->log, "measuring up to %.0f samples a pixel on %s", p.most / (double)p.pixels, job->devices->name);
    ec_result result = ec_render(&cl, job->scene, &options, watch, &p, &job->film, &job->stats, &listener->log, err);
    ec_cl_close(&cl);
    listener->end(listener->user);
    EC_TRY(result);
    if (!(p.last.samples > p.first.samples)) return ec_fail(err, "--plan: the pilot ended before its second round; give more --spp or --time");
    const ec_render_stats *s = &job->stats;
    const double samples = options.spp ? options.spp : s->forecast.samples;
    if (!(samples < 1e9)) return ec_fail(err, "--plan: the number of samples is unknown; give --spp N, or an --error that a pilot can predict");
    uint32_t before;
    const double batches = ec_schedule_find(replicates, (uint64_t)samples, &before) + (before > 0), a_batch = samples / batches;
    const double a_sample = (p.last.seconds - p.first.seconds) / (p.last.samples - p.first.samples) * (double)p.pixels;
    *plan = (ec_plan){.load = job->load_seconds + s->accel_seconds + s->pack_seconds, .start = s->kernel_seconds,
                    .batch = a_batch * a_sample, .scene_bytes = s->scene_bytes, .pixels = p.pixels,
                    .batches = batches, .batches_predicted = !options.spp, .samples = a_batch, .replicates = replicates,
                    .feature_sets = ec_render_feature_end(&options) == UINT32_MAX ? ec_render_feature_sets(&options) : 0,
                    .gbit = job->request->plan_gbit, .microseconds = job->request->plan_microseconds, .ranks = job->request->plan_ranks};
    const uint64_t rows = 8ull * options.width, wave = (uint64_t)(s->wave / a_batch); /* cut as in render/team.c */
    plan->least = (uint64_t)fmin(fmax((double)rows, (double)wave), (double)plan->pixels);
    return time_sums(&job->film, plan, err);
}
