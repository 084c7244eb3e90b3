/* Batches until a limit is met. */
#include "pipeline/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "pipeline/adaptive.h"
#include "pipeline/course.h"
#include "pipeline/forecast.h"
#include "pipeline/sources.h"
#include "pipeline/strips.h"

typedef struct render_state {
    ec_sources sources;
    ec_batch_source *source;
    ec_params params;          /* width, height and batch are the render's */
    const ec_render_options *options;
    const ec_course *course;
    ec_progress_fn progress;
    void *user;
    ec_film *film;
    ec_render_stats *stats;
    double start, render_start, last_report;
    double batch_end;          /* of the last one; and the sums of so many times, the first left out */
    double first_seconds, sum, squares, timed;
    ec_forecast forecast;      /* of now; the pilot's is in stats */
    uint32_t batches_wanted;   /* by --spp; 0 = no limit */
    ec_film_error error;
    ec_past past;              /* samples: in the film */
    uint64_t rays_before, invalid_before[EC_STAGE_COUNT]; /* the course's past */
    ec_batch_order order;      /* the batch under way */
    bool look_failed;          /* at what it has come to so far */
    ec_error look_error;
    double batches_before_it;
    uint64_t under_way;        /* samples of the batch that is not there yet */
    double kept_at;
    uint32_t kept_next, kept_under_way;
    float *aov;                /* of the first batch, until it is in the film */
    const char *stopped_by;
    uint32_t strip_rows;       /* of a strip; 0: the picture is rendered whole */
    uint64_t samples_before, invalid_in_films; /* of the strips that are complete */
} render_state;

/* Of the film: the picture, or the strip under way. */
static double film_pixels(const render_state *r) { return (double)r->film->width * r->film->height; }
static double picture_pixels(const render_state *r) { return (double)r->options->width * r->options->height; }

/* Largest divisor of the sample count that still leaves 16 batches: whole batches, and enough of them for an error. */
static uint32_t batch_of_spp(uint32_t spp)
{
    uint32_t most = spp / 16 < 1 ? 1 : (spp / 16 > 64 ? 64 : spp / 16);
    while (spp % most) most--;
    return most;
}

uint32_t ec_render_batch(const ec_render_options *o)
{
    if (o->batch) return o->batch;
    return o->spp ? batch_of_spp(o->spp) : 8;
}

static double fraction_done(const render_state *r, double batches, double seconds)
{
    const ec_render_options *o = r->options;
    if (r->strip_rows) /* spp alone ends them */
        return fmin(((double)r->samples_before / r->params.batch + batches * film_pixels(r)) / r->batches_wanted / picture_pixels(r), 1.0);
    if (isfinite(r->forecast.seconds) && r->forecast.seconds > 0.0) return fmin(seconds / r->forecast.seconds, 1.0);
    double f = 0.0;
    if (r->batches_wanted) f = fmax(f, batches / r->batches_wanted);
    if (o->time_limit > 0.0) f = fmax(f, seconds / o->time_limit);
    if (o->error_target > 0.0 && isfinite(r->error.error_bound)) {
        double ratio = o->error_target / r->error.error_bound; /* error falls with the square root of the work */
        f = fmax(f, ratio * ratio);
    }
    return fmin(f, 1.0);
}

/* Tells the caller; false means stop. batches counts the fraction of the one under way. */
static bool report(render_state *r, double batches)
{
    double now = ec_now(), seconds = now - r->render_start;
    r->last_report = now;
    if (!r->progress) return true;
    double samples = (double)r->samples_before + batches * r->params.batch * film_pixels(r);
    double f = fraction_done(r, batches, seconds);
    ec_progress progress = {
        .seconds = seconds,
        .seconds_left = f > 0.0 ? seconds * (1.0 - f) / f : -1.0,
        .fraction = f,
        .samples_per_pixel = (uint64_t)(r->strip_rows ? samples / picture_pixels(r) : batches * r->params.batch),
        .samples = (uint64_t)samples,
        .samples_per_second = seconds > 0.0 ? samples / seconds : 0.0,
        .error = r->strip_rows ? INFINITY : r->error.error, /* that of a strip is not the picture's */
        .error_bound = r->strip_rows ? INFINITY : r->error.error_bound,
        .pilot = r->stats->forecast.pilot_samples ? &r->stats->forecast : NULL,
        .forecast = r->forecast,
    };
    return r->progress(r->user, &progress);
}

/* Batches a pixel, in the mean. */
static double batches_done(const render_state *r)
{
    return (double)r->past.samples / r->params.batch / film_pixels(r);
}

/* Hands over what there is. A batch that is under way goes with it: on large pictures one takes minutes. */
static void keep(render_state *r, uint32_t under_way)
{
    bool is_new = r->past.next != r->kept_next || under_way > r->kept_under_way;
    if (!r->course->keep || !is_new || !r->film->batch_count || r->film->unsampled) return;
    ec_past now = r->past;
    now.seconds = ec_now() - r->render_start;
    if (under_way) {
        now.under_way = under_way;
        now.batch = r->source->mean;
        now.rays = r->rays_before + r->source->rays;
        for (int i = 0; i < EC_STAGE_COUNT; i++) now.invalid[i] = r->invalid_before[i] + r->source->invalid[i];
    }
    ec_film_show(r->film);
    if (r->course->keep(r->course->user, r->film, &now)) r->kept_next = now.next, r->kept_under_way = under_way;
    r->kept_at = ec_now();
}

/* Between waves: goes on unless a limit or the caller ends the batch early. */
static bool goes_on(void *user, uint32_t done)
{
    render_state *r = user;
    r->under_way = (uint64_t)done * r->params.batch;
    if (done > r->order.done && r->stats->first_pixel_seconds == 0.0) r->stats->first_pixel_seconds = ec_now() - r->start;
    if (done >= r->order.count) return true;
    bool is_due = r->course->keep && r->film->batch_count && ec_now() - r->kept_at >= r->course->every;
    r->look_failed = is_due && r->source->look(r->source, &r->order, &r->look_error) != EC_OK;
    if (r->look_failed) return false;
    if (is_due) keep(r, done);
    double now = ec_now(), share = done / film_pixels(r);
    bool out_of_time = r->options->time_limit > 0.0 && now - r->render_start > r->options->time_limit;
    bool go_on = now - r->last_report < 0.1 || report(r, r->batches_before_it + share);
    if (!out_of_time && go_on) return true;
    r->stopped_by = go_on ? "time" : "user";
    return false;
}

/* Up to which batch a source may look ahead: what comes after the pilot of an adaptive render, and each pass then, depends on the film. */
static uint32_t known_end(const render_state *r)
{
    uint32_t left = UINT32_MAX - r->past.next, pilot = 1;
    if (r->batches_wanted) left = r->batches_wanted - (uint32_t)fmin(batches_done(r), r->batches_wanted - 1.0);
    while (!ec_pilot_is_over(r->film->batch_count + pilot)) pilot++;
    if (r->options->adaptive && !r->past.allotted && pilot < left) left = pilot;
    return r->past.next + (r->past.allotment.weight ? 1 : left);
}

/* The pixels that the next batch is for: all, or the allotment's; and waves until they are done or *complete is false. */
static ec_result run_batch(render_state *r, bool *complete, ec_error *err)
{
    const uint64_t pixels = (uint64_t)r->film->width * r->film->height;
    ec_allotment *a = &r->past.allotment;
    if (r->past.next == 0 && !r->aov) r->aov = calloc(pixels * EC_AOV_FIELDS, sizeof *r->aov);
    if (r->past.next == 0 && !r->aov) return ec_fail(err, "out of memory for the first-hit features");
    r->order = (ec_batch_order){.index = r->past.next, .end = known_end(r), .count = (uint32_t)pixels, .aov = r->aov, .go_on = goes_on, .user = r};
    if (a->weight) r->order.count = ec_allotment_pass(a, r->film), r->order.list = a->list;
    if (r->past.under_way < r->order.count) r->order.done = r->past.under_way;
    if (r->order.done) r->order.before = r->past.batch;
    r->past.under_way = 0;
    r->past.batch = NULL;
    r->batches_before_it = batches_done(r);
    r->under_way = 0;
    ec_result result = r->source->take(r->source, &r->order, complete, err);
    if (!r->look_failed) return result;
    if (err) *err = r->look_error; /* a device tells of a failure once */
    return EC_FAILED;
}

static ec_result mark_unsampled(render_state *r, ec_error *err)
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

static ec_result add_batch(render_state *r, bool complete, ec_error *err)
{
    for (int i = 0; i < EC_STAGE_COUNT; i++) r->past.invalid[i] = r->invalid_before[i] + r->source->invalid[i];
    if (!complete) EC_TRY(mark_unsampled(r, err));
    ec_allotment *a = &r->past.allotment;
    if (a->weight) EC_TRY(ec_film_add_some(r->film, r->source->mean, a->places, r->order.count, err));
    else EC_TRY(ec_film_add_at(r->film, r->past.next, r->source->mean, err));
    if (r->aov) r->film->aov = r->aov;
    r->aov = NULL;
    r->past.samples += r->under_way;
    r->past.rays = r->rays_before + r->source->rays;
    r->past.next++;
    r->error = ec_film_estimate_error(r->film);
    return EC_OK;
}

static void look_ahead(render_state *r, bool at_pilot)
{
    double done = batches_done(r), now = ec_now(), took = now - r->batch_end;
    r->batch_end = now;
    if (r->first_seconds == 0.0) r->first_seconds = now - r->render_start;
    else if (at_pilot || !r->past.allotment.weight) r->sum += took, r->squares += took * took, r->timed++;
    if (!ec_pilot_is_over(r->film->batch_count) || r->timed == 0.0) return;
    double mean = r->sum / r->timed, variance = fmax(r->squares / r->timed - mean * mean, 0.0);
    ec_pace pace = {now - r->render_start, r->first_seconds, r->timed > 1.0 ? sqrt(variance / (r->timed - 1.0)) / mean : 0.0};
    r->forecast = ec_forecast_make(r->film, &r->error, r->options, &pace, done, at_pilot ? r->past.allotment.gain : 1.0);
    if (!r->stats->forecast.pilot_samples) r->stats->forecast = r->forecast;
}

static bool is_done(render_state *r, bool at_pilot)
{
    const ec_render_options *o = r->options;
    double done = batches_done(r), seconds = ec_now() - r->render_start;
    look_ahead(r, at_pilot);
    if (r->batches_wanted && done >= r->batches_wanted)
        r->stopped_by = "spp";
    else if (o->error_target > 0.0 && done >= 4 && r->error.error_bound <= o->error_target)
        r->stopped_by = "error";
    else if (o->time_limit > 0.0 && seconds + 0.5 * seconds / done > o->time_limit)
        r->stopped_by = "time";
    else if (!report(r, done))
        r->stopped_by = "user";
    return r->stopped_by != NULL;
}

/* One more for the film, or none; the batches before it stand, whatever happens. */
static ec_result take_batch(render_state *r, const ec_log *log, ec_error *err)
{
    bool complete;
    EC_TRY(run_batch(r, &complete, err));
    if (!complete && (r->past.next > 0 || r->course->end || r->strip_rows)) { /* part of a batch is of no use to a picture */
        keep(r, (uint32_t)(r->under_way / r->params.batch));
        return EC_OK;
    }
    if (!complete) ec_warn(log, "stopped within the first batch: parts of the picture have no samples (0 in the samples channel) and are black");
    EC_TRY(add_batch(r, complete, err));
    /* Once, when the pilot is over; where there is nothing to gain, sampling stays uniform. */
    bool at_pilot = r->options->adaptive && !r->past.allotted && ec_pilot_is_over(r->film->batch_count);
    if (at_pilot) EC_TRY(ec_allot(r->film, &r->params, &r->past.allotment, err));
    r->past.allotted |= at_pilot;
    if (complete && !is_done(r, at_pilot) && ec_now() - r->kept_at >= r->course->every) keep(r, 0);
    return EC_OK;
}

static ec_result render_film(render_state *r, const ec_log *log, ec_error *err)
{
    ec_result result = EC_OK;
    r->last_report = r->batch_end = r->kept_at = ec_now();
    r->render_start = ec_now() - r->past.seconds;
    if (r->past.samples) {
        r->error = ec_film_estimate_error(r->film);
        r->first_seconds = r->past.seconds / batches_done(r);
        (void)is_done(r, false); /* perhaps all was done before */
    }
    while (result == EC_OK && !r->stopped_by) result = take_batch(r, log, err);
    keep(r, 0);
    return result;
}

/* A strip that is not complete is of no use to a picture. */
static ec_result render_strip(render_state *r, uint32_t first_row, uint32_t rows, const ec_log *log, ec_error *err)
{
    ec_render_stats told = *r->stats;
    r->past = (ec_past){.seconds = first_row ? ec_now() - r->render_start : 0.0, .allotment.gain = 1.0};
    r->stopped_by = NULL;
    EC_TRY(ec_film_create(r->film, r->options->width, rows, r->params.batch, err));
    r->film->shows_late = true;
    EC_TRY(r->source->turn_to(r->source, first_row, rows, err));
    EC_TRY(render_film(r, log, err));
    if (strcmp(r->stopped_by, "spp")) return EC_OK;
    r->samples_before += r->past.samples;
    r->invalid_in_films += r->film->invalid_count;
    ec_film_show(r->film);
    told.samples = r->samples_before;
    return r->course->strip(r->course->user, r->film, first_row, &told, err);
}

static ec_result render_strips(render_state *r, const ec_log *log, ec_error *err)
{
    const uint32_t height = r->options->height;
    ec_result result = EC_OK;
    r->stopped_by = "spp";
    for (uint32_t row = 0, rows; result == EC_OK && row < height && !strcmp(r->stopped_by, "spp"); row += rows) {
        rows = height - row < r->strip_rows ? height - row : r->strip_rows;
        result = render_strip(r, row, rows, log, err);
        ec_film_destroy(r->film);
    }
    r->past.samples = r->samples_before;
    r->error.error = r->error.error_bound = r->error.relmse = INFINITY; /* of strips, not of the picture */
    return result;
}

/* Asks nothing of the device, which may be lost. */
static void finish_stats(render_state *r)
{
    ec_render_stats *s = r->stats;
    const uint64_t *invalid = r->past.invalid;
    s->seconds = ec_now() - r->render_start;
    s->invalid_generate = invalid[EC_STAGE_GENERATE];
    s->invalid_intersect = invalid[EC_STAGE_INTERSECT];
    s->invalid_shade = invalid[EC_STAGE_SHADE];
    s->invalid_connect = invalid[EC_STAGE_CONNECT];
    s->invalid_accumulate = invalid[EC_STAGE_ACCUMULATE] + r->film->invalid_count + r->invalid_in_films; /* finite samples whose sum is not */
    s->invalid_samples = s->invalid_generate + s->invalid_intersect + s->invalid_shade + s->invalid_connect + s->invalid_accumulate;
    s->samples_per_pixel = (uint64_t)((double)r->past.samples / picture_pixels(r) + 1e-6);
    s->allotment_gain = r->past.allotment.gain;
    s->samples = r->past.samples;
    s->rays = r->rays_before + r->source->rays;
    s->samples_per_second = s->seconds > 0.0 ? (double)s->samples / s->seconds : 0.0;
    s->rays_per_second = s->seconds > 0.0 ? (double)s->rays / s->seconds : 0.0;
    s->error = r->error.error;
    s->error_bound = r->error.error_bound;
    s->relmse = r->error.relmse;
    s->trace_seconds = r->source->clocked_rays > 0 ? r->source->clocked_seconds / r->source->clocked_rays * (double)s->rays : s->seconds;
    snprintf(s->stopped_by, sizeof s->stopped_by, "%s", r->stopped_by ? r->stopped_by : "user");
}

/* Also where survival is no probability at all. Only paths go by it: ray trees have a depth of their own, rasterised pictures none. */
static ec_result check_ends(const ec_render_options *o, ec_error *err)
{
    bool ends = (o->survival >= 0.0 && o->survival < 1.0) || o->max_depth;
    if (o->integrator != EC_INTEGRATOR_PATH || ends) return EC_OK;
    return ec_fail(err, "a survival probability of %g with unlimited depth: nothing would end a path; set max_depth, or a survival under 1", o->survival);
}

/* No option is without effect in silence. */
static ec_result note_unneeded(const ec_scene *scene, uint64_t without, const ec_log *log, ec_error *err)
{
    ec_effects effects;
    char names[EC_EFFECT_NAMES];
    if (!without) return EC_OK;
    EC_TRY(ec_scene_calls(scene, &effects, err));
    ec_feature_names(without & ~effects.bits, names, sizeof names);
    if (*names) ec_note(log, "--without: the scene does not call for %s", names);
    return EC_OK;
}

/* What kernels take when they first run. PoCL compiles their last part then: 13 MB for the Cornell box, 127 for all effects; where it has
 * done so before (the cache was hit), none was seen. */
static uint64_t driver_bytes(const ec_cl *cl) { return cl->cache_misses ? 144ull << 20 : 8ull << 20; }

/* All rows, or as many as there is memory for. Small pictures do not ask. */
static ec_result choose_rows(render_state *r, const ec_log *log, ec_error *err)
{
    const ec_render_options *o = r->options;
    const ec_pipeline *p = ec_sources_alone(&r->sources);
    const ec_device_info *device = &p->cl->info;
    const bool shared = device->type & CL_DEVICE_TYPE_CPU, can = r->course->strip != NULL;
    const uint64_t whole = ec_strip_whole(o, shared), left = device->memory_bytes - p->cl->allocated_bytes;
    if (!o->memory && (whole < EC_STRIP_NEVER || !can)) return EC_OK;
    const int64_t budget = ec_strip_budget(o, driver_bytes(p->cl) + (shared ? p->wave_bytes : 0));
    const uint32_t rows = ec_strip_rows(o, shared, budget, left, device->max_allocation_bytes);
    r->stats->strips = rows ? (o->height + rows - 1) / rows : 1;
    if (rows == o->height || (!rows && !o->memory)) return EC_OK;
    if (!rows)
        return ec_fail(err, "--memory: %.0f MB are not enough for scene and program, and for %u rows of this picture, %.1f MB; give %.0fM or more, "
                            "or a picture less wide", (double)o->memory / 1e6, EC_STRIP_STEP, (double)ec_strip_least(o, shared) / 1e6,
                       ceil((double)((int64_t)(o->memory + ec_strip_least(o, shared)) - budget) / 1e6));
    if (!can) return ec_strip_refuse(o, whole, budget, r->course->whole_for, err);
    r->strip_rows = rows;
    ec_note(log, "not all %u rows fit into %s memory at a time: the picture is rendered in %u strips of %u", o->height, o->memory ? "that" : "free",
            r->stats->strips, rows);
    return EC_OK;
}

/* Film and figures of the course's past, or of none. */
static void take_up(render_state *r, const ec_past *past)
{
    r->past.allotment.gain = 1.0;
    r->past.next = r->kept_next = r->course->first;
    if (!past) return;
    r->past = *past;
    r->past.allotment.weight = NULL;
    r->rays_before = past->rays;
    memcpy(r->invalid_before, past->invalid, sizeof r->invalid_before);
    r->kept_next = past->next;
    r->kept_under_way = past->under_way;
}

/* Of one device, told once it is loaded, since that is what its films have to fit beside; several devices have all rows. */
static ec_result choose_film(render_state *r, uint32_t batch, const ec_log *log, ec_error *err)
{
    const ec_pipeline *alone = ec_sources_alone(&r->sources);
    if (alone) EC_TRY(choose_rows(r, log, err));
    if (!r->course->past && !r->strip_rows) EC_TRY(ec_film_create(r->film, r->options->width, r->options->height, batch, err));
    r->film->shows_late = true;
    if (!alone) return EC_OK;
    if (!r->strip_rows) EC_TRY(r->source->turn_to(r->source, 0, r->options->height, err));
    r->stats->wave = alone->wave;
    if (alone->wave < alone->first_wave)
        ec_note(log, "the device had memory for a wave of %u paths, not of %u; --wave sets it", alone->wave, alone->first_wave);
    return EC_OK;
}

static ec_result set_up(render_state *r, ec_cl *devices, uint32_t device_count, const ec_scene *scene, uint32_t batch, const ec_log *log,
                        ec_error *err)
{
    const ec_past *past = r->course->past;
    const ec_cargo_head *head = &r->sources.cargo.head;
    take_up(r, past);
    EC_TRY(ec_sources_pack(devices, device_count, r->course->allies != NULL, scene, r->options, batch, &r->sources, r->stats, err));
    r->params = head->params;
    const uint64_t called = head->effects.called.bits; /* the cargo is spent when it is loaded */
    if (head->bodies_too_many)
        ec_warn(log, "%u materials of glass or liquid, of which %u can be told apart: each of their bodies refracts as if in air; give bodies that are alike one material",
                head->bodies_too_many, EC_BODIES_MOST);
    if (r->options->scattering == EC_SCATTERING_MULTIPLE && !(called & EC_FEATURE_MULTISCATTER))
        ec_note(log, "--scattering multiple: the scene has no rough metal or glass");
    if (r->course->admit) EC_TRY(r->course->admit(r->course->user, r->stats, err));
    if (past && past->allotment.weight) EC_TRY(ec_allotment_again(&past->allotment, &r->params, &r->past.allotment, err));
    EC_TRY(ec_sources_open(&r->sources, r->options->seed, r->course->allies, log, &r->source, r->stats, err));
    return choose_film(r, batch, log, err);
}

ec_result ec_render_course(ec_cl *devices, uint32_t device_count, const ec_scene *scene, const ec_render_options *options, const ec_course *course,
                           ec_progress_fn progress, void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err)
{
    *stats = (ec_render_stats){.strips = 1};
    EC_TRY(check_ends(options, err));
    EC_TRY(note_unneeded(scene, options->without, log, err));
    render_state r = {.options = options, .course = course, .progress = progress, .user = user, .film = film, .stats = stats, .start = ec_now()};
    r.error.error = r.error.error_bound = r.error.relmse = INFINITY;
    uint32_t batch = ec_render_batch(options);
    r.batches_wanted = options->spp ? (options->spp + batch - 1) / batch : 0;
    if (course->end) r.batches_wanted = course->end - course->first;
    ec_result result = set_up(&r, devices, device_count, scene, batch, log, err);
    if (result == EC_OK) {
        ec_error why = {0};
        result = r.strip_rows ? render_strips(&r, log, &why) : render_film(&r, log, &why);
        if (result != EC_OK) r.stopped_by = why.kind == EC_ERROR_OTHER ? "failure" : "device";
        if (result != EC_OK && err) *err = why;
        finish_stats(&r);
    }
    ec_film_show(film);
    ec_allotment_free(&r.past.allotment);
    free(r.aov);
    ec_sources_close(&r.sources, stats);
    return result;
}

ec_result ec_render(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, ec_progress_fn progress,
                    void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err)
{
    const ec_course whole = {0};
    return ec_render_course(cl, 1, scene, options, &whole, progress, user, film, stats, log, err);
}

ec_result ec_scene_estimate(const ec_scene *scene, uint32_t ref_count, uint64_t *device_bytes, ec_render_effects *effects, ec_error *err)
{
    ec_pack pack;
    EC_TRY(ec_pack_scene(scene, &pack, err));
    ec_upload plan[EC_SCENE_BUFFERS];
    const ec_render_options by_default = {0};
    *effects = (ec_render_effects){0};
    ec_pipeline_effects(&by_default, &pack, effects);
    uint32_t count = ec_upload_plan(scene, &pack, plan, effects);
    uint64_t triangles = scene->triangle_count, bytes = 0;
    for (uint32_t i = 0; i < count; i++) bytes += plan[i].buffer.bytes;
    uint64_t blocks = ref_count / 7, boxes = ref_count > triangles ? blocks : 0; /* leaf blocks seven eighths full */
    bytes += blocks * sizeof(ec_tri8) + boxes * sizeof(ec_box8) + ref_count / 20 * sizeof(ec_bvh8_node);
    if (scene->placed_count) bytes += scene->placed_count * (sizeof(ec_instance) + sizeof(ec_bvh8_node) / 4);
    *device_bytes = bytes;
    ec_pack_free(&pack);
    return EC_OK;
}
