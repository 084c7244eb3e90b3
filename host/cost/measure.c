/* Measures one rung, as precisely as its share of the budget allows: pictures of 1, 2, 4, … samples against the reference, then time in turns with
 * the base, so that other programs that slow the machine down affect both. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "cost/cost_internal.h"
#include "report/format.h"

enum { PAIRS = 9, PAIRS_MOST = 31, PICTURES = 2, PICTURES_MOST = 16 };

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/* Returns the standard error of a median, 1.2533 sigma / sqrt(n) for normal values. sigma comes from the median absolute deviation, since one of a
 * few turns may be an outlier. */
static double median_se(const double *values, uint32_t count, double middle)
{
    double deviation[PAIRS_MOST];
    for (uint32_t i = 0; i < count; i++) deviation[i] = fabs(values[i] - middle);
    return count < 3 ? NAN : 1.2533 * 1.4826 * median(deviation, count) / sqrt(count);
}

typedef struct measurement {
    ec_cost_study *study;
    ec_cost_base *base;  /* NULL: this is the base */
    ec_cost_row *row;
    ec_cost_runner *runner;
    ec_cost_tally tally;
    double rates[PAIRS_MOST]; /* seconds per sample of the larger pictures */
    uint32_t rate_count, index;
} measurement;

static ec_result take_picture(measurement *m, uint32_t samples, ec_error *err)
{
    double seconds;
    uint32_t seed = ec_session_seed(m->study->options.seed, EC_COST_STREAM_RUNGS, m->index++);
    EC_TRY(ec_cost_runner_take(m->runner, seed, samples, &seconds, err));
    if (m->runner->stopped) return EC_OK;
    ec_cost_tally_add(&m->tally, m->runner->mean);
    m->row->samples_per_pixel += samples;
    if (m->tally.level_batches > 1 || samples == 1) m->rates[m->rate_count++ % PAIRS_MOST] = m->runner->seconds_per_sample;
    return EC_OK;
}

/* Returns how many pictures to take: if few pixels hold most of the error, two say little. This is judged by the level before, as stopping when a
 * figure looks good would bias it. */
static uint32_t choose_pictures(const ec_cost_row *row, uint32_t samples)
{
    const ec_cost_point *before = row->point_count ? &row->points[row->point_count - 1] : NULL;
    if (before && before->mse_se * sqrt(before->batches) < 0.15 * before->mse) return PICTURES;
    return samples <= 4 ? PICTURES_MOST : samples < 32 ? 64 / samples : PICTURES;
}

/* Takes at least two pictures of n samples; *go_up: go on with 2 n. */
static ec_result take_level(measurement *m, uint32_t samples, double end, bool *go_up, ec_error *err)
{
    const uint32_t largest = ec_session_largest(m->runner->session), wanted = choose_pictures(m->row, samples);
    m->rate_count = 0;
    *go_up = false;
    ec_cost_tally_begin(&m->tally, samples);
    while (ec_cost_go_on(m->study)) {
        double left = end - ec_now(), picture = m->runner->seconds_per_sample * (double)m->runner->pixels * samples + ec_cost_runner_beside(m->runner);
        bool higher = 2 * samples <= largest && m->row->point_count + 2 < EC_COST_LEVELS_MOST;
        *go_up = m->tally.level_batches >= wanted && higher && 2 * PICTURES * picture <= left;
        if (*go_up || (m->tally.level_batches >= PICTURES && picture > left)) break;
        EC_TRY(take_picture(m, samples, err));
    }
    ec_cost_tally_end(&m->tally, m->row);
    if (m->runner->stopped || !m->tally.level_batches) return EC_OK;
    uint8_t **stage = &m->row->stages[m->row->point_count - 1];
    *stage = ec_cost_stage(&m->study->options, m->runner->mean);
    return *stage ? EC_OK : ec_fail(err, "out of memory for a picture");
}

static ec_result take_levels(measurement *m, double end, ec_error *err)
{
    double picture = m->runner->seconds_per_sample * (double)m->runner->pixels;
    if (ec_now() + PICTURES * picture > end) {
        m->row->state = EC_COST_TOO_SMALL;
        snprintf(m->row->note, sizeof m->row->note, "budget too small: it takes about %s alone",
                 ec_seconds(m->row->setup_seconds + 4 * PICTURES * picture).text);
        return EC_OK;
    }
    EC_TRY(ec_cost_tally_create(&m->study->reference, m->runner->pixels, &m->tally, err));
    bool go_up = true;
    for (uint32_t samples = 1; go_up && !m->runner->stopped; samples *= 2) EC_TRY(take_level(m, samples, end, &go_up, err));
    if (m->row->point_count == 0 || m->tally.samples == 0) return EC_OK; /* interrupted */
    ec_cost_tally_bias(&m->tally, m->row);
    m->row->state = EC_COST_MEASURED;
    if (m->runner->stopped) return EC_OK;
    m->row->picture = ec_cost_shrink(&m->study->options, m->runner->mean);
    return m->row->picture ? EC_OK : ec_fail(err, "out of memory for a picture");
}

/* Times both by rendering one picture each, one after the other. */
static ec_result time_in_turns(measurement *m, double end, ec_error *err)
{
    double ratios[PAIRS_MOST], mine, bases;
    uint32_t count = 0, samples = m->base->pair_samples, most = PAIRS_MOST;
    while (count < most && ec_cost_go_on(m->study)) {
        if (count >= 1 && ec_now() + mine + bases > end) break;
        uint32_t seed = ec_session_seed(m->study->options.seed, EC_COST_STREAM_RUNGS, UINT32_MAX);
        EC_TRY(ec_cost_runner_take(m->runner, seed, samples, &mine, err));
        if (m->runner->stopped) break;
        EC_TRY(ec_cost_runner_take(&m->base->runner, seed, samples, &bases, err));
        if (m->base->runner.stopped) break;
        ratios[count++] = mine / bases;
        m->row->same_bits = !memcmp(m->runner->mean, m->base->runner.mean, m->runner->pixels * 12);
    }
    if (count == 0) return EC_OK;
    m->row->relative_time = median(ratios, count);
    m->row->relative_time_se = median_se(ratios, count, m->row->relative_time);
    if (m->row->rung.speed_only) {
        m->row->state = EC_COST_MEASURED;
        m->row->samples_per_pixel = (uint64_t)count * samples;
    }
    return EC_OK;
}

/* Sets the base's own time, that of its larger pictures, and the size of pictures that are timed in turns. */
static void become_base(measurement *m)
{
    uint32_t count = m->rate_count < PAIRS_MOST ? m->rate_count : PAIRS_MOST;
    m->row->relative_time = 1;
    if (count) m->row->seconds_per_sample = median(m->rates, count);
}

static void finish_times(measurement *m)
{
    ec_cost_row *row = m->row;
    if (row->state != EC_COST_MEASURED) return;
    if (m->base && !(row->relative_time > 0)) { /* interrupted before its turns: uses its own figure */
        row->relative_time = m->runner->seconds_per_sample / m->base->seconds_per_sample;
        row->relative_time_se = NAN;
    }
    if (m->base) row->seconds_per_sample = row->relative_time * m->base->seconds_per_sample;
    double picture = row->seconds_per_sample * (double)m->runner->pixels;
    row->picture_seconds = ec_cost_runner_beside(m->runner);
    for (uint32_t i = 0; i < row->point_count; i++) row->points[i].seconds = picture * row->points[i].samples + row->picture_seconds;
    if (!row->rung.speed_only) ec_cost_conclude(row);
}

static ec_result measure(measurement *m, double deadline, ec_error *err)
{
    ec_cost_row *row = m->row;
    double turns = m->base ? 2 * PAIRS * m->base->pair_samples * m->base->seconds_per_sample * (double)m->runner->pixels : 0;
    if (!row->rung.speed_only) EC_TRY(take_levels(m, deadline - fmin(turns, 0.3 * (deadline - ec_now())), err));
    if (m->base && (row->rung.speed_only || row->state == EC_COST_MEASURED)) EC_TRY(time_in_turns(m, deadline, err));
    if (!m->base) become_base(m);
    finish_times(m);
    uint64_t dropped = 0;
    EC_TRY(ec_session_invalid(m->runner->session, &dropped, err));
    row->invalid = m->runner->invalid + dropped;
    return EC_OK;
}

/* Returns the end of the rung's time. Set-up is part of its share, but slow compilation must not take all of it. */
static double rest_of(double share, double setup, double latest)
{
    return fmin(ec_now() + fmax(share - setup, 0.5 * share), latest);
}

ec_result ec_cost_measure(ec_cost_study *study, ec_cost_base *base, ec_cost_row *row, double share, double latest, ec_error *err)
{
    ec_cost_runner own = {0};
    bool is_base = row->rung.is_base;
    measurement m = {.study = study, .base = is_base ? NULL : base, .row = row, .runner = is_base ? &base->runner : &own};
    ec_render_stats stats = {0};
    ec_error why = {0};
    ec_result result = ec_cost_runner_open(study, &row->rung, m.runner, &stats, &row->setup_seconds, &why);
    row->device_bytes = stats.device_bytes;
    if (result != EC_OK) {
        row->state = EC_COST_REFUSED;
        snprintf(row->note, sizeof row->note, "%.255s", why.text);
        result = is_base ? ec_fail(err, "%s", why.text) : ec_cl_finish(study->cl, err); /* fails if the device is lost */
    } else if (!m.runner->stopped) {
        result = measure(&m, rest_of(share, row->setup_seconds, latest), err);
    }
    if (result != EC_OK) row->state = EC_COST_PENDING, row->point_count = 0; /* only half measured */
    ec_cost_tally_free(&m.tally);
    ec_cost_runner_close(&own);
    return result;
}
