/* Batches until a limit is met. */
#include "pipeline/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/random.h"
#include "pipeline/adaptive.h"
#include "pipeline/forecast.h"
#include "pipeline/pipeline.h"

typedef struct render_state {
    ec_pipeline pipeline;
    const ec_render_options *options;
    ec_progress_fn progress;
    void *user;
    ec_film *film;
    ec_render_stats *stats;
    double start, render_start, last_report;
    double batch_end;          /* of the last one; and the sums of their times, the first left out */
    double first_seconds, sum, squares;
    ec_forecast forecast;      /* of now; the pilot's is in stats */
    uint32_t batches_wanted;   /* by --spp; 0 = no limit */
    ec_film_error error;
    ec_allotment allotment;    /* with weights from the end of an adaptive render's pilot on */
    const char *stopped_by;
    uint64_t samples, under_way; /* in the film; of the batch that is not there yet */
    uint32_t invalid[EC_STAGE_COUNT]; /* dropped by the kernels so far */
} render_state;

/* Largest divisor of the sample count that still leaves 16 batches: whole batches, and enough of them for an error. */
static uint32_t batch_of_spp(uint32_t spp)
{
    uint32_t most = spp / 16 < 1 ? 1 : (spp / 16 > 64 ? 64 : spp / 16);
    while (spp % most) most--;
    return most;
}

static uint32_t choose_batch(const ec_render_options *o)
{
    if (o->batch) return o->batch;
    return o->spp ? batch_of_spp(o->spp) : 8;
}

/* Seeds of batches must differ in every bit. */
uint32_t ec_render_batch_seed(uint64_t seed, uint32_t batch)
{
    return (uint32_t)(ec_random_mix(seed * EC_RANDOM_STEP + batch + 1) >> 16);
}

static double fraction_done(const render_state *r, double batches, double seconds)
{
    const ec_render_options *o = r->options;
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
    ec_pipeline *p = &r->pipeline;
    double samples = batches * p->params.batch * p->params.width * p->params.height;
    double f = fraction_done(r, batches, seconds);
    ec_progress progress = {
        .seconds = seconds,
        .seconds_left = f > 0.0 ? seconds * (1.0 - f) / f : -1.0,
        .fraction = f,
        .samples_per_pixel = (uint64_t)(batches * p->params.batch),
        .samples = (uint64_t)samples,
        .samples_per_second = seconds > 0.0 ? samples / seconds : 0.0,
        .error = r->error.error,
        .error_bound = r->error.error_bound,
        .pilot = r->stats->forecast.pilot_samples ? &r->stats->forecast : NULL,
        .forecast = r->forecast,
    };
    return r->progress(r->user, &progress);
}

/* Batches a pixel, in the mean. */
static double batches_done(const render_state *r)
{
    const ec_params *params = &r->pipeline.params;
    return (double)r->samples / params->batch / ((double)params->width * params->height);
}

/* The pixels that the next batch is for: all, or the allotment's. */
static ec_result choose_pixels(render_state *r, uint32_t *count, ec_error *err)
{
    ec_pipeline *p = &r->pipeline;
    ec_allotment *a = &r->allotment;
    *count = p->params.width * p->params.height;
    if (!a->weight) return EC_OK;
    cl_mem *list = &p->buffers[EC_ARG_PIXEL_LIST];
    const uint64_t slack = 64; /* lanes past the last sample look too */
    if (!*list) EC_TRY(ec_buffer_create(p->cl, "pixel list", ((uint64_t)*count + slack) * 4, NULL, list, err));
    *count = ec_allotment_pass(a, r->film);
    return ec_buffer_write(p->cl, *list, 0, (uint64_t)*count * 4, a->list, err);
}

/* All waves of one batch. *complete is false where a limit or the user ended it early. */
static ec_result run_batch(render_state *r, uint32_t batch, uint32_t pixels, bool *complete, ec_error *err)
{
    ec_pipeline *p = &r->pipeline;
    uint32_t per_wave = p->wave / p->params.batch;
    double before = batches_done(r), share = pixels / ((double)p->params.width * p->params.height);
    uint32_t seed = ec_render_batch_seed(r->options->seed, batch);
    *complete = true;
    r->under_way = 0;
    for (uint32_t first = 0; first < pixels; first += per_wave) {
        uint32_t count = pixels - first < per_wave ? pixels - first : per_wave;
        EC_TRY(ec_pipeline_run_wave(p, seed, first, count, batch == 0, err));
        r->under_way += (uint64_t)count * p->params.batch;
        if (batch == 0 && first == 0) {
            EC_TRY(ec_cl_finish(p->cl, err));
            r->stats->first_pixel_seconds = ec_now() - r->start;
        }
        if (first + count >= pixels) break;
        double now = ec_now();
        bool out_of_time = r->options->time_limit > 0.0 && now - r->render_start > r->options->time_limit;
        bool go_on = now - r->last_report < 0.1 || report(r, before + share * (first + count) / pixels);
        if (out_of_time || !go_on) {
            r->stopped_by = go_on ? "time" : "user";
            *complete = false;
            return EC_OK;
        }
    }
    return EC_OK;
}

/* Radiance is never negative: what still holds this has not been reached. */
#define NOT_REACHED (-1.0f)

static ec_result mark_unsampled(render_state *r, float *host, uint64_t pixels, ec_error *err)
{
    r->film->unsampled = calloc(pixels, 1);
    if (!r->film->unsampled) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)pixels);
    for (uint64_t i = 0; i < pixels; i++) {
        if (host[3 * i] != NOT_REACHED) continue;
        r->film->unsampled[i] = 1;
        host[3 * i] = host[3 * i + 1] = host[3 * i + 2] = 0.0f;
    }
    return EC_OK;
}

static ec_result add_batch(render_state *r, float *host, uint32_t count, bool complete, ec_error *err)
{
    ec_pipeline *p = &r->pipeline;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_BATCH_FILM], 0, (uint64_t)count * 12, host, err));
    EC_TRY(ec_pipeline_read_invalid(p, r->invalid, err));
    if (!complete) EC_TRY(mark_unsampled(r, host, count, err));
    if (r->allotment.weight) EC_TRY(ec_film_add_some(r->film, host, r->allotment.places, count, err));
    else ec_film_add_batch(r->film, host);
    r->samples += r->under_way;
    r->error = ec_film_estimate_error(r->film);
    return EC_OK;
}

static void look_ahead(render_state *r)
{
    double done = batches_done(r), now = ec_now(), took = now - r->batch_end, timed = r->film->batch_count - 1.0;
    r->batch_end = now;
    if (r->film->batch_count == 1) r->first_seconds = now - r->render_start;
    else if (!r->allotment.weight) r->sum += took, r->squares += took * took;
    if (!ec_pilot_is_over(r->film->batch_count)) return;
    double mean = r->sum / timed, variance = fmax(r->squares / timed - mean * mean, 0.0);
    ec_pace pace = {now - r->render_start, r->first_seconds, timed > 1.0 ? sqrt(variance / (timed - 1.0)) / mean : 0.0};
    bool is_pilot = !r->stats->forecast.pilot_samples;
    r->forecast = ec_forecast_make(r->film, &r->error, r->options, &pace, done, is_pilot ? r->allotment.gain : 1.0);
    if (is_pilot) r->stats->forecast = r->forecast;
}

static bool is_done(render_state *r)
{
    const ec_render_options *o = r->options;
    double done = batches_done(r), seconds = ec_now() - r->render_start;
    look_ahead(r);
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

static ec_result read_features(render_state *r, ec_error *err)
{
    ec_pipeline *p = &r->pipeline;
    uint64_t pixels = (uint64_t)p->params.width * p->params.height;
    float *aov = malloc(pixels * EC_AOV_FIELDS * sizeof(float));
    if (!aov) return ec_fail(err, "out of memory for the first-hit features");
    ec_result result = ec_buffer_read(p->cl, p->buffers[EC_ARG_FEATURE_FILM], 0, pixels * EC_AOV_FIELDS * 4, aov, err);
    if (result == EC_OK) r->film->aov = aov;
    else free(aov);
    return result;
}

/* Once, when the pilot is over; where there is nothing to gain, sampling stays uniform. */
static ec_result allot(render_state *r, ec_error *err)
{
    return r->stats->forecast.pilot_samples ? EC_OK : ec_allot(r->film, &r->pipeline.params, &r->allotment, err);
}

/* One more for the film, or none; the batches before it stand, whatever happens. */
static ec_result take_batch(render_state *r, uint32_t batch, float *host, const ec_log *log, ec_error *err)
{
    bool complete;
    uint32_t count;
    EC_TRY(choose_pixels(r, &count, err));
    EC_TRY(run_batch(r, batch, count, &complete, err));
    if (!complete && batch > 0) return EC_OK;
    if (!complete) ec_warn(log, "stopped within the first batch: parts of the picture have no samples (0 in the samples channel) and are black");
    EC_TRY(add_batch(r, host, count, complete, err));
    if (batch == 0) EC_TRY(read_features(r, err));
    if (r->options->adaptive && ec_pilot_is_over(batch + 1)) EC_TRY(allot(r, err));
    if (complete) is_done(r);
    return EC_OK;
}

static ec_result render_loop(render_state *r, const ec_log *log, ec_error *err)
{
    ec_pipeline *p = &r->pipeline;
    uint64_t pixels = (uint64_t)p->params.width * p->params.height;
    float *host = malloc(pixels * 12);
    if (!host) return ec_fail(err, "out of memory for a film of %llu pixels", (unsigned long long)pixels);
    for (uint64_t i = 0; i < 3 * pixels; i++) host[i] = NOT_REACHED;
    ec_result result = ec_buffer_write(p->cl, p->buffers[EC_ARG_BATCH_FILM], 0, pixels * 12, host, err);
    r->render_start = r->last_report = r->batch_end = ec_now();
    for (uint32_t batch = 0; result == EC_OK && !r->stopped_by; batch++) result = take_batch(r, batch, host, log, err);
    free(host);
    return result;
}

/* Asks nothing of the device, which may be lost. */
static void finish_stats(render_state *r)
{
    ec_render_stats *s = r->stats;
    const ec_pipeline *p = &r->pipeline;
    const uint32_t *invalid = r->invalid;
    s->seconds = ec_now() - r->render_start;
    s->invalid_generate = invalid[EC_STAGE_GENERATE];
    s->invalid_intersect = invalid[EC_STAGE_INTERSECT];
    s->invalid_shade = invalid[EC_STAGE_SHADE];
    s->invalid_connect = invalid[EC_STAGE_CONNECT];
    s->invalid_accumulate = invalid[EC_STAGE_ACCUMULATE] + r->film->invalid_count; /* finite samples whose sum is not */
    s->invalid_samples = s->invalid_generate + s->invalid_intersect + s->invalid_shade + s->invalid_connect + s->invalid_accumulate;
    s->samples_per_pixel = (uint64_t)(batches_done(r) * p->params.batch + 1e-6);
    s->allotment_gain = r->allotment.gain;
    s->samples = r->samples;
    s->rays = p->rays;
    s->samples_per_second = s->seconds > 0.0 ? (double)s->samples / s->seconds : 0.0;
    s->rays_per_second = s->seconds > 0.0 ? (double)s->rays / s->seconds : 0.0;
    s->error = r->error.error;
    s->error_bound = r->error.error_bound;
    s->relmse = r->error.relmse;
    s->device_bytes = p->cl->peak_allocated_bytes;
    s->cache_hits = p->cl->cache_hits;
    s->cache_misses = p->cl->cache_misses;
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

ec_result ec_render(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, ec_progress_fn progress,
                    void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err)
{
    memset(stats, 0, sizeof *stats);
    EC_TRY(check_ends(options, err));
    EC_TRY(note_unneeded(scene, options->without, log, err));
    render_state r = {.options = options, .progress = progress, .user = user, .film = film, .stats = stats, .start = ec_now()};
    r.error.error = r.error.error_bound = r.error.relmse = INFINITY;
    r.allotment.gain = 1.0;
    uint32_t batch = choose_batch(options);
    r.batches_wanted = options->spp ? (options->spp + batch - 1) / batch : 0;
    ec_result result = ec_film_create(film, options->width, options->height, batch, err);
    if (result == EC_OK) result = ec_pipeline_create(cl, scene, options, batch, &r.pipeline, stats, err);
    if (result == EC_OK && r.pipeline.bodies_too_many)
        ec_warn(log, "%u materials of glass or liquid, of which %u can be told apart: each of their bodies refracts as if in air; give bodies that are alike one material",
                r.pipeline.bodies_too_many, EC_BODIES_MOST);
    if (result == EC_OK && r.pipeline.wave < r.pipeline.first_wave)
        ec_note(log, "the device had memory for a wave of %u paths, not of %u; --wave sets it", r.pipeline.wave, r.pipeline.first_wave);
    if (result == EC_OK) {
        ec_error why = {0};
        result = render_loop(&r, log, &why);
        if (result != EC_OK) r.stopped_by = why.kind == EC_ERROR_OTHER ? "failure" : "device";
        if (result != EC_OK && err) *err = why;
        finish_stats(&r);
    }
    ec_allotment_free(&r.allotment);
    ec_pipeline_destroy(&r.pipeline);
    return result;
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
