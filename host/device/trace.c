/* Chooses which accelerator a bounce traverses, where several are in use, and whether its packets sort their rays first. Hits are the same, so only
 * time is at stake. */
#include <math.h>

#include "base/clock.h"
#include "device/pipeline.h"

/* An accelerator, and whether its packets sort their rays; camera rays are neighbours as they come. */
typedef struct way {
    uint32_t accel, sorts;
} way;

/* Kinds of rays that are tuned separately. */
typedef struct kind {
    int of_light, connect;
} kind;

static bool is_packets(uint32_t accel) { return ec_accels[accel].lanes == EC_LANES_OF_PIPELINE; }

/* Lists all ways to trace a bounce; returns how many. */
static uint32_t list_ways(const ec_pipeline *p, kind k, uint32_t bounce, way ways[2 * EC_ACCEL_COUNT])
{
    uint32_t count = 0;
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++) {
        if (!(p->kernels.accels >> a & 1)) continue;
        ways[count++] = (way){a, 0};
        if (is_packets(a) && p->kernels.lanes > 1 && (bounce > 0 || k.of_light)) ways[count++] = (way){a, 1};
    }
    return count;
}

static struct ec_tuning *tuning_of(ec_pipeline *p, kind k, uint32_t bounce, way w)
{
    return &p->accels[w.accel].tuning[k.of_light][k.connect][bounce][w.sorts];
}

/* Tries each way at each of the first bounces, then keeps the fastest. The best of three trials counts (after one that may compile), since other
 * programs can only slow a trial down. Rays only lose coherence from bounce to bounce: packets are tried where they have won the bounce before, and
 * until then the last of the list is used. */
#define TRIALS 4
static way choose(ec_pipeline *p, kind k, uint32_t bounce, bool *is_trial)
{
    way ways[2 * EC_ACCEL_COUNT], best = {0};
    *is_trial = false;
    for (uint32_t b = 0; b <= bounce && b < EC_TUNED_BOUNCES; b++) {
        const uint32_t count = list_ways(p, k, b, ways);
        double best_rate = -1.0;
        best = ways[0]; /* if there is no other */
        for (uint32_t w = 0; w < count && count > 1; w++) {
            const struct ec_tuning *tuning = tuning_of(p, k, b, ways[w]);
            if (tuning->trials < TRIALS) {
                *is_trial = b == bounce;
                return ways[*is_trial ? w : count - 1];
            }
            if (tuning->best_rate > best_rate) best = ways[w], best_rate = tuning->best_rate;
        }
        if (!is_packets(best.accel)) return best;
    }
    return best;
}

ec_result ec_pipeline_trace(ec_pipeline *p, int connect, uint32_t bounce, uint32_t *scalars, ec_error *err)
{
    const kind k = {(scalars[EC_ARG_BOUNCE] & EC_LIGHT_BOUNCE) != 0, connect};
    bool is_trial;
    const way w = choose(p, k, bounce, &is_trial);
    scalars[EC_ARG_SORTS] = w.sorts;
    if (!is_trial) return ec_pipeline_launch_trace(p, connect, w.accel, scalars, err);
    ec_counters *counters = &p->counters;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, ec_counters_bytes(scalars[EC_ARG_STEP]), counters, err));
    double start = ec_now();
    EC_TRY(ec_pipeline_launch_trace(p, connect, w.accel, scalars, err));
    EC_TRY(ec_cl_finish(p->cl, err));
    uint32_t step = scalars[EC_ARG_STEP];
    uint64_t rays = ec_pipeline_total(connect ? counters->at[step].shadows : counters->at[step].rays);
    const double rate = (double)rays / (ec_now() - start);
    struct ec_tuning *tuning = tuning_of(p, k, bounce, w);
    if (tuning->trials++ == 0) return EC_OK;
    tuning->best_rate = fmax(tuning->best_rate, rate);
    p->clocked_seconds += (double)rays / rate;
    p->clocked_rays += (double)rays;
    return EC_OK;
}
