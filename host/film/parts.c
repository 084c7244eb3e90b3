/* A film's batches as parts: see parts.h. */
#include "film/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/film.h"

/* The size of what was joined last to make `count` batches: the largest power of 16 that divides it, but for 16 itself and its powers, which
 * are one such thing. */
static uint64_t unit_of(uint64_t count)
{
    uint64_t unit = 1;
    while (count % (unit * EC_FILM_RADIX) == 0) unit *= EC_FILM_RADIX;
    return unit;
}

bool ec_film_part_is_sound(uint64_t first, uint64_t count)
{
    if (count == 0 || first + count > UINT32_MAX) return false;
    uint64_t unit = unit_of(count);
    return count == unit ? first % unit == 0 : count / unit < EC_FILM_RADIX && first % (unit * EC_FILM_RADIX) == 0;
}

bool ec_film_parts_fit(const ec_film_part *left, const ec_film_part *right)
{
    uint64_t unit = right->count;
    if ((uint64_t)left->first + left->count != right->first || unit_of(unit) != unit) return false;
    return left->count % unit == 0 && left->count / unit < EC_FILM_RADIX && left->first % (unit * EC_FILM_RADIX) == 0;
}

uint32_t ec_film_copies(uint64_t batches)
{
    uint32_t levels = 1;
    for (uint64_t most = EC_FILM_RADIX; most < batches; most *= EC_FILM_RADIX) levels++;
    return levels == 1 ? 1 : levels + 1;
}

uint64_t ec_film_bytes(uint64_t first, uint64_t end)
{
    if (first == 0) return (uint64_t)EC_MOMENTS_BYTES * ec_film_copies(end);
    if (first % EC_FILM_RADIX == 0 && end - first <= EC_FILM_RADIX) return EC_MOMENTS_BYTES;
    uint64_t bytes = EC_MOMENTS_BYTES, below = 0, level = 0; /* what is shown; sums that one of this level is made of, one of each level */
    for (uint64_t at = first, unit = 1; at < end; unit *= EC_FILM_RADIX, level++)
        for (; at < end && at % (unit * EC_FILM_RADIX); at += unit) {
            bytes += level ? EC_MOMENTS_BYTES : 3 * sizeof(float);
            below = level > 1 ? level - 1 : 0;
        }
    return bytes + EC_MOMENTS_BYTES * below;
}

static uint64_t pixels_of(const ec_film *film) { return (uint64_t)film->width * film->height; }

static ec_moments shown(const ec_film *film) { return (ec_moments){film->mean, film->m2, film->m34, film->largest}; }

static void show(ec_film *film, const ec_moments *m)
{
    film->mean = m->mean;
    film->m2 = m->m2;
    film->m34 = m->m34;
    film->largest = m->largest;
}

static bool shows_part(const ec_film *film) { return film->part_count == 1 && film->parts[0].sums.mean == film->mean; }

static void join(const ec_film *film, ec_film_part *left, ec_film_part *right)
{
    if (right->batch) (void)ec_moments_add(&left->sums, right->batch, left->count + 1.0, pixels_of(film));
    else ec_moments_join(&left->sums, left->count, &right->sums, right->count, pixels_of(film));
    left->count += right->count;
    ec_moments_destroy(&right->sums);
    free(right->batch);
}

/* What the parts come to, from left to right; of pixels from `first` on, into as many of `into`. */
static void fold(const ec_film *film, const ec_moments *into, uint64_t first, uint64_t pixels)
{
    double n = 0;
    for (uint32_t i = 0; i < film->part_count; i++) {
        const ec_film_part *part = &film->parts[i];
        const ec_moments sums = part->batch ? (ec_moments){0} : ec_moments_from(&part->sums, first);
        if (part->batch && i == 0) ec_moments_clear(into, pixels);
        if (part->batch) (void)ec_moments_add(into, part->batch + 3 * first, n + 1, pixels);
        else if (i == 0) ec_moments_copy(into, &sums, pixels);
        else ec_moments_join(into, n, &sums, part->count, pixels);
        n += part->count;
    }
}

ec_moments ec_film_look(const ec_film *film, uint64_t first, uint64_t pixels, ec_film_glass *glass)
{
    const ec_moments all = shown(film), through = {glass->mean, glass->m2, glass->m34, glass->largest};
    if (!film->is_behind) return ec_moments_from(&all, first);
    fold(film, &through, first, pixels);
    return through;
}

void ec_film_show(ec_film *film)
{
    const ec_moments all = shown(film);
    const uint64_t pixels = pixels_of(film); /* in pieces that stay in the cache */
    for (uint64_t first = 0, count; film->is_behind && first < pixels; first += count) {
        count = pixels - first < EC_FILM_GLASS ? pixels - first : EC_FILM_GLASS;
        const ec_moments here = ec_moments_from(&all, first);
        fold(film, &here, first, count);
    }
    film->is_behind = false;
}

/* A film of its own, where there is more than one part. */
static ec_result prepare_to_show(ec_film *film, uint32_t parts, ec_error *err)
{
    ec_moments own;
    if (parts < 2 || !shows_part(film)) return EC_OK;
    if (!ec_moments_create(&own, pixels_of(film)))
        return ec_fail(err, "out of memory for another %.1f MB of an image of %u x %u pixels; ask for a smaller one",
                       (double)pixels_of(film) * EC_MOMENTS_BYTES / 1e6, film->width, film->height);
    show(film, &own);
    return EC_OK;
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

/* After any change. A single sum is shown as it is. */
static void settle(ec_film *film)
{
    join_neighbours(film);
    film->batch_count = 0;
    for (uint32_t i = 0; i < film->part_count; i++) film->batch_count += film->parts[i].count;
    film->is_behind = false;
    if (shows_part(film)) return;
    ec_moments own = shown(film);
    if (film->part_count == 1 && !film->parts[0].batch) {
        ec_moments_destroy(&own);
        show(film, &film->parts[0].sums);
        return;
    }
    film->is_behind = true;
    if (!film->shows_late) ec_film_show(film);
}

/* The parts before those from batch `first` on. */
static uint32_t parts_before(const ec_film *film, uint32_t first)
{
    uint32_t i = 0;
    while (i < film->part_count && film->parts[i].first < first) i++;
    return i;
}

static ec_result check_free(const ec_film *film, uint32_t first, uint32_t count, ec_error *err)
{
    for (uint32_t i = 0; i < film->part_count; i++) {
        const ec_film_part *part = &film->parts[i];
        uint64_t from = part->first > first ? part->first : first;
        uint64_t to = (uint64_t)part->first + part->count < (uint64_t)first + count
                          ? (uint64_t)part->first + part->count
                          : (uint64_t)first + count;
        if (from < to)
            return ec_fail(err, "batches %llu to %llu are there twice", (unsigned long long)from,
                           (unsigned long long)to - 1);
    }
    return EC_OK;
}

/* What `part` is joined to as it comes; NULL: it waits. */
static ec_film_part *neighbour_of(const ec_film *film, const ec_film_part *part)
{
    const uint32_t before = parts_before(film, part->first);
    ec_film_part *left = before > 0 ? &film->parts[before - 1] : NULL;
    return left && ec_film_parts_fit(left, part) ? left : NULL;
}

ec_result ec_film_insert(ec_film *film, ec_film_part *part, ec_error *err)
{
    EC_TRY(check_free(film, part->first, part->count, err));
    ec_film_part *left = neighbour_of(film, part);
    if (left) {
        join(film, left, part);
        *part = (ec_film_part){0};
        settle(film);
        return EC_OK;
    }
    EC_TRY(prepare_to_show(film, film->part_count + 1, err));
    ec_film_part *parts = realloc(film->parts, (film->part_count + 1) * sizeof *parts);
    if (!parts) return ec_fail(err, "out of memory");
    film->parts = parts;
    uint32_t i = parts_before(film, part->first);
    memmove(parts + i + 1, parts + i, (film->part_count - i) * sizeof *parts);
    parts[i] = *part;
    film->part_count++;
    *part = (ec_film_part){0};
    settle(film);
    return EC_OK;
}

/* A copy for a part; values that are not finite are 0 in it, and counted. */
static float *kept(const float *batch, uint64_t values, uint64_t *invalid)
{
    float *own = malloc(values * sizeof *own);
    for (uint64_t i = 0; own && i < values; i++) {
        own[i] = isfinite(batch[i]) ? batch[i] : 0.0f;
        *invalid += !isfinite(batch[i]);
    }
    return own;
}

static ec_result insert_batch(ec_film *film, uint32_t index, const float *batch, ec_error *err)
{
    uint64_t pixels = pixels_of(film), invalid = 0;
    ec_film_part part = {.first = index, .count = 1};
    bool is_shown = film->part_count == 0 && !ec_film_part_is_batch(index, 1), made = true;
    if (is_shown) part.sums = shown(film);
    else if (ec_film_part_is_batch(index, 1)) made = (part.batch = kept(batch, 3 * pixels, &invalid)) != NULL;
    else made = ec_moments_create(&part.sums, pixels);
    if (!made)
        return ec_fail(err, "out of memory for a batch of an image of %u x %u pixels; ask for a smaller one",
                       film->width, film->height);
    if (!part.batch) invalid = ec_moments_add(&part.sums, batch, 1, pixels);
    ec_result result = ec_film_insert(film, &part, err);
    if (result == EC_OK) film->invalid_count += invalid;
    else if (!is_shown) ec_film_part_free(&part);
    return result;
}

ec_result ec_film_add_at(ec_film *film, uint32_t index, const float *batch, ec_error *err)
{
    EC_TRY(check_free(film, index, 1, err));
    ec_film_part *left = neighbour_of(film, &(ec_film_part){.first = index, .count = 1});
    if (!left) return insert_batch(film, index, batch, err);
    film->invalid_count += ec_moments_add(&left->sums, batch, left->count + 1.0, pixels_of(film));
    left->count++;
    settle(film);
    return EC_OK;
}

ec_result ec_film_take_parts(ec_film *film, ec_film *from, ec_error *err)
{
    for (uint32_t i = 0; i < from->part_count; i++) EC_TRY(check_free(film, from->parts[i].first, from->parts[i].count, err));
    if (shows_part(from)) show(from, &(ec_moments){0});
    for (uint32_t i = 0; i < from->part_count; i++) EC_TRY(ec_film_insert(film, &from->parts[i], err));
    from->part_count = 0;
    film->invalid_count += from->invalid_count;
    if (film->aov) return EC_OK;
    film->aov = from->aov;
    from->aov = NULL;
    return EC_OK;
}

ec_moments ec_film_give_sums(ec_film *film)
{
    const ec_moments sums = film->parts[0].sums;
    if (shows_part(film)) show(film, &(ec_moments){0});
    film->parts[0].sums = (ec_moments){0};
    return sums;
}

void ec_film_part_free(ec_film_part *part)
{
    ec_moments_destroy(&part->sums);
    free(part->batch);
    *part = (ec_film_part){0};
}

void ec_film_drop_parts(ec_film *film)
{
    ec_film_show(film);
    bool shown_part = shows_part(film);
    for (uint32_t i = 0; i < film->part_count; i++) {
        if (shown_part) film->parts[i].sums = (ec_moments){0};
        ec_film_part_free(&film->parts[i]);
    }
    free(film->parts);
    film->parts = NULL;
    film->part_count = 0;
}
