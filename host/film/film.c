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

void ec_film_want_features(ec_film *film, uint32_t sets, uint32_t end)
{
    film->feature_sets = sets;
    film->feature_end = sets ? end : 0;
}

void ec_film_destroy(ec_film *film)
{
    ec_film_set_clean(film, (ec_film_clean){0});
    ec_sums_destroy(&film->room);
    for (uint32_t i = 0; i < film->part_count; i++) ec_film_part_free(&film->parts[i]);
    free(film->parts);
    free(film->shadow);
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
    return film->rare || !rare || !rare->count ? EC_OK : ec_fail(err, "out of memory for what is predicted of rare paths");
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
        return ec_fail(err, "internal error: pixels can get samples of their own only after a whole round");
    film->counts = malloc(pixels * sizeof *film->counts);
    if (!film->counts) return ec_fail(err, "out of memory for the sample counts of %llu pixels", (unsigned long long)pixels);
    for (uint64_t p = 0; p < pixels; p++) film->counts[p] = (uint32_t)film->samples[0];
    return EC_OK;
}

/* Adds an entry's features. All replicates of the set have counts[place] samples each, and those before this one `samples` more. */
static void add_entry_features(ec_film *film, const float *features, uint32_t place, uint32_t replicate, uint32_t samples)
{
    const uint32_t sets = film->feature_sets, set = replicate % sets;
    const double all = (film->replicates - set + sets - 1) / sets, before = film->counts[place] * all + (double)samples * (replicate / sets);
    ec_sums_add_feature(&film->parts[0].sums, features, set, samples / (before + samples), place);
}

/* Adds entries [first, end), which are all entries of their pixels. */
static uint64_t add_entries(ec_film *film, const float *batch, const float *features, const uint32_t *places, uint64_t first, uint64_t end,
                            uint32_t samples)
{
    uint64_t invalid = 0;
    for (uint64_t i = first; i < end; i++) {
        const uint32_t replicate = (uint32_t)(i % film->replicates);
        const double share = samples / ((double)film->counts[places[i]] + samples);
        invalid += ec_sums_add_pixel(&film->parts[0].sums, batch + EC_BATCH_FIELDS * i, replicate, share, places[i]);
        if (features) add_entry_features(film, features + EC_FILM_FEATURES * i, places[i], replicate, samples);
        if (replicate == film->replicates - 1) film->counts[places[i]] += samples;
    }
    return invalid;
}

/* Returns where piece k of `pieces` begins, never within a pixel. */
static uint64_t piece_start(const uint32_t *places, uint64_t count, uint64_t k, uint64_t pieces)
{
    uint64_t first = count * k / pieces;
    while (first && first < count && places[first] == places[first - 1]) first++;
    return first;
}

ec_result ec_film_add_some(ec_film *film, const float *batch, const float *features, const uint32_t *places, uint32_t count, uint32_t samples,
                           ec_error *err)
{
    enum { PIECES = 64 };
    uint64_t invalid = 0;
    EC_TRY(start_counting(film, err));
    if (film->feature_end != UINT32_MAX) features = NULL;
#pragma omp parallel for reduction(+ : invalid) if (ec_film_is_many(count))
    for (uint64_t k = 0; k < PIECES; k++)
        invalid += add_entries(film, batch, features, places, piece_start(places, count, k, PIECES), piece_start(places, count, k + 1, PIECES), samples);
    film->invalid_count += invalid;
    return EC_OK;
}

/* Writes zeros, which the memory holds already, so that its pages are there. values: NULL if there was no memory, which is reported when it is needed. */
static void touch(float *values, uint64_t from, uint64_t to)
{
    enum { PAGE = 1024 }; /* values; no page is smaller */
    if (!values) return;
#pragma omp parallel for
    for (uint64_t page = from / PAGE; page < (to + PAGE - 1) / PAGE; page++) values[page * PAGE < from ? from : page * PAGE] = 0;
}

void ec_film_make_room(ec_film *film, uint64_t from, uint64_t to)
{
    ec_sums *room = &film->room;
    if (!room->mean && !ec_sums_create(room, film->replicates, ec_film_sets(film, 0), pixels_of(film))) return;
    touch(room->mean, 3 * from, 3 * to);
    touch(room->tail, 3 * from, 3 * to);
    if (room->sets) touch(room->features, EC_FILM_FEATURES * from, EC_FILM_FEATURES * to);
}

ec_result ec_film_create_like(ec_film *film, const ec_film *like, uint32_t rows, ec_error *err)
{
    const uint64_t pixels = (uint64_t)like->width * rows;
    EC_TRY(ec_film_create(film, like->width, rows, like->replicates, err));
    film->batch_count = like->batch_count;
    film->cut = like->cut;
    film->limit = like->limit;
    ec_film_want_features(film, like->feature_sets, like->feature_end);
    memcpy(film->samples, like->samples, sizeof film->samples);
    EC_TRY(ec_film_set_rare(film, like->rare, err));
    film->parts = calloc((size_t)like->part_count + 1, sizeof *film->parts);
    bool made = film->parts != NULL;
    for (uint32_t i = 0; made && i < like->part_count; i++) {
        film->parts[i] = like->parts[i];
        film->parts[i].sums = (ec_sums){0};
        film->parts[i].batch = like->parts[i].batch ? malloc(pixels * EC_BATCH_FIELDS * sizeof(float)) : NULL;
        film->parts[i].features = like->parts[i].features ? malloc(pixels * EC_FILM_FEATURES * sizeof(float)) : NULL;
        made = film->parts[i].batch ? film->parts[i].features || !like->parts[i].features
                                    : ec_sums_create(&film->parts[i].sums, like->replicates, like->parts[i].sums.sets, pixels);
        film->part_count++;
    }
    if (like->shadow) made = made && (film->shadow = malloc(pixels * sizeof *film->shadow));
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
            if (part->features)
                memcpy(film->parts[i].features + EC_FILM_FEATURES * here, part->features + EC_FILM_FEATURES * there,
                       pixels * EC_FILM_FEATURES * sizeof(float));
            continue;
        }
        const ec_sums own = ec_sums_from(&film->parts[i].sums, here), other = ec_sums_from(&part->sums, there);
        ec_sums_copy(&own, &other, pixels);
    }
    if (film->shadow && from->shadow) memcpy(film->shadow + here, from->shadow + there, pixels * sizeof *film->shadow);
    if (film->counts && from->counts) memcpy(film->counts + here, from->counts + there, pixels * sizeof *film->counts);
    for (uint32_t k = 0; film->layer_films && k < film->layers.count; k++)
        ec_film_copy_rows(&film->layer_films[k], to, &from->layer_films[k], first, rows);
    if (film->light) ec_film_copy_rows(film->light, to, from->light, first, rows);
}
