#include "cli/render_plan.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "cli/stop.h"
#include "ranks/plan.h"

enum { PILOT_BATCHES = 5 }; /* the first also warms the device up; a forecast wants four */

#define ENOUGH_SECONDS 5.0

typedef struct pilot {
    uint64_t batch_samples, batches;
    bool is_foretold;    /* by its film: that takes four of them */
    double first, last;  /* when the first and the last of them were done */
} pilot;

static bool watch(void *user, const ec_progress *progress)
{
    pilot *p = user;
    uint64_t done = progress->samples / p->batch_samples;
    if (done > p->batches && progress->samples % p->batch_samples == 0) {
        if (!p->batches) p->first = progress->seconds;
        p->last = progress->seconds;
        p->batches = done;
    }
    bool suffices = done >= 2 && !p->is_foretold && progress->seconds > ENOUGH_SECONDS;
    return done < PILOT_BATCHES && !suffices && !ec_stop_requested();
}

enum { TIMES = 3 }; /* and once before, which touches the memory */

/* As the render does with each batch. */
static ec_result time_batches(ec_film *film, const float *batch, double *seconds, ec_error *err)
{
    double start = 0;
    for (uint32_t i = 0; i <= TIMES; i++) {
        if (i == 1) start = ec_now();
        EC_TRY(ec_film_add_at(film, i, batch, err));
        (void)ec_film_estimate_error(film);
    }
    *seconds = (ec_now() - start) / TIMES;
    return EC_OK;
}

/* And with each block. */
static ec_result time_blocks(ec_film *film, const ec_film *like, double *seconds, ec_error *err)
{
    const ec_moments sums = {like->mean, like->m2, like->m34, like->largest};
    const uint64_t pixels = (uint64_t)film->width * film->height;
    *seconds = 0;
    for (uint32_t i = 0; i <= TIMES; i++) {
        ec_film_part part = {.first = EC_FILM_RADIX * i, .count = EC_FILM_RADIX};
        if (!ec_moments_create(&part.sums, pixels)) return ec_fail(err, "out of memory for a block of batches");
        ec_moments_copy(&part.sums, &sums, pixels);
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
    float *batch = malloc((uint64_t)like->width * like->height * 3 * sizeof *batch);
    if (!batch) return ec_fail(err, "out of memory for a batch");
    ec_film_resolve(like, batch, NULL);
    ec_result result = ec_film_create(&batches, like->width, like->height, like->samples_per_batch, err);
    if (result == EC_OK) result = time_batches(&batches, batch, &plan->add, err);
    ec_film_destroy(&batches);
    if (result == EC_OK) result = ec_film_create(&blocks, like->width, like->height, like->samples_per_batch, err);
    if (result == EC_OK) result = time_blocks(&blocks, like, &plan->add_block, err);
    ec_film_destroy(&blocks);
    free(batch);
    return result;
}

ec_result ec_render_plan(ec_render_job *job, ec_console *console, ec_error *err)
{
    const ec_log log = ec_console_log(console);
    ec_render_options options = job->request->options;
    uint32_t batch = ec_render_batch(&options);
    pilot p = {.batch_samples = (uint64_t)options.width * options.height * batch, .is_foretold = !options.spp};
    options.batch = batch;
    options.adaptive = false;
    ec_cl cl = {0};
    EC_TRY(ec_cl_open(job->devices, &cl, err));
    ec_stop_catch_signals(false);
    ec_console_say(console, "measuring up to %d batches of %u samples a pixel on %s", PILOT_BATCHES, batch, job->devices->name);
    ec_result result = ec_render(&cl, job->scene, &options, watch, &p, &job->film, &job->stats, &log, err);
    ec_cl_close(&cl);
    EC_TRY(result);
    if (p.batches < 2) return ec_fail(err, "--plan: the pilot was over before its second batch; give more --spp or --time");
    const ec_render_stats *s = &job->stats;
    ec_plan plan = {.load = job->load_seconds + s->accel_seconds + s->pack_seconds, .start = s->kernel_seconds,
                    .batch = (p.last - p.first) / (double)(p.batches - 1), .scene_bytes = s->scene_bytes, .pixels = p.batch_samples / batch,
                    .batches = options.spp ? (double)((options.spp + batch - 1) / batch) : s->forecast.samples / batch,
                    .batches_foretold = !options.spp, .samples = batch, .gbit = job->request->plan_gbit,
                    .microseconds = job->request->plan_microseconds, .ranks = job->request->plan_ranks};
    if (!isfinite(plan.batches)) return ec_fail(err, "--plan: how many samples it takes is not known; give --spp N, or an --error that a pilot can foretell");
    const uint64_t rows = 8ull * options.width, wave = s->wave / batch; /* as pipeline/team.c cuts them */
    plan.least = fmin(fmax(rows, wave), plan.pixels);
    EC_TRY(time_sums(&job->film, &plan, err));
    if (job->request->json) return ec_plan_json(&plan, stdout, err);
    ec_plan_text(&plan, job->devices->name, stdout);
    return EC_OK;
}
