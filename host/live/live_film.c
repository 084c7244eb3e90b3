#include "live/renderer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void ec_live_film_limit(ec_live_film *p, const ec_render_options *o, uint32_t more)
{
    const ec_denoiser denoise = p->film.width ? p->limits.denoise : o->denoise; /* a film that has begun keeps its denoiser */
    p->limits = *o;
    p->limits.denoise = denoise;
    for (uint32_t i = 0; i < more; i++) {
        p->limits.spp = p->limits.spp > (1u << 22) ? p->limits.spp : 4 * p->limits.spp;
        p->limits.time_limit *= 4;
        p->limits.error_target /= 2;
    }
    if (p->film.cut) { /* it ends within a batch, after which it cannot go on */
        const ec_film old = p->film;
        ec_film_destroy(&p->film);
        (void)ec_film_create(&p->film, old.width, old.height, old.replicates, NULL);
        ec_film_want_features(&p->film, old.feature_sets, old.feature_end);
        p->seconds = 0;
        p->goal = (ec_goal){.pixels = p->goal.pixels, .replicates = old.replicates, .forecast.seconds = INFINITY};
    }
    ec_goal_set(&p->goal, p->limits.spp, p->limits.time_limit, p->limits.error_target);
    p->stopped_by = NULL;
}

ec_result ec_live_film_start(ec_live_film *p, const ec_render_options *options, uint32_t more, uint32_t width, uint32_t height, ec_error *err)
{
    const uint32_t replicates = ec_render_replicates(options);
    ec_live_film_stop(p);
    p->goal = (ec_goal){.pixels = (double)width * height, .replicates = replicates, .forecast.seconds = INFINITY};
    ec_live_film_limit(p, options, more);
    p->error = (ec_film_error){.error = INFINITY, .error_bound = INFINITY, .relmse = INFINITY};
    EC_TRY(ec_film_create(&p->film, width, height, replicates, err));
    ec_film_want_features(&p->film, ec_render_feature_sets(options), ec_render_feature_end(options));
    return EC_OK;
}

void ec_live_film_stop(ec_live_film *p)
{
    ec_film_destroy(&p->film);
    free(p->room);
    *p = (ec_live_film){0};
}

/* A failure is reported once, and leaves the picture unchanged. */
void ec_live_film_clean(ec_live_film *p, const ec_device_info *device, bool now)
{
    ec_error err = {0};
    const double samples = ec_film_samples_of_all(&p->film);
    const bool is_due = p->clean_samples > 0 ? samples >= 2 * p->clean_samples : ec_schedule_has_pilot(p->film.replicates, p->film.batch_count);
    if (samples == p->clean_samples || *p->undenoised || !(is_due || now || p->stopped_by)) return;
    if (ec_denoise(&p->film, p->limits.denoise, device, &p->denoised, &err) != EC_OK) snprintf(p->undenoised, sizeof p->undenoised, "%.319s", err.text);
    p->clean_samples = samples;
    if (*p->undenoised || p->denoised.why_not) return;
    ec_clean_goal_take(&p->goal.clean, samples, &(ec_clean_look){p->denoised.best.error, p->denoised.best.high95});
}

/* Predicts rare light with the second batch, when there is a first error to state. */
static ec_result predict(ec_live_film *p, ec_session *session, ec_error *err)
{
    ec_rare rare;
    if (p->film.batch_count != 2) return EC_OK;
    EC_TRY(ec_session_predict(session, &rare, err));
    return ec_film_set_rare(&p->film, &rare, err);
}

static void judge(ec_live_film *p, double took)
{
    const uint32_t replicates = p->film.replicates, next = p->film.batch_count;
    const bool is_round = ec_schedule_is_round(replicates, next), has_pilot = ec_schedule_has_pilot(replicates, next);
    const ec_mark at = {ec_film_samples_of_all(&p->film), p->seconds};
    p->error = ec_film_estimate_error(&p->film);
    ec_goal_batch(&p->goal, at.samples, at.seconds, took);
    if (is_round) ec_goal_round(&p->goal, &p->error, at);
    if (is_round && has_pilot) ec_goal_predict(&p->goal, at, 1);
    p->stopped_by = ec_goal_met(&p->goal, at, is_round && has_pilot, ec_schedule_batch(replicates, next).samples);
    if (p->film.cut) p->stopped_by = "spp";
}

/* Allocates the batch, and first-hit features if the film wants them. */
static ec_result make_room(ec_live_film *p, float **features, ec_error *err)
{
    const uint64_t pixels = (uint64_t)p->film.width * p->film.height;
    const bool wants_features = ec_film_sets(&p->film, p->film.batch_count) > 0;
    if (!p->room) p->room = malloc(pixels * EC_BATCH_FIELDS * sizeof *p->room);
    *features = wants_features ? malloc(pixels * EC_FILM_FEATURES * sizeof **features) : NULL;
    return p->room && (*features || !wants_features) ? EC_OK : ec_fail(err, "out of memory for a picture");
}

ec_result ec_live_film_take(ec_live_film *p, ec_session *session, bool (*go_on)(void *user), void *user, bool *complete, ec_error *err)
{
    const uint32_t index = p->film.batch_count;
    const ec_batch_range range = ec_schedule_batch(p->film.replicates, index);
    uint32_t cut = 0, before = 0;
    float *features = NULL;
    ec_result result = make_room(p, &features, err);
    if (p->limits.spp && ec_schedule_find(p->film.replicates, p->limits.spp, &before) == index && before) cut = range.samples - before;
    ec_session_batch batch = {.seed = ec_render_seed(p->limits.seed), .replicate = range.replicate, .first = (uint32_t)range.first,
                              .samples = range.samples - cut, .go_on = go_on, .user = user, .slice = EC_LIVE_SLICE,
                              .features = features, .batch = p->room};
    if (result == EC_OK) result = ec_session_take(session, &batch, err);
    *complete = result == EC_OK && batch.complete;
    if (*complete) result = ec_film_take(&p->film, &(ec_film_batch){.index = index, .cut = cut, .values = p->room, .features = features}, err);
    free(features);
    if (result != EC_OK || !*complete) return result;
    EC_TRY(predict(p, session, err));
    p->invalid += batch.invalid;
    p->seconds += batch.seconds;
    judge(p, batch.seconds);
    return EC_OK;
}
