#include "store/merge.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct place {
    char *path;
    uint32_t first;
    int given; /* its place among the files as given */
} place;

static int compare_places(const void *a, const void *b)
{
    const place *left = a, *right = b;
    if (left->first != right->first) return left->first < right->first ? -1 : 1;
    return left->given - right->given;
}

ec_result ec_merge_sort(char **paths, int count, ec_error *err)
{
    place *places = malloc(((size_t)count + 1) * sizeof *places);
    if (!places) return ec_fail(err, "out of memory");
    for (int i = 0; i < count; i++) {
        ec_stored stored;
        places[i] = (place){.path = paths[i], .given = i};
        (void)ec_store_peek(paths[i], &stored, &places[i].first); /* reading it will say why not */
        ec_stored_free(&stored);
    }
    qsort(places, (size_t)count, sizeof *places, compare_places);
    for (int i = 0; i < count; i++) paths[i] = places[i].path;
    free(places);
    return EC_OK;
}

static ec_result check_same_job(const ec_merge *merge, const ec_stored *next, const char *path, const ec_log *log, ec_error *err)
{
    const ec_job *here = &merge->all.job, *there = &next->job;
    char difference[1200];
    if (ec_identity_differs(&here->identity, &there->identity, difference, sizeof difference))
        return ec_fail(err, "'%s' is not from the same job as '%s': %s; merge slices of one scene, with the same options and version", path,
                       merge->first_path, difference);
    if (merge->all.film.limit != next->film.limit)
        return ec_fail(err, "'%s' and '%s': --clamp limits a sample to a luminance of %g in one and %g in the other, since the devices' pilots "
                            "differ; render slices on devices of one kind", merge->first_path, path, (double)merge->all.film.limit, (double)next->film.limit);
    if (!ec_layers_are_same(&merge->all.film.layers, &next->film.layers))
        return ec_fail(err, "'%s' and '%s' have different layers; render both with the same --channels and --light-groups", merge->first_path, path);
    if (next->film.counts || merge->all.film.counts)
        return ec_fail(err, "'%s': an adaptive render has a different number of samples in each pixel and cannot be merged; give it alone", path);
    if (strcmp(here->device, there->device))
        ec_warn(log, "'%s' was rendered on %s, '%s' on %s: where they round differently, the last bits are not those of a single run", merge->first_path,
                here->device, path, there->device);
    return EC_OK;
}

static unsigned long long samples_before(const ec_film *film, uint64_t batch)
{
    return ec_schedule_samples(film->replicates, (uint32_t)batch);
}

/* Fails if the film has batches that another file has; names those from the first to the last that it shares with one such file. */
static ec_result check_ranges(const ec_merge *merge, const ec_film *film, const char *path, ec_error *err)
{
    uint64_t from = UINT64_MAX, to = 0;
    const char *other = NULL;
    for (uint32_t k = 0; k < merge->range_count; k++)
        for (uint32_t i = 0; i < film->part_count; i++) {
            const ec_merge_range *r = &merge->ranges[k];
            const ec_film_part *p = &film->parts[i];
            uint64_t r_end = (uint64_t)r->first + r->count, p_end = (uint64_t)p->first + p->count;
            uint64_t first = r->first > p->first ? r->first : p->first, end = r_end < p_end ? r_end : p_end;
            if (first >= end || (other && other != r->path)) continue;
            other = r->path;
            if (first < from) from = first;
            if (end > to) to = end;
        }
    if (!other) return EC_OK;
    return ec_fail(err, "'%s' and '%s' both have samples %llu:%llu; leave one of them out", other, path,
                   samples_before(film, from), samples_before(film, to));
}

/* Fails if batches follow the end of a job within a batch, which is the end of the picture too. */
static ec_result check_end(const ec_merge *merge, const ec_film *next, const char *path, ec_error *err)
{
    const ec_film *all = &merge->all.film, *ended = all->cut ? all : next;
    if (!ended->cut || ec_film_end(ended == all ? next : all) <= ec_film_end(ended)) return EC_OK;
    return ec_fail(err, "'%s' and '%s': one ends within a batch, after %llu samples a pixel, and the other continues after that; leave one of them out",
                   merge->first_path, path, samples_before(ended, ec_film_end(ended)) - ended->cut);
}

static ec_result note_ranges(ec_merge *merge, const ec_film *film, const char *path, ec_error *err)
{
    ec_merge_range *ranges = realloc(merge->ranges, (merge->range_count + film->part_count + 1) * sizeof *ranges);
    if (!ranges) return ec_fail(err, "out of memory");
    merge->ranges = ranges;
    for (uint32_t i = 0; i < film->part_count; i++)
        ranges[merge->range_count++] = (ec_merge_range){path, film->parts[i].first, film->parts[i].count};
    return EC_OK;
}

static void add_past(ec_stored *all, const ec_stored *next)
{
    all->past.samples += next->past.samples;
    all->past.rays += next->past.rays;
    all->past.seconds += next->past.seconds;
    for (int i = 0; i < EC_STAGE_COUNT; i++) all->past.invalid[i] += next->past.invalid[i];
    if (all->past.next < next->past.next) all->past.next = next->past.next;
    if (all->job.spp < next->job.spp) all->job.spp = next->job.spp;
}

ec_result ec_merge_take(ec_merge *merge, const char *path, const ec_log *log, ec_error *err)
{
    ec_stored next;
    ec_result result;
    EC_TRY(ec_store_read(path, &next, err));
    if (next.film.batch_count == 0) {
        result = ec_fail(err, "'%s' stopped within its first batch and has none to merge; leave it out, or continue it with --resume", path);
        goto cleanup;
    }
    if (!merge->first_path) {
        result = note_ranges(merge, &next.film, path, err);
        if (result != EC_OK) goto cleanup;
        merge->first_path = path;
        next.past.under_way = 0; /* part of a batch is of no use to the picture */
        merge->all = next;
        return EC_OK;
    }
    EC_TRY_CLEANUP(check_same_job(merge, &next, path, log, err));
    EC_TRY_CLEANUP(check_ranges(merge, &next.film, path, err));
    EC_TRY_CLEANUP(check_end(merge, &next.film, path, err));
    EC_TRY_CLEANUP(note_ranges(merge, &next.film, path, err));
    add_past(&merge->all, &next);
    merge->all.job.merged = true;
    EC_TRY_CLEANUP(ec_film_take_parts(&merge->all.film, &next.film, err));
cleanup:
    ec_stored_free(&next);
    return result;
}

__attribute__((format(printf, 3, 4))) static void append(char *text, size_t size, const char *format, ...)
{
    size_t used = strlen(text);
    va_list args;
    va_start(args, format);
    vsnprintf(text + used, size - used, format, args);
    va_end(args);
}

enum { FOR_THE_REST = 80 }; /* bytes for one range, and for how many more there are */

bool ec_merge_missing(const ec_merge *merge, char *text, size_t size)
{
    const ec_film *film = &merge->all.film;
    uint32_t untold = 0, before;
    const uint64_t spp = merge->all.job.spp;
    uint64_t at = 0, end = ec_schedule_find(film->replicates, spp, &before);
    if (before) end++;
    text[0] = 0;
    if (film->counts) return false;
    for (uint32_t i = 0; i <= film->part_count; i++) {
        bool is_last = i == film->part_count, has_room = strlen(text) + FOR_THE_REST < size;
        uint64_t next = is_last ? end : film->parts[i].first;
        if (next > at && has_room)
            append(text, size, "%s%llu:%llu", *text ? ", " : "", samples_before(film, at),
                   next == end ? (unsigned long long)spp : samples_before(film, next));
        untold += next > at && !has_room;
        if (!is_last) at = (uint64_t)film->parts[i].first + film->parts[i].count;
    }
    if (untold) append(text, size, " and %u more ranges", untold);
    return *text != 0;
}

void ec_merge_free(ec_merge *merge)
{
    ec_stored_free(&merge->all);
    free(merge->ranges);
    *merge = (ec_merge){0};
}
