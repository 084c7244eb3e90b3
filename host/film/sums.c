#include "film/sums.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/threads.h"

bool ec_sums_create(ec_sums *s, uint32_t replicates, uint32_t sets, uint64_t pixels)
{
    *s = (ec_sums){replicates, sets, pixels, calloc(pixels, 3 * replicates * sizeof(float)), calloc(pixels, 3 * sizeof(float)), NULL};
    if (sets) s->features = calloc(pixels, EC_FILM_FEATURES * sets * sizeof(float));
    if (s->mean && s->tail && (s->features || !sets)) return true;
    ec_sums_destroy(s);
    return false;
}

void ec_sums_destroy(ec_sums *s)
{
    free(s->mean);
    free(s->tail);
    free(s->features);
    *s = (ec_sums){0};
}

ec_sums ec_sums_in(void *memory, uint32_t replicates, uint32_t sets, uint64_t pixels)
{
    float *mean = memory, *tail = mean + 3ull * replicates * pixels;
    return (ec_sums){replicates, sets, pixels, mean, tail, sets ? tail + 3 * pixels : NULL};
}

void ec_sums_join_tails(float into[3], const float next[3])
{
    const float largest = into[0] < next[0] ? next[0] : into[0];
    const double a = into[0] / (double)largest, b = next[0] / (double)largest, a2 = a * a, b2 = b * b;
    into[0] = largest;
    into[1] = (float)(a2 * into[1] + b2 * next[1]);
    into[2] = (float)(a2 * a2 * into[2] + b2 * b2 * next[2]);
}

/* An average of two finite floats is finite. */
static void move(float *mean, double to, double share)
{
    *mean = share < 1 ? (float)(*mean + (to - *mean) * share) : (float)to;
}

uint32_t ec_sums_add_pixel(const ec_sums *s, const float *batch, uint32_t replicate, double share, uint64_t pixel)
{
    float *mean = ec_sums_mean(s, replicate, pixel);
    uint32_t invalid = 0;
    for (int c = 0; c < 3; c++) {
        const bool is_finite = isfinite(batch[c]);
        invalid += !is_finite;
        move(mean + c, is_finite ? batch[c] : 0, share);
    }
    if (isfinite(batch[EC_BATCH_LARGEST])) ec_sums_add_tail(s->tail + 3 * pixel, batch + EC_BATCH_LARGEST);
    return invalid;
}

uint64_t ec_sums_add(const ec_sums *s, const float *batch, uint32_t replicate, double share, uint64_t pixels)
{
    uint64_t invalid = 0;
#pragma omp parallel for reduction(+ : invalid) if (ec_film_is_many(pixels))
    for (uint64_t p = 0; p < pixels; p++) invalid += ec_sums_add_pixel(s, batch + EC_BATCH_FIELDS * p, replicate, share, p);
    return invalid;
}

void ec_sums_add_feature(const ec_sums *s, const float *features, uint32_t set, double share, uint64_t pixel)
{
    float *mean = ec_sums_features(s, set, pixel);
    for (int c = 0; c < EC_FILM_FEATURES; c++) move(mean + c, isfinite(features[c]) ? features[c] : 0, share);
}

void ec_sums_add_features(const ec_sums *s, const float *features, uint32_t set, double share, uint64_t pixels)
{
#pragma omp parallel for if (ec_film_is_many(pixels))
    for (uint64_t p = 0; p < pixels; p++) ec_sums_add_feature(s, features + EC_FILM_FEATURES * p, set, share, p);
}

void ec_sums_join(const ec_sums *into, const ec_sums *next, const double *share, const double set_share[2], uint64_t pixels)
{
    for (uint32_t k = 0; k < next->sets; k++)
        if (set_share[k] > 0) ec_sums_add_features(into, ec_sums_features(next, k, 0), k, set_share[k], pixels);
#pragma omp parallel for if (ec_film_is_many(pixels))
    for (uint64_t p = 0; p < pixels; p++) {
        for (uint32_t r = 0; r < into->replicates; r++)
            for (int c = 0; c < 3 && share[r] > 0; c++) move(ec_sums_mean(into, r, p) + c, ec_sums_mean(next, r, p)[c], share[r]);
        ec_sums_add_tail(into->tail + 3 * p, next->tail + 3 * p);
    }
}

void ec_sums_copy(const ec_sums *to, const ec_sums *from, uint64_t pixels)
{
    for (uint32_t r = 0; r < to->replicates; r++) memcpy(ec_sums_mean(to, r, 0), ec_sums_mean(from, r, 0), 3 * pixels * sizeof *to->mean);
    memcpy(to->tail, from->tail, 3 * pixels * sizeof *to->tail);
    for (uint32_t k = 0; k < from->sets; k++)
        memcpy(ec_sums_features(to, k, 0), ec_sums_features(from, k, 0), EC_FILM_FEATURES * pixels * sizeof *to->features);
}
