/* A film's batches as parts: see parts.h. */
#include "film/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/film.h"

/* Returns the size of what was joined last to make `count` batches: 1, EC_FILM_FIRST or a power of 16 times that. */
static uint64_t unit_of(uint64_t count)
{
    uint64_t unit = 1;
    for (uint64_t next = EC_FILM_FIRST; count % next == 0; next *= EC_FILM_RADIX) unit = next;
    return unit;
}

static uint64_t above(uint64_t unit) { return unit == 1 ? EC_FILM_FIRST : unit * EC_FILM_RADIX; }

bool ec_film_part_is_sound(uint64_t first, uint64_t count)
{
    if (count == 0 || first + count > UINT32_MAX) return false;
    const uint64_t unit = unit_of(count);
    return count == unit && unit > 1 ? first % unit == 0 : count < above(unit) && (first % above(unit) == 0 || count == 1);
}

bool ec_film_parts_fit(const ec_film_part *left, const ec_film_part *right)
{
    const uint64_t unit = right->count;
    if ((uint64_t)left->first + left->count != right->first || unit_of(unit) != unit) return false;
    return left->count % unit == 0 && left->count < above(unit) && left->first % above(unit) == 0;
}

uint64_t ec_film_bytes(uint32_t replicates, uint32_t sets, uint64_t first, uint64_t end)
{
    const uint64_t sum = ec_sums_bytes(replicates, sets), batch = ec_batch_bytes(sets);
    if (end <= first) return 0;
    uint64_t bytes = sum; /* the last level's, or the first part's */
    if (first == 0) {
        for (uint64_t unit = EC_FILM_FIRST; unit < end; unit *= EC_FILM_RADIX) bytes += sum;
        return bytes;
    }
    if (first % EC_FILM_FIRST == 0 && end - first <= EC_FILM_FIRST) return sum;
    for (uint64_t at = first, unit = 1; at < end; unit = above(unit))
        for (; at < end && at % above(unit); at += unit) bytes += unit == 1 ? batch : sum;
    return bytes + sum;
}

static uint64_t pixels_of(const ec_film *film) { return (uint64_t)film->width * film->height; }

/* Returns the set that a replicate's features go into. */
static uint32_t set_of(const ec_film *film, uint32_t replicate) { return replicate % film->feature_sets; }

static double share_of(double left, double right) { return right > 0 ? right / (left + right) : 0; }

static void join(const ec_film *film, ec_film_part *left, ec_film_part *right)
{
    double share[EC_REPLICATES_MOST] = {0}, set_share[2];
    for (uint32_t k = 0; k < 2; k++) set_share[k] = share_of(left->set_samples[k], right->set_samples[k]);
    for (uint32_t r = 0; r < film->replicates; r++)
        share[r] = share_of(left->samples[r], right->samples[r]);
    if (right->batch) {
        const uint32_t r = right->first % film->replicates;
        (void)ec_sums_add(&left->sums, right->batch, r, share[r], pixels_of(film));
        if (right->features) ec_sums_add_features(&left->sums, right->features, set_of(film, r), set_share[set_of(film, r)], pixels_of(film));
    } else {
        ec_sums_join(&left->sums, &right->sums, share, set_share, pixels_of(film));
    }
    for (uint32_t k = 0; k < 2; k++) left->set_samples[k] += right->set_samples[k];
    for (uint32_t r = 0; r < film->replicates; r++) left->samples[r] += right->samples[r];
    left->count += right->count;
    ec_film_part_free(right);
}

static void join_neighbours(ec_film *film)
{
    for (uint32_t i = 0; i + 1 < film->part_count;) {
        ec_film_part *left = &film->parts[i];
        if (!ec_film_parts_fit(left, left + 1)) {
            i++;
            continue;
        }
        join(film, left, left + 1);
        film->part_count--;
        memmove(left + 1, left + 2, (film->part_count - i - 1) * sizeof *left);
        if (i > 0) i--;
    }
}

/* Joins parts that fit, and counts batches and samples anew, after any change. */
static void settle(ec_film *film)
{
    join_neighbours(film);
    film->batch_count = 0;
    memset(film->samples, 0, sizeof film->samples);
    for (uint32_t i = 0; i < film->part_count; i++) {
        film->batch_count += film->parts[i].count;
        for (uint32_t r = 0; r < film->replicates; r++) film->samples[r] += film->parts[i].samples[r];
    }
}

uint32_t ec_film_sets(const ec_film *film, uint64_t first) { return first < film->feature_end ? film->feature_sets : 0; }

/* Sets the samples of each replicate by the schedule, and those of features, where there are some, up to the last batch that has them. */
static void count_samples(const ec_film *film, ec_film_part *part)
{
    const uint64_t end = (uint64_t)part->first + part->count, feature_end = end < film->feature_end ? end : film->feature_end;
    const bool has_features = part->sums.features || part->features;
    for (uint32_t r = 0; r < film->replicates; r++) {
        part->samples[r] = (double)ec_schedule_share(film->replicates, r, part->first, end);
        if (has_features) part->set_samples[set_of(film, r)] += (double)ec_schedule_share(film->replicates, r, part->first, feature_end);
    }
}

/* Takes off the `cut` samples that the last batch lacks. */
static void cut_samples(const ec_film *film, ec_film_part *part, uint32_t cut)
{
    const uint32_t last = part->first + part->count - 1, replicate = last % film->replicates;
    part->samples[replicate] -= cut;
    if ((part->sums.features || part->features) && last < film->feature_end) part->set_samples[set_of(film, replicate)] -= cut;
}

/* Returns how many parts begin before batch `first`. */
static uint32_t parts_before(const ec_film *film, uint32_t first)
{
    uint32_t i = 0;
    while (i < film->part_count && film->parts[i].first < first) i++;
    return i;
}

/* Fails if the film has any of these batches, the last of which lacks `cut` samples, or if one would come after the end of a picture that ended
 * within a batch. */
static ec_result check_free(const ec_film *film, uint32_t first, uint32_t count, uint32_t cut, ec_error *err)
{
    const uint64_t end = (uint64_t)first + count, there = ec_film_end(film);
    for (uint32_t i = 0; i < film->part_count; i++) {
        const ec_film_part *part = &film->parts[i];
        uint64_t from = part->first > first ? part->first : first;
        uint64_t to = (uint64_t)part->first + part->count < end ? (uint64_t)part->first + part->count : end;
        if (from < to)
            return ec_fail(err, "batches %llu to %llu occur twice", (unsigned long long)from,
                           (unsigned long long)to - 1);
    }
    if ((film->cut && end > there) || (cut && end < there))
        return ec_fail(err, "the picture ended within batch %llu, so no batch may follow",
                       (unsigned long long)(end < there ? end : there) - 1);
    return EC_OK;
}

/* Returns the part that `part` is joined to as it comes; NULL: it waits. */
static ec_film_part *neighbour_of(const ec_film *film, const ec_film_part *part)
{
    const uint32_t before = parts_before(film, part->first);
    ec_film_part *left = before > 0 ? &film->parts[before - 1] : NULL;
    return left && ec_film_parts_fit(left, part) ? left : NULL;
}

static ec_result insert(ec_film *film, ec_film_part *part, ec_error *err)
{
    ec_film_part *left = neighbour_of(film, part);
    if (left) {
        join(film, left, part);
    } else {
        ec_film_part *parts = realloc(film->parts, (film->part_count + 1) * sizeof *parts);
        if (!parts) return ec_fail(err, "out of memory");
        film->parts = parts;
        uint32_t i = parts_before(film, part->first);
        memmove(parts + i + 1, parts + i, (film->part_count - i) * sizeof *parts);
        parts[i] = *part;
        film->part_count++;
    }
    *part = (ec_film_part){0};
    settle(film);
    return EC_OK;
}

ec_result ec_film_insert(ec_film *film, ec_film_part *part, ec_error *err)
{
    EC_TRY(check_free(film, part->first, part->count, 0, err));
    count_samples(film, part);
    return insert(film, part, err);
}

/* Returns a copy for a part, in which values that are not finite are 0; counts those in radiance. */
static float *kept(const float *values, uint64_t count, uint64_t *invalid)
{
    float *own = malloc(count * sizeof *own);
    for (uint64_t i = 0; own && i < count; i++) {
        own[i] = isfinite(values[i]) ? values[i] : 0.0f;
        *invalid += i % EC_BATCH_FIELDS < EC_BATCH_LARGEST && !isfinite(values[i]);
    }
    return own;
}

static bool keep_batch(const ec_film *film, const ec_film_batch *batch, ec_film_part *part, uint64_t *invalid)
{
    uint64_t of_features;
    part->batch = kept(batch->values, pixels_of(film) * EC_BATCH_FIELDS, invalid);
    if (batch->features) part->features = kept(batch->features, pixels_of(film) * EC_FILM_FEATURES, &of_features);
    return part->batch && (part->features || !batch->features);
}

/* Begins a sum with this batch alone. */
static bool begin_sums(ec_film *film, const ec_film_batch *batch, ec_film_part *part, uint64_t *invalid)
{
    const uint64_t pixels = pixels_of(film) - batch->missing;
    const uint32_t replicate = batch->index % film->replicates;
    if (film->room.mean) part->sums = film->room, film->room = (ec_sums){0};
    else if (!ec_sums_create(&part->sums, film->replicates, ec_film_sets(film, batch->index), pixels_of(film))) return false;
    *invalid = ec_sums_add(&part->sums, batch->values, replicate, 1, pixels);
    if (batch->features) ec_sums_add_features(&part->sums, batch->features, set_of(film, replicate), 1, pixels);
    return true;
}

static ec_result insert_batch(ec_film *film, const ec_film_batch *batch, ec_film_part *part, ec_error *err)
{
    uint64_t invalid = 0;
    const bool made = ec_film_part_is_batch(part->first, 1) ? keep_batch(film, batch, part, &invalid) : begin_sums(film, batch, part, &invalid);
    ec_result result = made ? insert(film, part, err)
                            : ec_fail(err, "out of memory for a film of %u x %u pixels (%.1f MB); ask for a smaller one", film->width, film->height,
                                      (double)pixels_of(film) * (double)ec_sums_bytes(film->replicates, film->feature_sets) / 1e6);
    if (result == EC_OK) film->invalid_count += invalid;
    else ec_film_part_free(part);
    return result;
}

/* Adds a batch to its left neighbour, without a part of its own. */
static void add_batch(ec_film *film, const ec_film_batch *batch, const ec_film_part *part, ec_film_part *left)
{
    const uint32_t replicate = batch->index % film->replicates, set = batch->features ? set_of(film, replicate) : 0;
    const double own = part->samples[replicate];
    film->invalid_count += ec_sums_add(&left->sums, batch->values, replicate, share_of(left->samples[replicate], own), pixels_of(film));
    left->samples[replicate] += own;
    left->count++;
    if (!batch->features) return;
    ec_sums_add_features(&left->sums, batch->features, set, share_of(left->set_samples[set], own), pixels_of(film));
    left->set_samples[set] += own;
}

ec_result ec_film_take(ec_film *film, const ec_film_batch *batch, ec_error *err)
{
    const uint32_t replicate = batch->index % film->replicates;
    ec_film_batch own = *batch;
    ec_film_part part = {.first = batch->index, .count = 1};
    if (!ec_film_sets(film, batch->index)) own.features = NULL;
    EC_TRY(check_free(film, batch->index, 1, batch->cut, err));
    count_samples(film, &part);
    part.samples[replicate] -= batch->cut;
    if (own.features) part.set_samples[set_of(film, replicate)] = part.samples[replicate];
    ec_film_part *left = neighbour_of(film, &part);
    if (left) add_batch(film, &own, &part, left);
    else EC_TRY(insert_batch(film, &own, &part, err));
    settle(film);
    film->cut += batch->cut;
    return EC_OK;
}

ec_result ec_film_add(ec_film *film, uint32_t index, const float *batch, ec_error *err)
{
    return ec_film_take(film, &(ec_film_batch){.index = index, .values = batch}, err);
}

void ec_film_set_cut(ec_film *film, uint32_t cut)
{
    cut_samples(film, &film->parts[film->part_count - 1], cut);
    film->cut = cut;
    settle(film);
}

ec_result ec_film_take_parts(ec_film *film, ec_film *from, ec_error *err)
{
    for (uint32_t i = 0; i < from->part_count; i++)
        EC_TRY(check_free(film, from->parts[i].first, from->parts[i].count, i + 1 == from->part_count ? from->cut : 0, err));
    for (uint32_t i = 0; i < from->part_count; i++) EC_TRY(insert(film, &from->parts[i], err));
    from->part_count = 0;
    for (uint32_t k = 0; k < film->layers.count; k++) EC_TRY(ec_film_take_parts(&film->layer_films[k], &from->layer_films[k], err));
    if (!film->light) film->light = from->light, from->light = NULL;
    film->cut += from->cut;
    film->invalid_count += from->invalid_count;
    if (!film->rare) film->rare = from->rare, from->rare = NULL;
    return EC_OK;
}

ec_sums ec_film_give_sums(ec_film *film)
{
    const ec_sums sums = film->parts[0].sums;
    film->parts[0].sums = (ec_sums){0};
    return sums;
}

void ec_film_part_free(ec_film_part *part)
{
    ec_sums_destroy(&part->sums);
    free(part->batch);
    free(part->features);
    *part = (ec_film_part){0};
}
