/* Takes denoised pictures of a study, like `eclat render --denoise`. */
#include "denoise/denoise.h"

#include <stdlib.h>
#include <string.h>

#include "cost/cost_internal.h"
#include "film/resolve.h"

/* Takes all samples of a replicate. Others have as many, or one more or less, so that each is the same share of its set of features. */
static ec_result take_replicate(ec_cost_runner *runner, const ec_sums *sums, ec_session_batch *batch, ec_error *err)
{
    const uint32_t r = batch->replicate;
    EC_TRY(ec_session_take(runner->session, batch, err));
    runner->stopped = !batch->complete;
    if (runner->stopped) return EC_OK;
    runner->invalid += batch->invalid;
    (void)ec_sums_add(sums, batch->batch, r, 1, runner->pixels);
    ec_sums_add_features(sums, batch->features, r % sums->sets, 1 / (r / sums->sets + 1.0), runner->pixels);
    return EC_OK;
}

static ec_result denoise(ec_cost_runner *runner, ec_film *film, ec_error *err)
{
    ec_denoised came = {0};
    EC_TRY(ec_denoise(film, EC_DENOISER_AUTO, &runner->study->cl->info, &came, err));
    if (!came.why_not) runner->denoise_seconds += came.seconds, runner->denoised++;
    if (film->clean.best) memcpy(runner->mean, film->clean.best, runner->pixels * 3 * sizeof(float));
    else ec_film_resolve(film, runner->mean, NULL); /* too few samples to denoise */
    return EC_OK;
}

static ec_result take_all(ec_cost_runner *runner, ec_film *film, ec_session_batch *room, uint32_t samples, double *seconds, ec_error *err)
{
    const uint32_t count = samples < film->replicates ? samples : film->replicates;
    uint32_t before;
    ec_film_part part = {.count = ec_schedule_find(film->replicates, samples, &before)};
    ec_result result = ec_sums_create(&part.sums, film->replicates, ec_film_sets(film, 0), runner->pixels) ? EC_OK : ec_fail(err, "out of memory for a picture to denoise");
    for (uint32_t r = 0; result == EC_OK && r < count && !runner->stopped; r++) {
        ec_session_batch batch = *room;
        batch.replicate = r;
        batch.samples = samples / count + (r < samples % count);
        result = take_replicate(runner, &part.sums, &batch, err);
        *seconds += batch.seconds;
    }
    runner->seconds_per_sample = *seconds / ((double)samples * (double)runner->pixels);
    if (result == EC_OK && !runner->stopped) result = ec_film_insert(film, &part, err);
    if (result == EC_OK && !runner->stopped) result = denoise(runner, film, err);
    ec_film_part_free(&part);
    return result;
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
