/* Takes batches until a limit is met. */
#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "device/adaptive.h"
#include "render/render_state.h"
#include "render/team.h"

/* Returns how long a block of batches may take, since one that is given up is lost, and nothing of it is kept before it is whole: seconds, or a share
 * of the time so far, and not longer than between two checkpoints. */
static double patience(const ec_render_state *r)
{
    const double seconds = fmax(EC_TEAM_PATIENCE_SECONDS, EC_TEAM_PATIENCE_SHARE * (ec_now() - r->render_start));
    return r->course->keep ? fmin(r->course->every, seconds) : seconds;
}

ec_mark ec_render_mark(const ec_render_state *r) { return (ec_mark){ec_render_samples_done(r), ec_now() - r->render_start}; }

/* Seconds a pixel: for adding it to the film as the first batch is given up; for looking at its error, until that time is known. */
#define BEGUN_SECONDS 30e-9
#define LOOK_SECONDS 30e-9

/* Returns the seconds from a stop to the end of the render: a first batch is added to the film as far as it is there, others are given up; then the
 * film's error is looked at, if it has changed since. */
static double closing_seconds(const ec_render_state *r, uint32_t done)
{
    if (r->past.next == 0) return BEGUN_SECONDS * done;
    if (r->is_looked_at) return 0.0;
    return r->look_seconds > 0 ? r->look_seconds : LOOK_SECONDS * ec_render_film_pixels(r);
}

/* Predicts rare light, once, before anybody looks at the film's error. */
static ec_result predict(ec_render_state *r, ec_error *err)
{
    if (r->is_predicted) return EC_OK;
    EC_TRY(ec_render_predict(r, err));
    return ec_film_set_rare(r->film, &r->rare, err);
}

/* Makes room in the film while the first batch of a large picture is rendered, in large steps, since the threads that do it spin for a while after each. */
static void make_room(ec_render_state *r, uint32_t done)
{
    enum { STEP = 1 << 20 };
    const uint32_t from = r->room_made;
    if (r->past.next > 0 || r->source->batches != 1 || done < from + STEP) return;
    r->room_made = done;
    ec_film_make_room(r->film, from, done);
}

/* Between waves: goes on unless a limit or the caller ends the batch early. */
static bool goes_on(void *user, uint32_t done)
{
    ec_render_state *r = user;
    r->under_way = done * ec_render_order_samples(r);
    if (done > r->order.done && r->stats->first_pixel_seconds == 0.0) r->stats->first_pixel_seconds = ec_now() - r->start;
    r->look_failed = predict(r, &r->look_error) != EC_OK;
    if (r->look_failed) return false;
    make_room(r, done);
    if (done >= r->order.count) return true;
    bool is_due = r->course->keep && r->source->batches == 1 && ec_now() - r->kept_at >= r->course->every;
    r->look_failed = is_due && r->source->look(r->source, &r->order, &r->look_error) != EC_OK;
    if (r->look_failed) return false;
    if (is_due) ec_render_keep(r, done);
    double now = ec_now(), share = (double)r->under_way / ec_render_film_pixels(r);
    bool out_of_time = r->options->time_limit > 0.0 && now - r->render_start + closing_seconds(r, done) > r->options->time_limit;
    bool go_on = now - r->last_report < 0.1 || ec_render_tell(r, r->samples_before_it + share);
    if ((!out_of_time && go_on) || (r->order.light == EC_LIGHT_ALONE && r->order.index < r->replicates)) return true; /* without these no replicate is
                                                                                                                       * whole */
    r->stopped_by = go_on ? "time" : "user";
    return false;
}

/* Returns up to which batch a source may look ahead: what comes after the pilot of an adaptive render, and then each pass, depends on the film. */
static uint32_t known_end(const ec_render_state *r)
{
    const uint32_t next = r->past.next;
    uint32_t end = next < r->end ? r->end : next + 1;
    if (r->film->light || r->past.allotment.weight || r->film->layers.count || r->film->layers.mattes) return next + 1;
    if (ec_render_wants_sets(r) && end > r->film->feature_end) end = r->film->feature_end; /* batches after it bring no features */
    while (r->options->adaptive && !r->past.allotted && end > next + 1 && ec_schedule_has_pilot(r->replicates, end - 1)) {
        const uint32_t pilot = (uint32_t)ec_schedule_round(r->replicates, next);
        if (ec_schedule_has_pilot(r->replicates, pilot) || pilot >= end) return pilot < end ? pilot : end;
        end = pilot;
    }
    return end;
}

static ec_result make_room_for_layers(ec_render_state *r, ec_error *err)
{
    const uint64_t positions = ec_order_positions(ec_render_film_pixels(r), r->replicates);
    if (!r->film->layers.count || r->layers) return EC_OK;
    r->layers = calloc(positions, EC_LAYER_BYTES * r->film->layers.count);
    r->layer = malloc(positions * EC_BATCH_FIELDS * sizeof *r->layer);
    return r->layers && r->layer ? EC_OK : ec_fail(err, "out of memory for %u layers; ask for fewer, or for a smaller --size", r->film->layers.count);
}

/* Returns how many pixels of a batch under way are taken over: whole rows of tiles (batch_source.h), since a wave may have ended within one. */
static uint32_t gone_on_from(const ec_render_state *r)
{
    const uint32_t row = EC_TILE_ROWS * r->film->width, done = r->past.under_way < r->order.count ? r->past.under_way : 0;
    return r->order.list ? done : done - done % row;
}

/* Returns how many batches from `index` on are wanted without a look at the error in between. Limits of time are part of the order. */
static uint32_t whole_from(const void *user, uint32_t index)
{
    const ec_render_state *r = user;
    return r->options->error_target > 0.0 ? (uint32_t)(ec_schedule_round(r->replicates, index) - index) : UINT32_MAX;
}

/* Returns the samples left in all where their number is limited. */
static double samples_left(const ec_render_state *r)
{
    return r->goal.samples > 0 ? r->goal.samples * ec_render_film_pixels(r) - (double)r->past.samples : INFINITY;
}

/* Orders the next batch, for all pixels or those of the allotment, and runs waves until they are done or *complete is false. */
static ec_result run_batch(ec_render_state *r, bool *complete, ec_error *err)
{
    ec_allotment *a = &r->past.allotment;
    EC_TRY(make_room_for_layers(r, err));
    r->order = (ec_batch_order){.index = r->past.next, .end = known_end(r), .count = (uint32_t)ec_render_film_pixels(r),
                                .light = r->film->light ? EC_LIGHT_APART : EC_LIGHT_ADDED, .feature_sets = ec_render_wants_sets(r), .layers = r->layers,
                                .matte = r->film->layers.mattes ? &r->matte : NULL,
                                .cut = r->past.next == r->end ? r->cut : 0, .limit = r->limit, .whole = whole_from, .patience = patience(r),
                                .until = r->options->time_limit > 0.0 ? r->render_start + r->options->time_limit : INFINITY, .left = samples_left(r),
                                .go_on = goes_on, .user = r};
    if (a->weight) {
        const ec_pass pass = ec_allotment_pass(a, r->film, samples_left(r));
        r->order.count = pass.count, r->order.samples = pass.samples, r->order.list = a->list, r->order.cut = 0;
    }
    r->matte.count = 0;
    r->order.done = gone_on_from(r);
    if (r->order.done) r->order.before = r->past.batch, r->order.features_before = r->past.features;
    r->past.under_way = 0;
    r->past.batch = r->past.features = NULL;
    r->samples_before_it = ec_render_samples_done(r);
    r->under_way = 0;
    ec_result result = r->source->take(r->source, &r->order, complete, err);
    if (!r->look_failed) return result;
    if (err) *err = r->look_error; /* a device reports a failure once */
    return EC_FAILED;
}

/* Returns whether light paths are due. They fall on any pixel: they keep up with the batches, or with what a pixel of mean weight is due. */
static bool is_light_due(const ec_render_state *r)
{
    const ec_film *light = r->film->light;
    if (!light || r->past.next == 0) return false;
    return r->past.allotment.weight ? light->samples[r->replicates - 1] < r->past.allotment.level : ec_film_end(light) < r->past.next;
}

static ec_result take_light(ec_render_state *r, ec_error *err)
{
    bool complete = true;
    while (complete && is_light_due(r)) {
        const uint32_t index = ec_film_end(r->film->light);
        r->order = (ec_batch_order){.light = EC_LIGHT_ALONE, .index = index, .end = index + 1, .count = (uint32_t)ec_render_film_pixels(r), .patience = patience(r),
                                    .until = INFINITY, .left = samples_left(r), .go_on = goes_on, .user = r};
        r->samples_before_it = ec_render_samples_done(r);
        r->under_way = 0;
        ec_result result = r->source->take(r->source, &r->order, &complete, err);
        if (r->look_failed && err) *err = r->look_error;
        if (r->look_failed || result != EC_OK) return EC_FAILED;
        if (complete) EC_TRY(ec_render_add_light(r, err));
    }
    return EC_OK;
}

/* Computes the film's error, once for each state of the film. */
static void look_at_error(ec_render_state *r)
{
    const double start = ec_now();
    if (r->is_looked_at) return;
    r->error = ec_film_look_at_error(r->film, &r->sums);
    r->look_seconds = ec_now() - start;
    r->is_looked_at = true;
}

/* Returns whether all pixels have what they are due, by the schedule or by the allotment's level; limits of error are looked at then. */
static bool is_round(const ec_render_state *r)
{
    if (r->past.allotment.weight && r->film->counts) return ec_allotment_is_even(&r->past.allotment, r->film); /* there are weights from the end of
                                                                                                                * the pilot on, when all pixels have
                                                                                                                * as many samples */
    return ec_schedule_is_round(r->replicates, r->past.next);
}

static bool has_pilot(const ec_render_state *r) { return r->film->counts || ec_schedule_has_pilot(r->replicates, r->film->batch_count); }

/* Returns the samples a pixel of the next batch, for a limit of time. */
static double next_samples(const ec_render_state *r)
{
    if (r->past.allotment.weight) return 0.0;
    return (double)ec_schedule_batch(r->replicates, r->past.next).samples;
}

/* Makes the allotment, once, when the pilot is over; where there is nothing to gain, sampling stays uniform. */
static ec_result allot(ec_render_state *r, ec_error *err)
{
    const bool is_pilot = ec_schedule_is_round(r->replicates, r->past.next) && has_pilot(r);
    if (!r->options->adaptive || r->past.allotted || !is_pilot || r->past.next >= r->end) return EC_OK;
    r->past.allotted = true;
    EC_TRY(ec_allot(r->film, &r->params, &r->past.allotment, err));
    if (r->past.allotment.weight) ec_slope_restart(&r->goal.slope);
    return EC_OK;
}

/* Notes, once, why the render goes on though its samples would do. */
static void note_withheld(ec_render_state *r, const ec_log *log)
{
    char way[EC_RARE_WAY];
    if (!r->goal.is_withheld || r->is_withheld_noted) return;
    r->is_withheld_noted = true;
    ec_rare_way(r->error.through, r->error.light, way, sizeof way);
    ec_note(log, "the samples so far would be enough for --error %g, but there is no bound: rare bright paths (%s) are hardly met yet; the render goes on to its other limits",
            r->goal.error, way);
}

/* Looks at the clean picture's error, if the render goes by that and a look is due. */
static ec_result look_at_clean(ec_render_state *r, double samples, ec_error *err)
{
    ec_clean_look look;
    if (!r->options->denoise || !(r->goal.error > 0) || !r->course->clean) return EC_OK;
    if (!ec_clean_goal_is_due(&r->goal.clean, samples, r->goal.error)) return EC_OK;
    EC_TRY(r->course->clean(r->course->user, r->film, &look, err));
    ec_clean_goal_take(&r->goal.clean, samples, &look);
    r->cleaned_samples = r->past.samples;
    return EC_OK;
}

/* Judges after a batch whether the render has reached its end. */
static ec_result judge(ec_render_state *r, const ec_log *log, ec_error *err)
{
    const bool at_round = is_round(r);
    const ec_mark at = ec_render_mark(r);
    const ec_pipeline *alone = ec_sources_alone(&r->sources);
    const bool is_narrow = alone && alone->is_narrow;
    ec_goal_batch(&r->goal, at.samples, at.seconds, at.seconds - r->batch_end);
    if (is_narrow || r->was_narrow) ec_goal_restart_pace(&r->goal);
    r->was_narrow = is_narrow;
    if (at_round) {
        look_at_error(r);
        ec_goal_round(&r->goal, &r->error, at);
        if (has_pilot(r)) note_withheld(r, log);
        EC_TRY(allot(r, err));
        if (has_pilot(r) && !(r->error.error_bound <= r->goal.error)) EC_TRY(look_at_clean(r, at.samples, err));
        const bool is_new = r->past.allotment.weight && !r->film->counts;
        if (has_pilot(r)) ec_goal_predict(&r->goal, at, is_new ? r->past.allotment.gain : 1.0);
    }
    r->stopped_by = ec_goal_met(&r->goal, at, at_round && has_pilot(r), next_samples(r));
    if (!r->stopped_by && !ec_render_tell(r, at.samples)) r->stopped_by = "user";
    r->batch_end = ec_render_mark(r).seconds;
    return EC_OK;
}

/* Takes one more batch for the film, or none; the batches before it stay, whatever happens. */
static ec_result take_batch(ec_render_state *r, const ec_log *log, ec_error *err)
{
    bool complete;
    const double start = ec_now();
    EC_TRY(run_batch(r, &complete, err));
    if (!complete) ec_render_keep(r, r->source->batches == 1 ? (uint32_t)(r->under_way / ec_render_order_samples(r)) : 0);
    if (!complete && (r->past.next > 0 || r->course->end || r->strip_rows)) return EC_OK; /* part of a batch is of no use to a picture */
    if (!complete) ec_warn(log, "stopped within the first batch: parts of the picture have no samples (0 in the samples channel) and are black");
    EC_TRY(ec_render_add_batch(r, complete, err));
    if (complete) EC_TRY(take_light(r, err));
    if (!complete || r->stopped_by) return EC_OK;
    EC_TRY(judge(r, log, err));
    if (r->stopped_by) return EC_OK;
    const double now = ec_now(), not_asked = r->source->batches > 1 ? now - start : 0.0; /* the next block may take as long, and keeps nothing */
    if (now + not_asked - r->kept_at >= r->course->every) ec_render_keep(r, 0);
    return EC_OK;
}

/* Takes up what was done before; perhaps that is all. */
static ec_result take_up_goal(ec_render_state *r, ec_error *err)
{
    const ec_mark at = ec_render_mark(r);
    EC_TRY(predict(r, err));
    look_at_error(r);
    r->goal.slope = r->past.slope;
    r->goal.now = r->error;
    ec_goal_batch(&r->goal, at.samples, at.seconds, 0);
    EC_TRY(allot(r, err)); /* if the pilot was the end */
    r->stopped_by = ec_goal_met(&r->goal, at, is_round(r) && has_pilot(r), next_samples(r));
    return EC_OK;
}

ec_result ec_render_film(ec_render_state *r, const ec_log *log, ec_error *err)
{
    ec_result result = EC_OK;
    r->film->limit = r->limit;
    r->room_made = 0;
    r->is_looked_at = false;
    r->last_report = r->kept_at = ec_now();
    r->render_start = ec_now() - r->past.seconds;
    r->batch_end = r->past.seconds;
    if (r->past.samples) result = take_up_goal(r, err);
    while (result == EC_OK && !r->stopped_by) result = take_batch(r, log, err);
    if (r->film->batch_count) look_at_error(r);
    ec_render_keep(r, 0);
    return result;
}
