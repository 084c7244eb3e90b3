#include "film/pixel.h"

#include <math.h>
#include <string.h>

enum { PIECE = 32 }; /* pixels whose means by replicate stay in the first cache */

/* A replicate that has samples; the same for all pixels. */
typedef struct replicate {
    uint32_t number;
    double share;  /* of the samples of all up to it */
    double weight; /* of its deviation */
} replicate;

static uint32_t list_replicates(const ec_film *film, replicate list[EC_REPLICATES_MOST])
{
    const double all = ec_film_samples_of_all(film), n = ec_film_replicates(film);
    double samples = 0;
    uint32_t count = 0;
    for (uint32_t r = 0; r < film->replicates; r++) {
        if (!(film->samples[r] > 0)) continue;
        samples += film->samples[r];
        list[count++] = (replicate){r, film->samples[r] / samples, sqrt(n * film->samples[r] / all)};
    }
    return count;
}

/* Takes in a part, parts from left to right. An average that moves by differences keeps values that are all alike. */
static void take_part(const ec_film_part *part, uint64_t first, uint64_t count, uint32_t r, double share, double *mean)
{
    const float *to = part->batch ? part->batch + EC_BATCH_FIELDS * first : ec_sums_mean(&part->sums, r, first);
    for (uint64_t i = 0; part->batch && i < count; i++)
        for (uint64_t c = 0; c < 3; c++) mean[3 * i + c] += (to[EC_BATCH_FIELDS * i + c] - mean[3 * i + c]) * share;
    for (uint64_t i = 0; !part->batch && i < 3 * count; i++) mean[i] += (to[i] - mean[i]) * share;
}

static void add_replicate(const ec_film *light, uint64_t first, uint64_t count, uint32_t r, double share, double *mean)
{
    double own[3 * PIECE];
    for (uint64_t i = 0; i < count; i += PIECE) {
        const uint64_t some = count - i < PIECE ? count - i : PIECE;
        ec_film_replicate(light, first + i, some, r, own);
        for (uint64_t v = 0; v < 3 * some; v++) mean[3 * i + v] += share * own[v];
    }
}

/* Adds what light paths bring to the replicate. During the first batches it may have none of that yet, and takes the mean of those that have. */
static void add_light(const ec_film *light, uint64_t first, uint64_t count, uint32_t r, double *mean)
{
    if (light->samples[r] > 0) {
        add_replicate(light, first, count, r, 1, mean);
        return;
    }
    for (uint32_t k = 0; k < light->replicates; k++)
        if (light->samples[k] > 0) add_replicate(light, first, count, k, light->samples[k] / ec_film_samples_of_all(light), mean);
}

void ec_film_replicate(const ec_film *film, uint64_t first, uint64_t count, uint32_t r, double *mean)
{
    double samples = 0;
    memset(mean, 0, 3 * count * sizeof *mean);
    for (uint32_t i = 0; i < film->part_count; i++) {
        const double own = film->parts[i].samples[r];
        if (!(own > 0)) continue;
        samples += own;
        take_part(&film->parts[i], first, count, r, own / samples, mean);
    }
    if (film->light && samples > 0) add_light(film->light, first, count, r, mean);
}

/* Adds the tail of what light paths bring, with the largest scaled to what among the pixel's own samples would move its mean as much. */
static void add_light_tail(const ec_film *film, uint64_t p, float tail[3])
{
    float light[3] = {0};
    ec_film_tail(film->light, p, light);
    light[0] *= (float)(ec_film_samples(film, p) / ec_film_samples_of_all(film->light));
    ec_sums_add_tail(tail, light);
}

void ec_film_tail(const ec_film *film, uint64_t p, float tail[3])
{
    for (uint32_t i = 0; i < film->part_count; i++) {
        const ec_film_part *part = &film->parts[i];
        ec_sums_add_tail(tail, part->batch ? part->batch + EC_BATCH_FIELDS * p + EC_BATCH_LARGEST : part->sums.tail + 3 * p);
    }
    if (film->light && film->light->part_count) add_light_tail(film, p, tail);
}

/* Sums of a piece of pixels, field by field, so that compilers take several pixels at once. */
typedef struct piece {
    double by_replicate[EC_REPLICATES_MOST][3 * PIECE], mean[3 * PIECE], m2[3 * PIECE], y2[PIECE], y3[PIECE], y4[PIECE];
} piece;

static void add_mean(const double *by_replicate, double share, uint64_t values, double *mean)
{
    for (uint64_t i = 0; i < values; i++) mean[i] += (by_replicate[i] - mean[i]) * share;
}

static void add_deviations(const double *by_replicate, double weight, uint64_t count, piece *p)
{
    double d[3 * PIECE];
    for (uint64_t i = 0; i < 3 * count; i++) {
        d[i] = weight * (by_replicate[i] - p->mean[i]);
        p->m2[i] += d[i] * d[i];
    }
    for (uint64_t i = 0; i < count; i++) {
        const double y = ec_luminance(d + 3 * i), y2 = y * y;
        p->y2[i] += y2;
        p->y3[i] += y2 * y;
        p->y4[i] += y2 * y2;
    }
}

static void look_at(const ec_film *film, const replicate *list, uint32_t n, uint64_t first, uint64_t count, ec_pixel *out)
{
    piece p;
    const double samples = ec_film_samples_of_all(film);
    memset(p.mean, 0, sizeof p - sizeof p.by_replicate);
    for (uint32_t k = 0; k < n; k++) {
        ec_film_replicate(film, first, count, list[k].number, p.by_replicate[k]);
        add_mean(p.by_replicate[k], list[k].share, 3 * count, p.mean);
    }
    for (uint32_t k = 0; k < n; k++) add_deviations(p.by_replicate[k], list[k].weight, count, &p);
    for (uint64_t i = 0; i < count; i++) {
        const double *mean = p.mean + 3 * i, *m2 = p.m2 + 3 * i;
        out[i] = (ec_pixel){.mean = {mean[0], mean[1], mean[2]}, .m2 = {m2[0], m2[1], m2[2], p.y2[i]}, .m3 = p.y3[i], .m4 = p.y4[i], .n = n,
                            .samples = film->counts ? ec_film_samples(film, first + i) : samples};
        ec_film_tail(film, first + i, out[i].tail);
    }
}

void ec_film_look(const ec_film *film, uint64_t first, uint64_t count, ec_pixel *pixels)
{
    replicate list[EC_REPLICATES_MOST];
    const uint32_t n = list_replicates(film, list);
    for (uint64_t i = 0; i < count; i += PIECE) look_at(film, list, n, first + i, count - i < PIECE ? count - i : PIECE, pixels + i);
}
