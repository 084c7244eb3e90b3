/* Sets up a rung on the device. */
#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "cost/cost_internal.h"

enum { LARGEST_BATCH = 256 }; /* samples for which waves are sized; pictures may have more */

bool ec_cost_go_on(void *user)
{
    ec_cost_study *study = user;
    ec_cost_progress progress = {.doing = study->doing, .count = study->row_count, .seconds = ec_now() - study->start, .budget = study->budget};
    while (progress.done < study->row_count && study->rows[progress.done].state != EC_COST_PENDING) progress.done++;
    if (study->go_on && !study->go_on(study->user, &progress)) study->interrupted = true;
    return !study->interrupted;
}

static ec_result open_session(ec_cost_study *study, const ec_cost_rung *rung, ec_session **session,
                              ec_render_stats *stats, ec_error *err)
{
    uint64_t before = study->cl->allocated_bytes;
    ec_render_options options = rung->options;
    options.compile = EC_COMPILE_FIRST; /* rendering is measured with the fast kernels */
    options.clamp_luminance = options.clamp * study->reference.mean_luminance; /* no pilot knows it better */
    study->cl->peak_allocated_bytes = before;
    ec_result result = ec_session_open(study->cl, study->scene, &options, LARGEST_BATCH, session, stats, err);
    stats->device_bytes = study->cl->peak_allocated_bytes - before;
    return result;
}

/* Opens a runner. The first picture includes what drivers compile at the first launch; the second tells how much of its time that was. */
ec_result ec_cost_runner_open(ec_cost_study *study, const ec_cost_rung *rung, ec_cost_runner *runner, ec_render_stats *stats,
                              double *setup, ec_error *err)
{
    double start = ec_now(), first = 0, second = 0;
    uint64_t pixels = (uint64_t)rung->options.width * rung->options.height;
    *runner = (ec_cost_runner){.study = study, .pixels = pixels, .denoises = rung->options.denoise, .replicates = ec_render_replicates(&rung->options),
                               .mean = malloc(pixels * 12), .room = malloc(pixels * 12)};
    if (!runner->mean || !runner->room) return ec_fail(err, "out of memory for a picture of %llu pixels", (unsigned long long)pixels);
    EC_TRY(open_session(study, rung, &runner->session, stats, err));
    *setup = ec_now() - start;
    EC_TRY(ec_cost_runner_take(runner, ec_session_seed(0, 0, 0), 1, &first, err));
    if (!runner->stopped) EC_TRY(ec_cost_runner_take(runner, ec_session_seed(0, 0, 1), 1, &second, err));
    *setup += fmax(first - second, 0);
    runner->invalid = 0;
    runner->denoise_seconds = 0;
    runner->denoised = 0;
    return EC_OK;
}

void ec_cost_runner_close(ec_cost_runner *runner)
{
    ec_session_close(runner->session);
    free(runner->mean);
    free(runner->room);
    *runner = (ec_cost_runner){0};
}

static void add_up(ec_cost_runner *runner, uint32_t count)
{
    for (uint64_t i = 0; i < 3 * runner->pixels; i++) {
        const float before = count > 1 ? runner->mean[i] : 0;
        runner->mean[i] = before + (runner->room[i] - before) / (float)count;
    }
}

/* Takes a picture as a render does: the samples are divided among replicates (film/schedule.h). */
ec_result ec_cost_runner_take(ec_cost_runner *runner, uint32_t seed, uint32_t samples, double *seconds, ec_error *err)
{
    const uint32_t count = samples < runner->replicates ? samples : runner->replicates;
    if (runner->denoises) return ec_cost_denoised_take(runner, seed, samples, ec_cost_go_on, seconds, err);
    *seconds = 0;
    for (uint32_t r = 0; r < count; r++) {
        ec_session_batch batch = {.seed = seed, .replicate = r, .samples = samples / count + (r < samples % count),
                                  .go_on = ec_cost_go_on, .user = runner->study, .rgb = runner->room};
        EC_TRY(ec_session_take(runner->session, &batch, err));
        runner->stopped = !batch.complete;
        if (runner->stopped) return EC_OK;
        runner->invalid += batch.invalid;
        *seconds += batch.seconds;
        add_up(runner, r + 1);
    }
    runner->seconds_per_sample = *seconds / ((double)samples * (double)runner->pixels);
    return EC_OK;
}
