#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "film/channels.h"
#include "film/layer_films.h"
#include "image/exr_header.h"
#include "store/layout.h"

enum { CHANNELS_MOST = EC_SUM_CHANNELS }; /* EC_BATCH_CHANNELS are fewer */

/* Reads a part. Channels describe where values are written from, and so also where they are read to: the memory is the film's own. */
static ec_result fill(ec_exr_file *file, const char *part, const ec_channel *channels, uint32_t count, ec_error *err)
{
    ec_exr_room rooms[CHANNELS_MOST];
    for (uint32_t i = 0; i < count; i++)
        rooms[i] = (ec_exr_room){channels[i].name, (void *)(uintptr_t)channels[i].data, channels[i].stride};
    return ec_exr_fill(file, part, rooms, count, err);
}

static ec_result no_memory(const char *path, ec_error *err)
{
    return ec_fail(err, "cannot read '%s': its film does not fit into memory", path);
}

/* Checks sums from a file. Sums and features are averages of finite floats (film/sums.h sees to it); tails are sums of numbers from 0 to 1, of so
 * many samples. */
static ec_result check_sums(const char *path, const ec_sums *sums, uint64_t pixels, ec_error *err)
{
    bool all = true;
    for (uint64_t i = 0; i < 3ull * sums->replicates * pixels; i++) all &= fabsf(sums->mean[i]) <= FLT_MAX; /* false for NaN */
    for (uint64_t i = 0; i < EC_FILM_FEATURES * sums->sets * pixels; i++) all &= fabsf(sums->features[i]) <= FLT_MAX;
    for (uint64_t i = 0; i < 3 * pixels; i++) all &= sums->tail[i] >= 0 && sums->tail[i] <= FLT_MAX;
    if (all) return EC_OK;
    return ec_fail(err, "cannot read '%s': its sums are out of range; use an older file or render it again", path);
}

/* Reads a batch. Features come along if the film wants them of batches from `first` on and the file has them; else *features stays NULL. */
static ec_result read_batch(ec_exr_file *file, const char *path, const char *part, const ec_film *film, uint64_t first, float **batch, float **features,
                            ec_error *err)
{
    ec_channel channels[EC_BATCH_CHANNELS];
    const uint64_t pixels = (uint64_t)film->width * film->height;
    const bool has_features = ec_film_sets(film, first) > 0 && ec_exr_has(file, part, ec_channel_name_of(EC_PLANE_FEATURES, 0));
    *batch = calloc(pixels * EC_BATCH_FIELDS, sizeof **batch); /* it goes by a const pointer, as what is written does */
    if (has_features) *features = calloc(pixels * EC_FILM_FEATURES, sizeof **features);
    if (!*batch || (has_features && !*features)) return no_memory(path, err);
    return fill(file, part, channels, ec_batch_channels(*batch, *features, channels), err);
}

static ec_result read_part(ec_exr_file *file, const char *path, uint32_t layer, uint32_t index, ec_film_part *part, ec_film *film, ec_error *err)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    char name[EC_PART_NAME];
    ec_channel channels[CHANNELS_MOST];
    ec_channel_name names[CHANNELS_MOST];
    ec_sum_part_name(layer, index, name);
    if (ec_film_part_is_batch(part->first, part->count)) {
        EC_TRY(read_batch(file, path, name, film, part->first, &part->batch, &part->features, err));
    } else {
        if (!ec_sums_create(&part->sums, film->replicates, ec_film_sets(film, part->first), pixels)) return no_memory(path, err);
        EC_TRY(fill(file, name, channels, ec_sum_channels(&part->sums, film->counts, names, channels), err));
        EC_TRY(check_sums(path, &part->sums, pixels, err));
    }
    return ec_film_insert(film, part, err);
}

static ec_result no_sense(const char *path, ec_error *err)
{
    return ec_fail(err, "cannot read '%s': its parts do not match its batches; use an older file", path);
}

static ec_result check_counts(const char *path, const ec_film *film, ec_error *err)
{
    const uint64_t pixels = film->counts ? (uint64_t)film->width * film->height : 0;
    if (pixels && film->batch_count % film->replicates) return no_sense(path, err);
    for (uint64_t p = 0; p < pixels; p++)
        if (film->counts[p] < film->samples[0])
            return ec_fail(err, "cannot read '%s': some pixels have fewer samples than each must have; use an older file", path);
    return EC_OK;
}

static ec_result read_each(ec_exr_file *file, const char *path, uint32_t layer, const ec_film_part *parts, uint32_t count, ec_film *film, ec_error *err)
{
    for (uint32_t i = 0; i < count; i++) {
        ec_film_part part = {.first = parts[i].first, .count = parts[i].count};
        ec_result result = read_part(file, path, layer, i, &part, film, err);
        if (result == EC_OK) continue;
        ec_film_part_free(&part);
        return result;
    }
    return EC_OK;
}

static ec_result read_parts(ec_exr_file *file, const char *path, const ec_state_film *state, uint32_t layer, ec_film *film, ec_error *err)
{
    if (state->has_counts && !(film->counts = calloc((uint64_t)film->width * film->height, sizeof *film->counts))) return no_memory(path, err);
    EC_TRY(read_each(file, path, layer, state->parts, state->part_count, film, err));
    if (film->batch_count != state->batch_count) return no_sense(path, err);
    if (state->cut && state->cut >= ec_schedule_batch(film->replicates, ec_film_end(film) - 1).samples) return no_sense(path, err);
    if (state->cut) ec_film_set_cut(film, state->cut);
    return check_counts(path, film, err);
}

static ec_result read_light(ec_exr_file *file, const char *path, const ec_state_film *state, ec_film *film, ec_error *err)
{
    if (!state->has_light) return EC_OK;
    EC_TRY(ec_film_part_light(film, err));
    return read_each(file, path, state->layers.count + 1, state->light_parts, state->light_part_count, film->light, err);
}

static ec_result read_layers(ec_exr_file *file, const char *path, const ec_state_film *state, ec_film *film, ec_error *err)
{
    EC_TRY(ec_film_set_layers(film, &state->layers, err));
    for (uint32_t k = 0; k < film->layers.count; k++) EC_TRY(read_parts(file, path, state, k + 1, &film->layer_films[k], err));
    return EC_OK;
}

static ec_result read_weights(ec_exr_file *file, const char *path, ec_stored *s, ec_error *err)
{
    float *weight = s->past.allotment.weight = calloc((uint64_t)s->film.width * s->film.height, sizeof *weight);
    if (!weight) return no_memory(path, err);
    return ec_exr_fill(file, "allotment", &(ec_exr_room){"weight", weight, 1}, 1, err);
}

static ec_result read_under_way(ec_exr_file *file, const char *path, ec_stored *s, ec_error *err)
{
    float *batch, *features = NULL;
    ec_result result = read_batch(file, path, "under way", &s->film, s->past.next, &batch, &features, err);
    s->past.batch = batch;
    s->past.features = features;
    return result;
}

ec_result ec_store_read(const char *path, ec_stored *s, ec_error *err)
{
    ec_exr_file *file;
    ec_state_film state = {0};
    uint32_t width, height;
    *s = (ec_stored){0};
    EC_TRY(ec_exr_open(path, &file, &width, &height, err));
    ec_result result;
    const char *text = ec_exr_text(file, "eclat.state");
    if (!text)
        result = ec_fail(err, "cannot read '%s': it is not a checkpoint or slice of eclat; give the file that --checkpoint or --samples wrote",
                         path);
    else result = ec_state_read(text, path, s, &state, err);
    if (result == EC_OK) result = ec_film_create(&s->film, width, height, state.replicates, err);
    ec_film_want_features(&s->film, state.feature_sets, state.feature_end);
    state.rare.width = width;
    state.rare.height = height;
    if (result == EC_OK) result = ec_film_set_rare(&s->film, &state.rare, err);
    if (result == EC_OK) result = read_parts(file, path, &state, 0, &s->film, err);
    if (result == EC_OK) result = read_layers(file, path, &state, &s->film, err);
    if (result == EC_OK) result = read_light(file, path, &state, &s->film, err);
    if (result == EC_OK && state.has_weights) result = read_weights(file, path, s, err);
    if (result == EC_OK && s->past.under_way) result = read_under_way(file, path, s, err);
    if (result == EC_OK) s->film.invalid_count = state.invalid_count, s->film.limit = state.limit;
    free(state.parts);
    free(state.light_parts);
    ec_exr_close(file);
    if (result != EC_OK) ec_stored_free(s);
    return result;
}

bool ec_store_peek(const char *path, ec_stored *s, uint32_t *first)
{
    ec_state_film film = {0};
    *s = (ec_stored){0};
    char *text = ec_exr_whole_text(path, "eclat.state");
    bool can_be_read = text && ec_state_read(text, path, s, &film, NULL) == EC_OK;
    *first = can_be_read && film.part_count ? film.parts[0].first : 0;
    if (can_be_read) s->film.replicates = film.replicates, s->film.batch_count = film.batch_count;
    free(text);
    free(film.parts);
    free(film.light_parts);
    return can_be_read;
}

void ec_stored_free(ec_stored *s)
{
    for (int i = 0; i < s->job.argc; i++) free(s->job.argv[i]);
    free(s->job.argv);
    free((char *)(uintptr_t)s->job.folder);
    free((char *)(uintptr_t)s->job.device);
    free(s->past.allotment.weight);
    free((float *)(uintptr_t)s->past.batch);
    free((float *)(uintptr_t)s->past.features);
    ec_film_destroy(&s->film);
    *s = (ec_stored){0};
}
