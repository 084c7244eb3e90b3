/* Finds the picture's mean luminance by a pilot before the picture's first sample, and sets the clamp's limit, which is given in multiples of it.
 *
 * The pilot's samples are spread over the picture, always the same ones, and none of the picture's own: whoever renders a part of a job, with
 * however many devices, finds the same. Its mean is the median of the means of 32 groups, since one bright path in one of them must not
 * decide what a bright path is; and it is rounded to a quarter of a power of two, so that devices whose last bits differ agree. */
#include <math.h>
#include <stdlib.h>

#include "device/adaptive.h"
#include "render/render_state.h"

enum { PILOT = 1 << 16 /* samples of the clamp's pilot */, GROUPS = 32 };
#define PILOT_FIRST (1u << 31) /* number of its first sample in a replicate: no picture has so many (EC_MAX_SPP) */

/* Writes entry i of the pilot: a pixel, and which sample of it. Small pictures have several of each pixel, one after the other, so that all groups
 * have some of them. */
static void write_entry(uint64_t i, uint32_t samples, uint64_t pixels, uint32_t *entry)
{
    entry[0] = (uint32_t)(i * pixels / samples);
    entry[1] = PILOT_FIRST + (uint32_t)i;
}

static bool goes_on(void *user, uint32_t done)
{
    (void)user, (void)done;
    return true;
}

/* Adds entries [first, first + count) of the pilot to the groups' sums. */
static ec_result take(ec_render_state *r, uint32_t samples, uint32_t first, uint32_t count, uint32_t *list, double sums[GROUPS], ec_error *err)
{
    const uint64_t pixels = (uint64_t)r->options->width * r->options->height;
    bool complete;
    for (uint32_t i = 0; i < count; i++) write_entry(first + i, samples, pixels, list + EC_LIST_WORDS * i);
    const ec_batch_order order = {.index = r->past.next, .end = r->past.next + 1, .batches = 1, .list = list, .samples = 1, .count = count,
                                  .go_on = goes_on};
    EC_TRY(r->source->take(r->source, &order, &complete, err));
    for (uint32_t i = 0; i < count; i++) {
        const float *rgb = r->source->mean + (uint64_t)EC_BATCH_FIELDS * i;
        const double y = ec_luminance((double[3]){rgb[0], rgb[1], rgb[2]});
        if (isfinite(y)) sums[(first + i) % GROUPS] += y;
    }
    return EC_OK;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Returns the mean by the groups' median. Where most groups have met no light, the mean of all has to do. */
static double middle(double sums[GROUPS], uint32_t samples)
{
    double all = 0;
    qsort(sums, GROUPS, sizeof *sums, compare);
    for (int i = 0; i < GROUPS; i++) all += sums[i] / GROUPS;
    const double median = 0.5 * (sums[GROUPS / 2 - 1] + sums[GROUPS / 2]);
    return (median > 0 ? median : all) / (samples / GROUPS);
}

/* Returns the nearest quarter of a power of two, in logarithms. */
static double rounded(double mean)
{
    static const double quarters[] = {1, 1.189207115002721, 1.4142135623730951, 1.681792830507429};
    const int steps = (int)lround(4 * log2(mean)), power = (int)floor(steps / 4.0);
    return ldexp(quarters[steps - 4 * power], power);
}

/* Takes off the rays and dropped samples of the pilot, which are not the picture's. */
static void forget_pilot(ec_render_state *r)
{
    r->rays_before -= r->source->rays;
    for (int i = 0; i < EC_STAGE_COUNT; i++) r->invalid_before[i] -= r->source->invalid[i];
}

static ec_result take_pilot(ec_render_state *r, uint32_t samples, uint64_t room, double *mean, ec_error *err)
{
    double sums[GROUPS] = {0};
    uint32_t *list = malloc(room * EC_LIST_WORDS * sizeof *list);
    ec_result result = list ? EC_OK : ec_fail(err, "out of memory for a pilot");
    for (uint32_t first = 0; result == EC_OK && first < samples; first += (uint32_t)room)
        result = take(r, samples, first, (uint32_t)(samples - first < room ? samples - first : room), list, sums, err);
    free(list);
    *mean = middle(sums, samples);
    return result;
}

ec_result ec_render_pilot_mean(ec_render_state *r, uint32_t samples, uint32_t rows, double *mean, ec_error *err)
{
    const uint64_t positions = ec_order_positions((uint64_t)r->options->width * rows, r->replicates);
    EC_TRY(take_pilot(r, samples, positions < samples ? positions : samples, mean, err));
    forget_pilot(r);
    return EC_OK;
}

ec_result ec_render_find_limit(ec_render_state *r, uint32_t rows, const ec_log *log, ec_error *err)
{
    const ec_render_options *o = r->options;
    double mean;
    if (o->clamp > 0 && o->clamp_luminance > 0) r->limit = (float)o->clamp_luminance;
    if (o->clamp > 0 && !(r->limit > 0)) {
        EC_TRY(ec_render_pilot_mean(r, PILOT, rows, &mean, err));
        if (mean > 0) r->limit = (float)(o->clamp * rounded(mean));
        else ec_note(log, "--clamp: the picture's pilot is black and has no mean luminance, so nothing is limited");
    }
    r->stats->clamp_luminance = (double)r->limit;
    return EC_OK;
}
