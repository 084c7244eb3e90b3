/* Sums of batches: for each pixel and replicate the mean radiance of its samples, for each pixel the tail of all samples, and first-hit features
 * where they are wanted. 12 R + 12 bytes a pixel, and 32 for each set of features. Means in float take one rounding a batch; film/parts.h keeps the
 * chain of roundings short. */
#ifndef EC_FILM_SUMS_H
#define EC_FILM_SUMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "film/schedule.h"
#include "shared/params.h"

enum { EC_FILM_ALPHA = 7, EC_FILM_FEATURES }; /* features of a first hit: albedo 3, normal 3, depth 1, alpha 1 */

typedef struct ec_sums {
    uint32_t replicates; /* R */
    uint32_t sets;       /* of features: 0 none, 1 the mean over all replicates, 2 over even ones and over odd ones */
    uint64_t stride;     /* pixels from one replicate's to the next's: those without samples take no memory until they have some */
    float *mean;         /* by replicate, 3 a pixel: R, G, B; 0 of replicates without samples */
    float *tail;         /* 3 a pixel: of the samples' luminance the largest, and the sums of squares and fourth powers in units of that */
    float *features;     /* by set, EC_FILM_FEATURES a pixel: the mean over samples; NULL where there are no sets */
} ec_sums;

static inline float *ec_sums_mean(const ec_sums *s, uint32_t replicate, uint64_t pixel)
{
    return s->mean + 3 * (replicate * s->stride + pixel);
}

static inline float *ec_sums_features(const ec_sums *s, uint32_t set, uint64_t pixel)
{
    return s->features + EC_FILM_FEATURES * (set * s->stride + pixel);
}

static inline uint64_t ec_sums_bytes(uint32_t replicates, uint32_t sets) { return 12ull * replicates + 12 + 4ull * EC_FILM_FEATURES * sets; } /* a pixel */
static inline uint64_t ec_batch_bytes(uint32_t sets) { return 4ull * (EC_BATCH_FIELDS + (sets ? EC_FILM_FEATURES : 0)); } /* likewise, of a batch as it is */

/* Creates sums of zeros; returns false if there is no memory. */
bool ec_sums_create(ec_sums *sums, uint32_t replicates, uint32_t sets, uint64_t pixels);
void ec_sums_destroy(ec_sums *sums); /* zero-initialised or destroyed is fine */

/* A view of the pixels from `first` on; owns nothing. */
static inline ec_sums ec_sums_from(const ec_sums *s, uint64_t first)
{
    return (ec_sums){s->replicates, s->sets, s->stride, s->mean + 3 * first, s->tail + 3 * first, s->sets ? s->features + EC_FILM_FEATURES * first : NULL};
}

/* Returns sums that lie one array after the other in memory that they do not own, ec_sums_bytes a pixel: as they are sent. */
ec_sums ec_sums_in(void *memory, uint32_t replicates, uint32_t sets, uint64_t pixels);

/* Adds a batch, EC_BATCH_FIELDS floats a pixel. share: the batch's part of the replicate's samples. Values that are not finite count as 0; returns
 * how many there are. */
uint64_t ec_sums_add(const ec_sums *sums, const float *batch, uint32_t replicate, double share, uint64_t pixels);

/* Likewise, for one pixel. */
uint32_t ec_sums_add_pixel(const ec_sums *sums, const float *batch, uint32_t replicate, double share, uint64_t pixel);

/* Adds a batch's features to a set, EC_FILM_FEATURES floats a pixel. share: the batch's part of the set's samples. */
void ec_sums_add_features(const ec_sums *sums, const float *features, uint32_t set, double share, uint64_t pixels);

/* Likewise, for one pixel. */
void ec_sums_add_feature(const ec_sums *sums, const float *features, uint32_t set, double share, uint64_t pixel);

/* Joins `next` to `into`. share: the part of each replicate's samples that is `next`'s; set_share: likewise of each set of features. */
void ec_sums_join(const ec_sums *into, const ec_sums *next, const double *share, const double set_share[2], uint64_t pixels);

/* Joins two tails of the same pixel, both of which have light. */
void ec_sums_join_tails(float into[3], const float next[3]);

/* Likewise, for any two. */
static inline void ec_sums_add_tail(float into[3], const float next[3])
{
    if (!(next[0] > 0)) return;
    if (into[0] > 0) ec_sums_join_tails(into, next);
    else for (int i = 0; i < 3; i++) into[i] = next[i];
}

void ec_sums_copy(const ec_sums *to, const ec_sums *from, uint64_t pixels);

#endif
