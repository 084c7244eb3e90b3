#include <float.h>
#include <stdlib.h>

#include "image/exr_header.h"
#include "store/layout.h"

enum { CHANNELS_MOST = EC_SUM_CHANNELS };

/* The channels as they are written are also where they are read to: the memory is the film's own. */
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

static bool are_between(double low, double high, const double *values, uint64_t count)
{
    bool all = true;
    for (uint64_t i = 0; i < count; i++) all &= values[i] >= low && values[i] <= high; /* NaN is not */
    return all;
}

/* Batches are finite floats (ec_film_add_batch sees to it), so this is what can come of them. Third and fourth moments may leave the range. */
static ec_result check_sums(const char *path, const ec_moments *sums, uint64_t pixels, ec_error *err)
{
    const double most = FLT_MAX, square = most * most * UINT32_MAX;
    if (are_between(-most, most, sums->mean, 3 * pixels) && are_between(0, square, sums->m2, 4 * pixels)) return EC_OK;
    return ec_fail(err, "cannot read '%s': sums in it are none of any samples; take an older file or render it again", path);
}

static ec_result read_batch(ec_exr_file *file, const char *path, const char *part, uint64_t pixels, float **batch, ec_error *err)
{
    ec_channel channels[3];
    *batch = calloc(pixels * 3, sizeof **batch); /* it goes by a const pointer, as what is written does */
    if (!*batch) return no_memory(path, err);
    return fill(file, part, channels, ec_batch_channels(*batch, channels), err);
}

static ec_result read_part(ec_exr_file *file, const char *path, uint32_t index, ec_film_part *part, ec_film *film, ec_error *err)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    char name[24];
    ec_channel channels[CHANNELS_MOST];
    ec_sum_part_name(index, name);
    if (ec_film_part_is_batch(part->first, part->count)) {
        EC_TRY(read_batch(file, path, name, pixels, &part->batch, err));
    } else {
        if (!ec_moments_create(&part->sums, pixels)) return no_memory(path, err);
        EC_TRY(fill(file, name, channels, ec_sum_channels(&part->sums, NULL, channels), err));
        EC_TRY(check_sums(path, &part->sums, pixels, err));
    }
    return ec_film_insert(film, part, err);
}

static ec_result read_parts(ec_exr_file *file, const char *path, const ec_state_film *state, ec_film *film, ec_error *err)
{
    for (uint32_t i = 0; i < state->part_count; i++) {
        ec_result result = read_part(file, path, i, &state->parts[i], film, err);
        if (result == EC_OK) continue;
        ec_film_part_free(&state->parts[i]);
        return result;
    }
    if (film->batch_count == state->batch_count) return EC_OK;
    return ec_fail(err, "cannot read '%s': its parts are not of its batches; take an older file", path);
}

static ec_result read_weights(ec_exr_file *file, const char *path, ec_stored *s, ec_error *err)
{
    float *weight = s->past.allotment.weight = calloc((uint64_t)s->film.width * s->film.height, sizeof *weight);
    if (!weight) return no_memory(path, err);
    return ec_exr_fill(file, "allotment", &(ec_exr_room){"weight", weight, 1}, 1, err);
}

static ec_result read_under_way(ec_exr_file *file, const char *path, ec_stored *s, ec_error *err)
{
    float *batch;
    ec_result result = read_batch(file, path, "under way", (uint64_t)s->film.width * s->film.height, &batch, err);
    s->past.batch = batch;
    return result;
}

static ec_result read_counted(ec_exr_file *file, const char *path, const ec_state_film *state, ec_film *film, ec_error *err)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    char name[24];
    ec_channel channels[CHANNELS_MOST];
    film->counts = calloc(pixels, sizeof *film->counts);
    if (!film->counts) return no_memory(path, err);
    const ec_moments shown = {film->mean, film->m2, film->m34, film->largest};
    ec_sum_part_name(0, name);
    EC_TRY(fill(file, name, channels, ec_sum_channels(&shown, film->counts, channels), err));
    EC_TRY(check_sums(path, &shown, pixels, err));
    film->batch_count = state->batch_count;
    for (uint64_t p = 0; p < pixels; p++)
        if (film->counts[p] < film->batch_count)
            return ec_fail(err, "cannot read '%s': pixels have fewer batches than all of them; take an older file", path);
    return EC_OK;
}

static ec_result read_features(ec_exr_file *file, const char *path, ec_film *film, ec_error *err)
{
    ec_exr_room rooms[EC_FEATURE_CHANNELS];
    if (!ec_exr_has(file, "picture", ec_feature_channels[0])) return EC_OK;
    film->aov = malloc((uint64_t)film->width * film->height * EC_FEATURE_CHANNELS * sizeof(float));
    if (!film->aov) return no_memory(path, err);
    for (uint32_t i = 0; i < EC_FEATURE_CHANNELS; i++)
        rooms[i] = (ec_exr_room){ec_feature_channels[i], film->aov + i, EC_FEATURE_CHANNELS};
    return ec_exr_fill(file, "picture", rooms, EC_FEATURE_CHANNELS, err);
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
        result = ec_fail(err, "cannot read '%s': it is no checkpoint or slice of eclat's; give the file that --checkpoint or --samples wrote",
                         path);
    else result = ec_state_read(text, path, s, &state, err);
    if (result == EC_OK) result = ec_film_create(&s->film, width, height, state.samples_per_batch, err);
    if (result == EC_OK)
        result = state.has_counts ? read_counted(file, path, &state, &s->film, err)
                                  : read_parts(file, path, &state, &s->film, err);
    if (result == EC_OK && state.has_weights) result = read_weights(file, path, s, err);
    if (result == EC_OK && s->past.under_way) result = read_under_way(file, path, s, err);
    if (result == EC_OK) s->film.invalid_count = state.invalid_count;
    if (result == EC_OK) result = read_features(file, path, &s->film, err);
    free(state.parts);
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
    if (can_be_read) s->film.samples_per_batch = film.samples_per_batch, s->film.batch_count = film.batch_count;
    free(text);
    free(film.parts);
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
    ec_film_destroy(&s->film);
    *s = (ec_stored){0};
}
