/* A film made, filled and shown as a picture. */
#include "film/film.h"

#include <stdlib.h>
#include <string.h>

#include "film/threads.h"

static uint64_t pixels_of(const ec_film *film) { return (uint64_t)film->width * film->height; }

ec_result ec_film_create(ec_film *film, uint32_t width, uint32_t height, uint32_t replicates, ec_error *err)
{
    *film = (ec_film){.width = width, .height = height, .replicates = replicates};
    if (pixels_of(film) == 0) return ec_fail(err, "an image of %u x %u pixels is empty; ask for at least 1x1", width, height);
    return EC_OK;
}

void ec_film_set_clean(ec_film *film, ec_film_clean clean)
{
    free(film->clean.denoised);
    free(film->clean.best);
    free(film->clean.error);
    film->clean = clean;
}

static void free_room(ec_film_room *room)
{
    ec_sums_destroy(&room->sums);
    free(room->aov);
    free(room->aov_even);
}

void ec_film_destroy(ec_film *film)
{
    ec_film_set_clean(film, (ec_film_clean){0});
    free_room(&film->room);
    for (uint32_t i = 0; i < film->part_count; i++) ec_film_part_free(&film->parts[i]);
    free(film->parts);
    free(film->aov);
    free(film->aov_even);
    free(film->unsampled);
    free(film->counts);
    free(film->rare);
    for (uint32_t k = 0; film->layer_films && k < film->layers.count; k++) ec_film_destroy(&film->layer_films[k]);
    free(film->layer_films);
    if (film->light) ec_film_destroy(film->light);
    free(film->light);
    ec_matte_free(&film->matte);
    *film = (ec_film){0};
}

ec_result ec_film_set_rare(ec_film *film, const ec_rare *rare, ec_error *err)
{
    free(film->rare);
    film->rare = rare && rare->count ? malloc(sizeof *rare) : NULL;
    if (film->rare) *film->rare = *rare;
    return film->rare || !rare || !rare->count ? EC_OK : ec_fail(err, "out of memory for what is foretold of rare paths");
}

ec_result ec_film_part_light(ec_film *film, ec_error *err)
{
    film->light = calloc(1, sizeof *film->light);
    return film->light ? ec_film_create(film->light, film->width, film->height, film->replicates, err) : ec_fail(err, "out of memory for a film");
}

double ec_film_samples_of_all(const ec_film *film)
{
    double samples = 0;
    for (uint32_t r = 0; r < film->replicates; r++) samples += film->samples[r];
    return samples;
}

double ec_film_samples(const ec_film *film, uint64_t p)
{
    return film->counts ? (double)film->counts[p] * film->replicates : ec_film_samples_of_all(film);
}

static ec_result start_counting(ec_film *film, ec_error *err)
{
    const uint64_t pixels = pixels_of(film);
    if (film->counts) return EC_OK;
    if (film->part_count != 1 || film->parts[0].batch || film->batch_count % film->replicates)
        return ec_fail(err, "pixels can only go on by themselves after a whole round");
    film->counts = malloc(pixels * sizeof *film->counts);
    if (!film->counts) return ec_fail(err, "out of memory for the sample counts of %llu pixels", (unsigned long long)pixels);
    for (uint64_t p = 0; p < pixels; p++) film->counts[p] = (uint32_t)film->samples[0];
    return EC_OK;
}

/* Entries [first, end), which are all that there are of their pixels. */
static uint64_t add_entries(ec_film *film, const float *batch, const uint32_t *places, uint64_t first, uint64_t end, uint32_t samples)
{
    uint64_t invalid = 0;
    for (uint64_t i = first; i < end; i++) {
        const uint32_t replicate = (uint32_t)(i % film->replicates);
        const double share = samples / ((double)film->counts[places[i]] + samples);
        invalid += ec_sums_add_pixel(&film->parts[0].sums, batch + EC_BATCH_FIELDS * i, replicate, share, places[i]);
        if (replicate == film->replicates - 1) film->counts[places[i]] += samples;
    }
    return invalid;
}

/* Where piece k of so many begins: not within a pixel. */
static uint64_t piece_start(const uint32_t *places, uint64_t count, uint64_t k, uint64_t pieces)
{
    uint64_t first = count * k / pieces;
    while (first && first < count && places[first] == places[first - 1]) first++;
    return first;
}

ec_result ec_film_add_some(ec_film *film, const float *batch, const uint32_t *places, uint32_t count, uint32_t samples, ec_error *err)
{
    enum { PIECES = 64 };
    uint64_t invalid = 0;
    EC_TRY(start_counting(film, err));
#pragma omp parallel for reduction(+ : invalid) if (ec_film_is_many(count))
    for (uint64_t k = 0; k < PIECES; k++)
        invalid += add_entries(film, batch, places, piece_start(places, count, k, PIECES), piece_start(places, count, k + 1, PIECES), samples);
    film->invalid_count += invalid;
    return EC_OK;
}

/* Samples that features are of, in every step-th replicate from r on. */
static double feature_samples(const ec_film *film, uint32_t r, uint32_t step)
{
    const uint32_t end = film->aov_batches, last = end ? (end - 1) % film->replicates : 0;
    const bool is_cut = film->cut && end == ec_film_end(film) && last % step == r;
    uint64_t samples = 0;
    for (; r < film->replicates; r += step) samples += ec_schedule_share(film->replicates, r, 0, end);
    return (double)samples - (is_cut ? film->cut : 0);
}

static bool make_features(const ec_film *film, float **mean)
{
    if (!*mean) *mean = calloc(pixels_of(film), EC_FILM_FEATURES * sizeof **mean);
    return *mean != NULL;
}

/* Into *mean; zeros until then, which may be there already. */
static ec_result average(const ec_film *film, float **mean, float **room, const float *features, uint64_t pixels, double before, double own,
                         ec_error *err)
{
    const uint64_t values = pixels * EC_FILM_FEATURES;
    if (!*mean && !make_features(film, room)) return ec_fail(err, "out of memory for the first-hit features");
    if (!*mean) *mean = *room, *room = NULL;
    float *to = *mean;
#pragma omp parallel for if (ec_film_is_many(pixels))
    for (uint64_t i = 0; i < values; i++) to[i] = before == 0 ? features[i] : (float)(to[i] + ((double)features[i] - to[i]) * (own / (own + before)));
    return EC_OK;
}

ec_result ec_film_add_features(ec_film *film, const float *features, uint64_t pixels, uint32_t cut, bool by_halves, ec_error *err)
{
    const ec_batch_range batch = ec_schedule_batch(film->replicates, film->aov_batches);
    const double own = batch.samples - cut;
    if (batch.replicate % 2 == 0 && (film->aov_batches ? film->aov_even != NULL : by_halves))
        EC_TRY(average(film, &film->aov_even, &film->room.aov_even, features, pixels, feature_samples(film, 0, 2), own, err));
    EC_TRY(average(film, &film->aov, &film->room.aov, features, pixels, feature_samples(film, 0, 1), own, err));
    film->aov_batches++;
    return EC_OK;
}

/* Zeros, which are what is there. NULL: there is no memory, as is said when it is needed. */
static void touch(float *values, uint64_t from, uint64_t to)
{
    enum { PAGE = 1024 }; /* values; no page is smaller */
    if (!values) return;
#pragma omp parallel for
    for (uint64_t page = from / PAGE; page < (to + PAGE - 1) / PAGE; page++) values[page * PAGE < from ? from : page * PAGE] = 0;
}

void ec_film_make_room(ec_film *film, uint64_t from, uint64_t to, bool with_features, bool by_halves)
{
    const uint64_t values = EC_FILM_FEATURES;
    ec_film_room *room = &film->room;
    if (!room->sums.mean) ec_sums_create(&room->sums, film->replicates, pixels_of(film));
    touch(room->sums.mean, 3 * from, 3 * to);
    touch(room->sums.tail, 3 * from, 3 * to);
    if (with_features && make_features(film, &room->aov)) touch(room->aov, values * from, values * to);
    if (with_features && by_halves && make_features(film, &room->aov_even)) touch(room->aov_even, values * from, values * to);
}

/* With n samples in all, of them e in even replicates, the sum of the odd ones is n all - e even. */
void ec_film_features_of(const ec_film *film, uint32_t half, uint64_t first, uint64_t count, float *out)
{
    const float *all = film->aov + EC_FILM_FEATURES * first, *even = film->aov_even ? film->aov_even + EC_FILM_FEATURES * first : NULL;
    const double odd = feature_samples(film, 1, 2), share = odd > 0 ? feature_samples(film, 0, 2) / odd : 0;
    const uint64_t values = count * EC_FILM_FEATURES;
    if (!even || half == 0) memcpy(out, even ? even : all, values * sizeof *out);
    else for (uint64_t i = 0; i < values; i++) out[i] = (float)(all[i] + ((double)all[i] - even[i]) * share);
}

ec_result ec_film_create_like(ec_film *film, const ec_film *like, uint32_t rows, ec_error *err)
{
    const uint64_t pixels = (uint64_t)like->width * rows;
    EC_TRY(ec_film_create(film, like->width, rows, like->replicates, err));
    film->batch_count = like->batch_count;
    film->cut = like->cut;
    film->limit = like->limit;
    film->aov_batches = like->aov_batches;
    memcpy(film->samples, like->samples, sizeof film->samples);
    EC_TRY(ec_film_set_rare(film, like->rare, err));
    film->parts = calloc((size_t)like->part_count + 1, sizeof *film->parts);
    bool made = film->parts != NULL;
    for (uint32_t i = 0; made && i < like->part_count; i++) {
        film->parts[i] = like->parts[i];
        film->parts[i].sums = (ec_sums){0};
        film->parts[i].batch = like->parts[i].batch ? malloc(pixels * EC_BATCH_FIELDS * sizeof(float)) : NULL;
        made = film->parts[i].batch || ec_sums_create(&film->parts[i].sums, like->replicates, pixels);
        film->part_count++;
    }
    if (like->aov) made = made && (film->aov = malloc(pixels * EC_FILM_FEATURES * sizeof *film->aov));
    if (like->aov_even) made = made && (film->aov_even = malloc(pixels * EC_FILM_FEATURES * sizeof *film->aov_even));
    if (like->counts) made = made && (film->counts = malloc(pixels * sizeof *film->counts));
    film->layers = like->layers;
    if (like->layer_films) made = made && (film->layer_films = calloc(like->layers.count, sizeof *film->layer_films));
    if (like->light) made = made && (film->light = calloc(1, sizeof *film->light));
    if (!made) return ec_fail(err, "out of memory for rows of a picture");
    if (like->light) EC_TRY(ec_film_create_like(film->light, like->light, rows, err));
    for (uint32_t k = 0; like->layer_films && k < like->layers.count; k++)
        EC_TRY(ec_film_create_like(&film->layer_films[k], &like->layer_films[k], rows, err));
    return EC_OK;
}

void ec_film_copy_rows(ec_film *film, uint32_t to, const ec_film *from, uint32_t first, uint32_t rows)
{
    const uint64_t pixels = (uint64_t)rows * film->width, there = (uint64_t)first * film->width, here = (uint64_t)to * film->width;
    for (uint32_t i = 0; i < film->part_count; i++) {
        const ec_film_part *part = &from->parts[i];
        if (part->batch) {
            memcpy(film->parts[i].batch + EC_BATCH_FIELDS * here, part->batch + EC_BATCH_FIELDS * there, pixels * EC_BATCH_FIELDS * sizeof(float));
            continue;
        }
        const ec_sums own = ec_sums_from(&film->parts[i].sums, here), other = ec_sums_from(&part->sums, there);
        ec_sums_copy(&own, &other, pixels);
    }
    if (film->aov && from->aov)
        memcpy(film->aov + EC_FILM_FEATURES * here, from->aov + EC_FILM_FEATURES * there, pixels * EC_FILM_FEATURES * sizeof *film->aov);
    if (film->aov_even && from->aov_even)
        memcpy(film->aov_even + EC_FILM_FEATURES * here, from->aov_even + EC_FILM_FEATURES * there, pixels * EC_FILM_FEATURES * sizeof *film->aov_even);
    if (film->counts && from->counts) memcpy(film->counts + here, from->counts + there, pixels * sizeof *film->counts);
    for (uint32_t k = 0; film->layer_films && k < film->layers.count; k++)
        ec_film_copy_rows(&film->layer_films[k], to, &from->layer_films[k], first, rows);
    if (film->light) ec_film_copy_rows(film->light, to, from->light, first, rows);
}
