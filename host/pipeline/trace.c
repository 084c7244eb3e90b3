/* Which accelerator a bounce goes through, where several are in use. Hits are the same, so only time is at stake. */
#include "base/clock.h"
#include "pipeline/pipeline.h"

/* Tries each at each of the first bounces, then keeps the fastest. The best of three counts (after one that may compile),
 * since other programs can only slow a trial down. Rays only lose coherence from bounce to bounce: packets are tried where
 * they have won the bounce before, and until then the last of the table takes over. */
#define TRIALS 4
static uint32_t choose(const ec_pipeline *p, int connect, uint32_t bounce, bool *is_trial)
{
    uint32_t last = 0, count = 0, best = 0;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (p->accels[a].in_use) last = a, count++;
    *is_trial = false;
    if (count < 2) return last;
    for (uint32_t b = 0; b <= bounce && b < EC_TUNED_BOUNCES; b++) {
        double best_rate = -1.0;
        for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
            if (!p->accels[a].in_use) continue;
            if (p->accels[a].tuning[connect][b].trials < TRIALS) {
                *is_trial = b == bounce;
                return *is_trial ? a : last;
            }
            double rate = p->accels[a].tuning[connect][b].best_rate;
            if (rate > best_rate) best = a, best_rate = rate;
        }
        if (ec_accels[best].lanes != EC_LANES_OF_PIPELINE) return best;
    }
    return best;
}

ec_result ec_pipeline_trace(ec_pipeline *p, int connect, uint32_t bounce, const uint32_t *scalars, ec_error *err)
{
    bool is_trial;
    uint32_t a = choose(p, connect, bounce, &is_trial);
    if (!is_trial) return ec_pipeline_launch_trace(p, connect, a, scalars, err);
    ec_counters *counters = &p->counters;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, sizeof *counters, counters, err));
    double start = ec_now();
    EC_TRY(ec_pipeline_launch_trace(p, connect, a, scalars, err));
    EC_TRY(ec_cl_finish(p->cl, err));
    uint32_t step = scalars[EC_ARG_STEP];
    uint64_t rays = ec_pipeline_total(connect ? counters->shadows[step] : counters->rays[step]);
    double rate = (double)rays / (ec_now() - start), *best = &p->accels[a].tuning[connect][bounce].best_rate;
    if (p->accels[a].tuning[connect][bounce].trials++ == 0) return EC_OK;
    if (rate > *best) *best = rate;
    p->clocked_seconds += (double)rays / rate;
    p->clocked_rays += (double)rays;
    return EC_OK;
}
