/* Batches until a limit is met. */
#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "pipeline/adaptive.h"
#include "pipeline/looks.h"
#include "pipeline/render_state.h"
#include "pipeline/team.h"

/* With blocks of batches, since one that is given up is lost, and nothing of it is kept before it is whole: seconds, or a share of the time so far;
 * and not longer than between two checkpoints. */
static double patience(const ec_render_state *r)
{
    const double seconds = fmax(EC_TEAM_PATIENCE_SECONDS, EC_TEAM_PATIENCE_SHARE * (ec_now() - r->render_start));
    return r->course->keep ? fmin(r->course->every, seconds) : seconds;
}

/* Hands over what there is. A batch that is under way goes with it, the first one too: on large pictures one takes minutes. */
static void keep(ec_render_state *r, uint32_t under_way)
{
    const bool is_new = r->past.next != r->kept_next || under_way > r->kept_under_way,
               is_empty = !r->film->batch_count && !under_way;
    if (!r->course->keep || !is_new || is_empty || r->film->unsampled) return;
    ec_past now = r->past;
    now.seconds = ec_now() - r->render_start;
    if (under_way) {
        now.under_way = under_way;
        now.batch = r->source->mean;
        now.rays = r->rays_before + r->source->rays;
        for (int i = 0; i < EC_STAGE_COUNT; i++) now.invalid[i] = r->invalid_before[i] + r->source->invalid[i];
    }
    ec_film_show(r->film);
    if (r->aov) r->film->aov = r->aov; /* as far as they have come: not the film's yet */
    if (r->course->keep(r->course->user, r->film, &now)) r->kept_next = now.next, r->kept_under_way = under_way;
    if (r->aov) r->film->aov = NULL;
    r->kept_at = ec_now();
}

/* Between waves: goes on unless a limit or the caller ends the batch early. */
static bool goes_on(void *user, uint32_t done)
{
    ec_render_state *r = user;
    const uint32_t batches = r->source->batches;
    r->under_way = (uint64_t)done * r->params.batch * batches;
    if (done > r->order.done && r->stats->first_pixel_seconds == 0.0) r->stats->first_pixel_seconds = ec_now() - r->start;
    if (done >= r->order.count) return true;
    bool is_due = r->course->keep && batches == 1 && ec_now() - r->kept_at >= r->course->every;
    r->look_failed = is_due && r->source->look(r->source, &r->order, &r->look_error) != EC_OK;
    if (r->look_failed) return false;
    if (is_due) keep(r, done);
    double now = ec_now(), share = batches * (done / ec_render_film_pixels(r));
    bool out_of_time = r->options->time_limit > 0.0 && now - r->render_start > r->options->time_limit;
    bool go_on = now - r->last_report < 0.1 || ec_render_tell(r, r->batches_before_it + share);
    if (!out_of_time && go_on) return true;
    r->stopped_by = go_on ? "time" : "user";
    return false;
}

/* Up to which batch a source may look ahead: what comes after the pilot of an adaptive render, and each pass then, depends on the film. */
static uint32_t known_end(const ec_render_state *r)
{
    uint32_t left = UINT32_MAX - r->past.next, pilot = 1;
    if (r->batches_wanted) left = r->batches_wanted - (uint32_t)fmin(ec_render_batches_done(r), r->batches_wanted - 1.0);
    while (!ec_pilot_is_over(r->film->batch_count + pilot)) pilot++;
    if (r->options->adaptive && !r->past.allotted && pilot < left) left = pilot;
    return r->past.next + (r->past.allotment.weight ? 1 : left);
}

/* First-hit features come with the first batch; what a checkpoint has of them is gone on with. */
static ec_result take_features(ec_render_state *r, ec_error *err)
{
    if (r->past.next > 0 || r->aov) return EC_OK;
    r->aov = r->film->aov ? r->film->aov : calloc((uint64_t)r->film->width * r->film->height * EC_AOV_FIELDS, sizeof *r->aov);
    r->film->aov = NULL;
    return r->aov ? EC_OK : ec_fail(err, "out of memory for the first-hit features");
}

/* Of a batch that was under way: whole rows of tiles (batch_source.h), a wave may have ended within one. */
static uint32_t gone_on_from(const ec_render_state *r)
{
    const uint32_t row = EC_TILE_ROWS * r->film->width, done = r->past.under_way < r->order.count ? r->past.under_way : 0;
    return r->order.list ? done : done - done % row;
}

/* No look at the error falls in between. Limits of time are the order's. */
static uint32_t whole_from(const void *user, uint32_t index)
{
    const ec_render_state *r = user;
    const uint32_t before = index - r->course->first;
    return r->options->error_target > 0.0 ? (uint32_t)(ec_look_after(before) - before) : UINT32_MAX;
}

/* The pixels that the next batch is for: all, or the allotment's; and waves until they are done or *complete is false. */
static ec_result run_batch(ec_render_state *r, bool *complete, ec_error *err)
{
    const uint64_t pixels = (uint64_t)r->film->width * r->film->height;
    ec_allotment *a = &r->past.allotment;
    EC_TRY(take_features(r, err));
    r->order = (ec_batch_order){.index = r->past.next, .end = known_end(r), .count = (uint32_t)pixels, .aov = r->aov, .whole = whole_from,
                                .patience = patience(r),
                                .until = r->options->time_limit > 0.0 ? r->render_start + r->options->time_limit : INFINITY,
                                .go_on = goes_on, .user = r};
    if (a->weight) r->order.count = ec_allotment_pass(a, r->film), r->order.list = a->list;
    r->order.done = gone_on_from(r);
    if (r->order.done) r->order.before = r->past.batch;
    r->past.under_way = 0;
    r->past.batch = NULL;
    r->batches_before_it = ec_render_batches_done(r);
    r->under_way = 0;
    ec_result result = r->source->take(r->source, &r->order, complete, err);
    if (!r->look_failed) return result;
    if (err) *err = r->look_error; /* a device tells of a failure once */
    return EC_FAILED;
}

static ec_result mark_unsampled(ec_render_state *r, ec_error *err)
{
    uint64_t pixels = (uint64_t)r->film->width * r->film->height;
    float *mean = r->source->mean;
    r->film->unsampled = calloc(pixels, 1);
    if (!r->film->unsampled) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)pixels);
    r->under_way = pixels * r->params.batch;
    for (uint64_t i = 0; i < pixels; i++) {
        if (mean[3 * i] != EC_NOT_REACHED) continue;
        r->film->unsampled[i] = 1;
        r->under_way -= r->params.batch;
        mean[3 * i] = mean[3 * i + 1] = mean[3 * i + 2] = 0.0f;
    }
    return EC_OK;
}

static ec_result add_block(ec_render_state *r, ec_error *err)
{
    ec_film_part part = {.first = r->past.next, .count = r->source->batches, .sums = r->source->sums};
    EC_TRY(ec_film_insert(r->film, &part, err));
    r->source->sums = (ec_moments){0};
    return EC_OK;
}

/* Or the block. */
static ec_result add_batch(ec_render_state *r, bool complete, ec_error *err)
{
    for (int i = 0; i < EC_STAGE_COUNT; i++) r->past.invalid[i] = r->invalid_before[i] + r->source->invalid[i];
    if (!complete) EC_TRY(mark_unsampled(r, err));
    ec_allotment *a = &r->past.allotment;
    if (a->weight) EC_TRY(ec_film_add_some(r->film, r->source->mean, a->places, r->order.count, err));
    else if (r->source->batches > 1) EC_TRY(add_block(r, err));
    else EC_TRY(ec_film_add_at(r->film, r->past.next, r->source->mean, err));
    if (r->aov) r->film->aov = r->aov;
    r->aov = NULL;
    r->past.samples += r->under_way;
    r->past.rays = r->rays_before + r->source->rays;
    r->past.next += r->source->batches;
    r->error = ec_film_estimate_error(r->film);
    return EC_OK;
}

static bool is_done(ec_render_state *r, bool at_pilot)
{
    const ec_render_options *o = r->options;
    const bool looks = r->past.allotment.weight || ec_look_is_due(r->film->batch_count); /* after each pass */
    double done = ec_render_batches_done(r), seconds = ec_now() - r->render_start;
    ec_render_look_ahead(r, at_pilot);
    if (r->batches_wanted && done >= r->batches_wanted)
        r->stopped_by = "spp";
    else if (o->error_target > 0.0 && looks && done >= 4 && r->error.error_bound <= o->error_target)
        r->stopped_by = "error";
    else if (o->time_limit > 0.0 && seconds + 0.5 * seconds / done > o->time_limit)
        r->stopped_by = "time";
    else if (!ec_render_tell(r, done))
        r->stopped_by = "user";
    return r->stopped_by != NULL;
}

/* One more for the film, or none; the batches before it stand, whatever happens. */
static ec_result take_batch(ec_render_state *r, const ec_log *log, ec_error *err)
{
    bool complete;
    const double start = ec_now();
    EC_TRY(run_batch(r, &complete, err));
    if (!complete) keep(r, r->source->batches == 1 ? (uint32_t)(r->under_way / r->params.batch) : 0);
    if (!complete && (r->past.next > 0 || r->course->end || r->strip_rows)) return EC_OK; /* part of a batch is of no use to a picture */
    if (!complete) ec_warn(log, "stopped within the first batch: parts of the picture have no samples (0 in the samples channel) and are black");
    EC_TRY(add_batch(r, complete, err));
    /* Once, when the pilot is over; where there is nothing to gain, sampling stays uniform. */
    bool at_pilot = r->options->adaptive && !r->past.allotted && ec_pilot_is_over(r->film->batch_count);
    if (at_pilot) EC_TRY(ec_allot(r->film, &r->params, &r->past.allotment, err));
    r->past.allotted |= at_pilot;
    if (!complete || is_done(r, at_pilot)) return EC_OK;
    const double now = ec_now(), not_asked = r->source->batches > 1 ? now - start : 0.0; /* the next one may take as long, and keeps nothing */
    if (now + not_asked - r->kept_at >= r->course->every) keep(r, 0);
    return EC_OK;
}

ec_result ec_render_film(ec_render_state *r, const ec_log *log, ec_error *err)
{
    ec_result result = EC_OK;
    r->last_report = r->batch_end = r->kept_at = ec_now();
    r->render_start = ec_now() - r->past.seconds;
    if (r->past.samples) {
        r->error = ec_film_estimate_error(r->film);
        r->first_seconds = r->past.seconds / ec_render_batches_done(r);
        (void)is_done(r, false); /* perhaps all was done before */
    }
    while (result == EC_OK && !r->stopped_by) result = take_batch(r, log, err);
    keep(r, 0);
    return result;
}
