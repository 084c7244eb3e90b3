/* Divides the budget: what is done when, and for how long. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "cost/cost_internal.h"

/* The reference's share. Its noise is removed from every figure, but not the uncertainty that it adds; with a third of the time it has some ten times
 * the samples of a rung, and adds little. */
static const double reference_share = 0.3;

typedef struct study_state {
    ec_cost_study *study;
    ec_cost_base base;
    double deadline;      /* for all rungs */
    uint32_t planned;     /* rows from here on are given up */
    double setup, slowest; /* set-up of the last rungs, smoothed; the longest one */
} study_state;

/* Weights a rung's share: all comparisons depend on the base; times need fewer samples than errors. */
static double weight(const ec_cost_rung *rung)
{
    return rung->is_base ? 1.5 : rung->speed_only ? 0.35 : rung->is_effect ? 0.7 : 1;
}

static double share_of(const study_state *s, uint32_t row)
{
    double all = 0;
    for (uint32_t i = row; i < s->planned; i++) all += weight(&s->study->rows[i].rung);
    return (s->deadline - ec_now()) * weight(&s->study->rows[row].rung) / all;
}

enum { ENOUGH = 64 }; /* samples per pixel for a rung: two pictures of EC_COST_UNIT, and the smaller ones before them */

/* Gives up rungs from the end of the list until those before them have time for set-up and enough samples for figures. For the first one this is
 * estimated from the reference: a budget spent on few rungs tells something of these. */
static void give_up_some(study_state *s, uint32_t row)
{
    double picture = s->base.seconds_per_sample * (double)s->study->options.width * s->study->options.height;
    double needed = 1.2 * s->setup + ENOUGH * picture;
    while (s->planned > (row ? row : 1) && share_of(s, row) < needed * weight(&s->study->rows[row].rung)) s->planned--;
    /* Kernels may have to be compiled, which cannot be interrupted. */
    if (row && ec_now() + s->slowest + 0.05 * s->study->budget > s->deadline) s->planned = row;
}

static void explain_the_rest(study_state *s, const char *by)
{
    double done = 0, all = 0;
    ec_cost_study *study = s->study;
    for (uint32_t i = 0; i < study->row_count; i++) {
        all += weight(&study->rows[i].rung);
        if (study->rows[i].state == EC_COST_MEASURED) done += weight(&study->rows[i].rung);
    }
    double enough = study->budget * all / fmax(done, 0.5); /* the budget with which all would get shares as long as those */
    for (uint32_t i = 0; i < study->row_count; i++) {
        ec_cost_row *row = &study->rows[i];
        if (row->state != EC_COST_PENDING) continue;
        if (study->interrupted) {
            snprintf(row->note, sizeof row->note, "%s before", by);
        } else {
            row->state = EC_COST_TOO_SMALL;
            snprintf(row->note, sizeof row->note, "budget too small; --budget %dm would be enough", (int)ceil(enough / 60));
        }
    }
}

/* Sets the size of a picture for timing: a few per cent of a rung's share. */
static void settle_base(study_state *s)
{
    double picture = s->study->rows[0].seconds_per_sample * (double)s->study->options.width * s->study->options.height;
    double share = share_of(s, 1) / weight(&s->study->rows[1].rung);
    s->base.seconds_per_sample = s->study->rows[0].seconds_per_sample;
    s->base.pair_samples = 1;
    while (s->base.pair_samples < 16 && 4 * s->base.pair_samples * picture < 0.04 * share) s->base.pair_samples *= 2;
}

static ec_result measure_rows(study_state *s, ec_error *err)
{
    ec_cost_study *study = s->study;
    const ec_cost_reference *r = &study->reference;
    s->setup = r->setup_seconds;
    if (!r->source && r->samples_per_pixel)
        s->base.seconds_per_sample = r->seconds / ((double)r->samples_per_pixel * study->options.width * study->options.height);
    for (uint32_t i = 0; i < study->row_count && ec_cost_go_on(study); i++) {
        ec_cost_row *row = &study->rows[i];
        give_up_some(s, i);
        if (i >= s->planned) break;
        study->doing = row->rung.name;
        EC_TRY(ec_cost_measure(study, &s->base, row, share_of(s, i), s->deadline, err));
        s->setup = i ? 0.5 * (s->setup + row->setup_seconds) : row->setup_seconds;
        s->slowest = fmax(s->slowest, row->setup_seconds);
        if (i == 0 && row->state != EC_COST_MEASURED) break; /* there is nothing to compare with */
        if (i == 0) settle_base(s);
    }
    return EC_OK;
}

/* Halves the size until all rungs get their samples in half of the time. Errors are per pixel, so fewer pixels tell as much, if less precisely. */
static ec_result fit_size(study_state *s, ec_error *err)
{
    enum { LEAST = 64 }; /* pixels high */
    ec_cost_study *study = s->study;
    ec_render_options *o = &study->options;
    const uint32_t width = o->width, height = o->height;
    ec_cost_rung rung = {.options = *o};
    ec_cost_runner runner = {0};
    ec_render_stats stats;
    double setup, all = 0;
    if (!study->may_shrink) return EC_OK;
    ec_result result = ec_cost_runner_open(study, &rung, &runner, &stats, &setup, err);
    const double rate = runner.seconds_per_sample;
    ec_cost_runner_close(&runner);
    EC_TRY(result);
    for (uint32_t i = 0; i < study->row_count; i++) all += weight(&study->rows[i].rung);
    while (o->height >= 2 * LEAST && o->width >= 2 && all * ENOUGH * rate * o->width * o->height > 0.5 * (s->deadline - ec_now())) o->width /= 2, o->height /= 2;
    for (uint32_t i = 0; i < study->row_count; i++) study->rows[i].rung.options.width = o->width, study->rows[i].rung.options.height = o->height;
    if (o->height < height)
        ec_note(study->log, "pictures of %ux%u pixels instead of %ux%u, so that the budget covers more rungs; --size sets another size", o->width, o->height, width, height);
    return EC_OK;
}

ec_result ec_cost_run(ec_cost_study *study, ec_error *err)
{
    study_state s = {.study = study};
    EC_TRY(ec_cost_list(study->scene, &study->options, &study->rows, &study->row_count, err));
    s.planned = study->row_count;
    s.deadline = study->start + study->budget - (0.2 + 0.01 * study->budget); /* leaves time for writing */
    study->doing = "reference";
    EC_TRY(fit_size(&s, err));
    if (study->reference_file)
        EC_TRY(ec_cost_reference_read(study, err));
    else
        EC_TRY(ec_cost_reference_render(study, ec_now() + reference_share * (s.deadline - ec_now()), err));
    ec_result result = study->interrupted ? EC_OK : measure_rows(&s, err);
    study->interrupted |= result != EC_OK;
    explain_the_rest(&s, result == EC_OK ? "interrupted" : "the device failed");
    ec_cost_runner_close(&s.base.runner);
    study->seconds = ec_now() - study->start;
    return result;
}

void ec_cost_free(ec_cost_study *study)
{
    for (uint32_t i = 0; i < study->row_count; i++) {
        free(study->rows[i].picture);
        for (uint32_t k = 0; k < EC_COST_LEVELS_MOST; k++) free(study->rows[i].stages[k]);
    }
    free(study->rows);
    ec_cost_reference_free(&study->reference);
    study->rows = NULL;
    study->row_count = 0;
}
