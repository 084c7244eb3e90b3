/* The reference with which every rung is compared: the whole scene, rendered as well as eclat can, or a file. */
#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "cost/cost_internal.h"
#include "film/channels.h"
#include "film/resolve.h"
#include "image/image.h"

static ec_result allocate(ec_cost_reference *r, uint64_t pixels, ec_error *err)
{
    r->rgb = malloc(pixels * 3 * sizeof *r->rgb);
    r->luminance = malloc(pixels * sizeof *r->luminance);
    r->variance = calloc(pixels, sizeof *r->variance);
    return r->rgb && r->luminance && r->variance
               ? EC_OK
               : ec_fail(err, "out of memory for a reference of %llu pixels; ask for a smaller --size",
                         (unsigned long long)pixels);
}

static ec_result finish(ec_cost_reference *r, uint64_t pixels, ec_error *err)
{
    double sum = 0, noise = 0;
    for (uint64_t p = 0; p < pixels; p++) {
        r->luminance[p] = ec_luminance((double[3]){r->rgb[3 * p], r->rgb[3 * p + 1], r->rgb[3 * p + 2]});
        sum += r->luminance[p] / (double)pixels;
        noise += r->variance[p] / (double)pixels;
    }
    r->mean_luminance = sum;
    r->noise = noise / (sum * sum);
    if (!(sum > 0)) return ec_fail(err, "the reference is black: errors relative to it mean nothing; check --camera and --env");
    return EC_OK;
}

/* Takes batches as a render does (film/schedule.h), from a seed that no rung has, until the deadline. */
static ec_result take_batches(ec_cost_runner *runner, ec_film *film, double deadline, ec_error *err)
{
    const uint32_t seed = ec_session_seed(runner->study->options.seed, EC_COST_STREAM_REFERENCE, 0);
    float *values = malloc(runner->pixels * EC_BATCH_FIELDS * sizeof *values);
    ec_result result = values ? EC_OK : ec_fail(err, "out of memory for a batch");
    while (result == EC_OK && ec_cost_go_on(runner->study)) {
        const ec_batch_range range = ec_schedule_batch(film->replicates, film->batch_count);
        ec_session_batch batch = {.seed = seed, .replicate = range.replicate, .first = (uint32_t)range.first, .samples = range.samples,
                                  .go_on = ec_cost_go_on, .user = runner->study, .batch = values};
        result = ec_session_take(runner->session, &batch, err);
        if (result == EC_OK && !batch.complete) break;
        if (result == EC_OK) result = ec_film_add(film, film->batch_count, values, err);
        if (film->batch_count >= film->replicates && ec_now() + 0.5 * batch.seconds > deadline) break;
    }
    free(values);
    return result;
}

ec_result ec_cost_reference_of(const ec_film *film, ec_cost_reference *r, ec_error *err)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
    ec_pixel piece[EC_PIXELS];
    EC_TRY(allocate(r, pixels, err));
    ec_film_resolve(film, r->rgb, NULL);
    for (uint64_t first = 0; first < pixels; first += EC_PIXELS) {
        const uint64_t count = pixels - first < EC_PIXELS ? pixels - first : EC_PIXELS;
        ec_film_look(film, first, count, piece);
        for (uint64_t i = 0; i < count; i++) r->variance[first + i] = ec_pixel_se2(&piece[i], 3);
    }
    r->has_variance = true;
    r->samples_per_pixel = (uint64_t)ec_film_samples_of_all(film);
    return finish(r, pixels, err);
}

static ec_result predict(ec_cost_runner *runner, ec_film *film, ec_error *err)
{
    ec_rare rare;
    EC_TRY(ec_session_predict(runner->session, &rare, err));
    return ec_film_set_rare(film, &rare, err);
}

/* Warns of light that the reference has not met: no rung would meet it either. */
static void warn_of_rare_paths(const ec_cost_study *study, const ec_film *film)
{
    const ec_film_error e = ec_film_estimate_error(film);
    char way[EC_RARE_WAY];
    if (!e.is_open) return;
    ec_rare_way(e.through, e.light, way, sizeof way);
    ec_warn(study->log, "the reference has no bound of its error: rare bright paths (%s) are hardly met yet, and all errors lack their light", way);
}

ec_result ec_cost_reference_render(ec_cost_study *study, double deadline, ec_error *err)
{
    const ec_render_options *o = &study->options;
    ec_cost_reference *r = &study->reference;
    ec_cost_rung rung = {.options = *o};
    ec_cost_runner runner = {0};
    ec_render_stats stats;
    ec_film film = {0};
    ec_result result = ec_cost_runner_open(study, &rung, &runner, &stats, &r->setup_seconds, err);
    double start = ec_now();
    if (result == EC_OK && !runner.stopped) result = ec_film_create(&film, o->width, o->height, ec_render_replicates(o), err);
    if (result == EC_OK && film.width) result = predict(&runner, &film, err);
    if (result == EC_OK && film.width) result = take_batches(&runner, &film, deadline, err);
    if (result == EC_OK && film.batch_count < 2) study->interrupted = true; /* no comparison is possible */
    if (result == EC_OK && film.batch_count >= 2) result = ec_cost_reference_of(&film, r, err);
    if (result == EC_OK && film.batch_count >= 2) warn_of_rare_paths(study, &film);
    r->seconds = ec_now() - start;
    ec_film_destroy(&film);
    ec_cost_runner_close(&runner);
    return result;
}

/* Reads the reference. If it has no standard error of luminance, the channels' noise is taken as fully correlated, which overestimates it. */
static ec_result take_exr(const ec_exr *exr, ec_cost_study *study, ec_error *err)
{
    ec_cost_reference *r = &study->reference;
    uint64_t pixels = (uint64_t)exr->width * exr->height;
    if (exr->width != study->options.width || exr->height != study->options.height)
        return ec_fail(err, "--reference '%s' is %ux%u pixels and the study %ux%u; leave out --size or give the reference's", r->source,
                       exr->width, exr->height, study->options.width, study->options.height);
    const float *rgb[3], *se[3], *se_y = ec_exr_plane(exr, ec_channel_name_of(EC_PLANE_STDERR_Y, 0)),
                *samples = ec_exr_plane(exr, ec_channel_name_of(EC_PLANE_SAMPLES, 0));
    for (int c = 0; c < 3; c++) {
        rgb[c] = ec_exr_plane(exr, ec_channel_name_of(EC_PLANE_RGB, (uint32_t)c));
        se[c] = ec_exr_plane(exr, ec_channel_name_of(EC_PLANE_STDERR, (uint32_t)c));
        if (!rgb[c]) return ec_fail(err, "--reference '%s' has no channel %s", r->source, ec_channel_name_of(EC_PLANE_RGB, (uint32_t)c));
    }
    EC_TRY(allocate(r, pixels, err));
    r->has_variance = se_y || (se[0] && se[1] && se[2]);
    r->samples_per_pixel = samples ? (uint64_t)samples[0] : 0;
    for (uint64_t p = 0; p < pixels; p++) {
        for (int c = 0; c < 3; c++) r->rgb[3 * p + c] = isfinite(rgb[c][p]) ? rgb[c][p] : 0.0f;
        double s = se_y ? se_y[p] : r->has_variance ? ec_luminance((double[3]){se[0][p], se[1][p], se[2][p]}) : 0;
        r->variance[p] = isfinite(s) ? s * s : 0;
    }
    return finish(r, pixels, err);
}

ec_result ec_cost_reference_read(ec_cost_study *study, ec_error *err)
{
    ec_exr exr = {0};
    double start = ec_now();
    study->reference.source = study->reference_file;
    EC_TRY(ec_exr_read(study->reference_file, &exr, err));
    ec_result result = take_exr(&exr, study, err);
    ec_exr_free(&exr);
    study->reference.seconds = ec_now() - start;
    return result;
}

void ec_cost_reference_free(ec_cost_reference *r)
{
    free(r->rgb);
    free(r->luminance);
    free(r->variance);
    *r = (ec_cost_reference){0};
}
