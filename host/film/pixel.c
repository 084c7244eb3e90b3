#include "film/pixel.h"

#include <math.h>
#include <string.h>

static void move(double mean[3], const float to[3], double share)
{
    for (int c = 0; c < 3; c++) mean[c] += (to[c] - mean[c]) * share;
}

/* The part's mean of a replicate that has samples in it. */
static const float *part_mean(const ec_film_part *part, uint64_t p, uint32_t r)
{
    return part->batch ? part->batch + EC_BATCH_FIELDS * p : ec_sums_mean(&part->sums, r, p);
}

/* From left to right. An average that moves by differences leaves values that are all alike as they are. */
static void replicate_mean(const ec_film *film, uint64_t p, uint32_t r, double mean[3])
{
    double samples = 0;
    memset(mean, 0, 3 * sizeof *mean);
    for (uint32_t i = 0; i < film->part_count; i++) {
        const ec_film_part *part = &film->parts[i];
        if (!(part->samples[r] > 0)) continue;
        samples += part->samples[r];
        move(mean, part_mean(part, p, r), part->samples[r] / samples);
    }
}

void ec_film_tail(const ec_film *film, uint64_t p, float tail[3])
{
    for (uint32_t i = 0; i < film->part_count; i++) {
        const ec_film_part *part = &film->parts[i];
        ec_sums_add_tail(tail, part->batch ? part->batch + EC_BATCH_FIELDS * p + EC_BATCH_LARGEST : part->sums.tail + 3 * p);
    }
}

static void add_deviation(ec_pixel *out, const double mean[3], double weight)
{
    const double d[3] = {weight * (mean[0] - out->mean[0]), weight * (mean[1] - out->mean[1]), weight * (mean[2] - out->mean[2])};
    const double y = ec_luminance(d), y2 = y * y;
    for (int c = 0; c < 3; c++) out->m2[c] += d[c] * d[c];
    out->m2[3] += y2;
    out->m3 += y2 * y;
    out->m4 += y2 * y2;
}

static void look_at(const ec_film *film, uint64_t p, ec_pixel *out)
{
    const uint32_t replicates = film->replicates;
    double mean[EC_REPLICATES_MOST][3], samples = 0, all = 0;
    *out = (ec_pixel){0};
    for (uint32_t r = 0; r < replicates; r++) all += film->samples[r];
    for (uint32_t r = 0; r < replicates; r++) {
        if (!(film->samples[r] > 0)) continue;
        out->n++;
        samples += film->samples[r];
        replicate_mean(film, p, r, mean[r]);
        for (int c = 0; c < 3; c++) out->mean[c] += (mean[r][c] - out->mean[c]) * (film->samples[r] / samples);
    }
    for (uint32_t r = 0; r < replicates; r++)
        if (film->samples[r] > 0) add_deviation(out, mean[r], sqrt(out->n * film->samples[r] / all));
    ec_film_tail(film, p, out->tail);
    out->samples = ec_film_samples(film, p);
}

void ec_film_look(const ec_film *film, uint64_t first, uint64_t count, ec_pixel *pixels)
{
    for (uint64_t i = 0; i < count; i++) look_at(film, first + i, pixels + i);
}
