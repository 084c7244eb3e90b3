#include "view/picture.h"

#include <math.h>
#include <stdlib.h>

#include "pipeline/forecast.h"
#include "pipeline/looks.h"
#include "view/slice.h"

#define BATCH_SECONDS 0.5
#define BATCH_MOST 16u
#define BATCHES_LEAST 4u /* as many as an error limit is judged by */

/* Does spp part into whole batches, and into enough of them for an error? */
static bool parts(uint32_t spp, uint32_t batch)
{
    return !spp || (spp % batch == 0 && spp / batch >= BATCHES_LEAST);
}

/* A power of two, and a divisor of spp, so that the limit is met exactly. */
static uint32_t choose_batch(const ec_render_options *o, double pixels, double rate)
{
    uint32_t batch = 1;
    if (o->batch) return o->batch;
    while (batch < BATCH_MOST && 2 * batch * pixels <= rate * BATCH_SECONDS && parts(o->spp, 2 * batch)) batch *= 2;
    return batch;
}

void ec_view_picture_limit(ec_view_picture *p, const ec_render_options *o, uint32_t more)
{
    uint32_t batch = p->limits.batch;
    p->limits = *o;
    p->limits.batch = batch;
    for (uint32_t i = 0; i < more; i++) {
        p->limits.spp = p->limits.spp > (1u << 22) ? p->limits.spp : 4 * p->limits.spp;
        p->limits.time_limit *= 4;
        p->limits.error_target /= 2;
    }
    p->stopped_by = NULL;
}

ec_result ec_view_picture_start(ec_view_picture *p, const ec_render_options *options, uint32_t more, uint32_t width,
                                uint32_t height, double rate, ec_error *err)
{
    ec_view_picture_stop(p);
    p->limits.batch = choose_batch(options, (double)width * height, rate);
    ec_view_picture_limit(p, options, more);
    p->error = (ec_film_error){.error = INFINITY, .error_bound = INFINITY, .relmse = INFINITY};
    p->forecast = (ec_forecast){.seconds = INFINITY};
    return ec_film_create(&p->film, width, height, p->limits.batch, err);
}

void ec_view_picture_stop(ec_view_picture *p)
{
    ec_film_destroy(&p->film);
    *p = (ec_view_picture){0};
}

static void look_ahead(ec_view_picture *p)
{
    double done = p->film.batch_count, timed = done - 1, mean = p->sum / timed;
    if (!ec_pilot_is_over(p->film.batch_count)) return;
    double variance = fmax(p->squares / timed - mean * mean, 0);
    ec_pace pace = {p->seconds, p->first_seconds, timed > 1 ? sqrt(variance / (timed - 1)) / mean : 0};
    p->forecast = ec_forecast_make(&p->film, &p->error, &p->limits, &pace, done, 1);
}

static void judge(ec_view_picture *p)
{
    const ec_render_options *o = &p->limits;
    if (p->film.batch_count >= 2) p->error = ec_film_estimate_error(&p->film);
    look_ahead(p);
    if (o->spp && (uint64_t)p->film.batch_count * o->batch >= o->spp) p->stopped_by = "spp";
    else if (o->error_target > 0 && p->film.batch_count >= 4 && ec_look_is_due(p->film.batch_count) &&
             p->error.error_bound <= o->error_target)
        p->stopped_by = "error";
    else if (o->time_limit > 0 && p->seconds >= o->time_limit) p->stopped_by = "time";
}

ec_result ec_view_picture_take(ec_view_picture *p, ec_session *session, bool (*go_on)(void *user), void *user,
                               float *mean, bool *complete, ec_error *err)
{
    uint64_t pixels = (uint64_t)p->film.width * p->film.height;
    float *features = p->film.batch_count == 0 ? malloc(pixels * 8 * sizeof(float)) : NULL;
    ec_session_batch batch = {.seed = ec_render_batch_seed(p->limits.seed, p->film.batch_count), .samples = p->limits.batch, .go_on = go_on,
                              .user = user, .slice = EC_VIEW_SLICE, .features = features, .mean = mean};
    ec_result result = ec_session_take(session, &batch, err);
    *complete = result == EC_OK && batch.complete;
    if (!*complete) {
        free(features);
        return result;
    }
    if (features) p->film.aov = features;
    EC_TRY(ec_film_add_batch(&p->film, mean, err));
    p->invalid += batch.invalid;
    p->seconds += batch.seconds;
    if (p->film.batch_count == 1) p->first_seconds = batch.seconds;
    else p->sum += batch.seconds, p->squares += batch.seconds * batch.seconds;
    judge(p);
    return EC_OK;
}
