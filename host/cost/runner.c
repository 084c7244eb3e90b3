/* A rung set up on the device. */
#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "cost/cost_internal.h"

enum { LARGEST_BATCH = 256 }; /* what waves are fitted to; pictures may have more samples */

static ec_result open_session(ec_cost_study *study, const ec_cost_rung *rung, ec_session **session,
                              ec_render_stats *stats, ec_error *err)
{
    uint64_t before = study->cl->allocated_bytes;
    study->cl->peak_allocated_bytes = before;
    ec_result result = ec_session_open(study->cl, study->scene, &rung->options, LARGEST_BATCH, session, stats, err);
    stats->device_bytes = study->cl->peak_allocated_bytes - before;
    return result;
}

/* The first picture compiles what drivers compile at the first launch, the second tells what of its time was that. */
ec_result ec_cost_runner_open(ec_cost_study *study, const ec_cost_rung *rung, ec_cost_runner *runner, ec_render_stats *stats,
                              double *setup, ec_error *err)
{
    double start = ec_now(), first = 0, second = 0;
    uint64_t pixels = (uint64_t)rung->options.width * rung->options.height;
    *runner = (ec_cost_runner){.study = study, .pixels = pixels, .mean = malloc(pixels * 12)};
    if (!runner->mean) return ec_fail(err, "out of memory for a picture of %llu pixels", (unsigned long long)pixels);
    EC_TRY(open_session(study, rung, &runner->session, stats, err));
    *setup = ec_now() - start;
    EC_TRY(ec_cost_runner_take(runner, ec_session_seed(0, 0, 0), 1, &first, err));
    if (!runner->stopped) EC_TRY(ec_cost_runner_take(runner, ec_session_seed(0, 0, 1), 1, &second, err));
    *setup += fmax(first - second, 0);
    runner->invalid = 0;
    return EC_OK;
}

void ec_cost_runner_close(ec_cost_runner *runner)
{
    ec_session_close(runner->session);
    free(runner->mean);
    *runner = (ec_cost_runner){0};
}

ec_result ec_cost_runner_take(ec_cost_runner *runner, uint32_t seed, uint32_t samples, double *seconds, ec_error *err)
{
    ec_session_batch batch = {.seed = seed, .samples = samples, .go_on = ec_cost_go_on, .user = runner->study, .mean = runner->mean};
    EC_TRY(ec_session_take(runner->session, &batch, err));
    runner->stopped = !batch.complete;
    if (runner->stopped) return EC_OK;
    runner->invalid += batch.invalid;
    runner->seconds_per_sample = batch.seconds / ((double)samples * (double)runner->pixels);
    *seconds = batch.seconds;
    return EC_OK;
}
