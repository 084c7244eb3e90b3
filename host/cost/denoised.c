/* Denoised pictures of a study: as `eclat render --denoise` makes them. */
#include "denoise/denoise.h"

#include <stdlib.h>
#include <string.h>

#include "cost/cost_internal.h"
#include "film/resolve.h"

/* A replicate with all of its samples is one batch of the film. */
static ec_result take_replicate(ec_cost_runner *runner, ec_film *film, ec_session_batch *batch, ec_error *err)
{
    EC_TRY(ec_session_take(runner->session, batch, err));
    runner->stopped = !batch->complete;
    if (runner->stopped) return EC_OK;
    runner->invalid += batch->invalid;
    return ec_film_take(film, &(ec_film_batch){.index = batch->replicate, .values = batch->batch, .features = batch->features}, err);
}

static ec_result denoise(ec_cost_runner *runner, ec_film *film, ec_error *err)
{
    ec_denoised came = {0};
    EC_TRY(ec_denoise(film, EC_DENOISER_AUTO, &runner->study->cl->info, &came, err));
    if (!came.why_not) runner->denoise_seconds += came.seconds, runner->denoised++;
    if (film->clean.best) memcpy(runner->mean, film->clean.best, runner->pixels * 3 * sizeof(float));
    else ec_film_resolve(film, runner->mean, NULL); /* too few samples: as it is */
    return EC_OK;
}

static ec_result take_all(ec_cost_runner *runner, ec_film *film, ec_session_batch *room, uint32_t samples, double *seconds, ec_error *err)
{
    const uint32_t count = samples < film->replicates ? samples : film->replicates;
    for (uint32_t r = 0; r < count && !runner->stopped; r++) {
        ec_session_batch batch = *room;
        batch.replicate = r;
        batch.samples = samples / count + (r < samples % count);
        EC_TRY(take_replicate(runner, film, &batch, err));
        *seconds += batch.seconds;
    }
    runner->seconds_per_sample = *seconds / ((double)samples * (double)runner->pixels);
    return runner->stopped ? EC_OK : denoise(runner, film, err);
}

ec_result ec_cost_denoised_take(ec_cost_runner *runner, uint32_t seed, uint32_t samples, bool (*go_on)(void *study), double *seconds, ec_error *err)
{
    const ec_render_options *o = &runner->study->options;
    ec_film film = {0};
    ec_session_batch room = {.seed = seed, .go_on = go_on, .user = runner->study,
                             .batch = malloc(runner->pixels * EC_BATCH_FIELDS * sizeof(float)),
                             .features = malloc(runner->pixels * EC_FILM_FEATURES * sizeof(float))};
    *seconds = 0;
    ec_result result = room.batch && room.features ? EC_OK : ec_fail(err, "out of memory for a picture to denoise");
    if (result == EC_OK) result = ec_film_create(&film, o->width, o->height, runner->replicates, err);
    ec_film_want_features(&film, 2, UINT32_MAX);
    if (result == EC_OK) result = take_all(runner, &film, &room, samples, seconds, err);
    ec_film_destroy(&film);
    free(room.batch);
    free(room.features);
    return result;
}
