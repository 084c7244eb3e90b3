/* The order in which batches are added up, so that whoever adds them, in whatever order they come, gets the same bits.
 *
 * Batches are numbered from 0 (film/schedule.h). EC_FILM_FIRST of them, from a multiple of that on, are taken in one after the other; 16 such
 * sums, from a multiple of as many batches on, are joined one after the other; and so on. What has no left neighbour to be joined to yet
 * waits as a part of its own: a single batch as it is, 24 bytes a pixel and 32 of features, else a sum (film/sums.h). A pixel of the film is the parts' average
 * from left to right (film/pixel.h).
 *
 * Batches 0 to B therefore take 1 sum up to EC_FILM_FIRST batches, else at most one more for each factor of 16. Batches from elsewhere on
 * wait for their left neighbours: up to EC_FILM_FIRST - 1 batches, 15 sums of so many, 15 of 16 times as many. */
#ifndef EC_FILM_PARTS_H
#define EC_FILM_PARTS_H

#include "film/sums.h"

#define EC_FILM_RADIX 16u
#define EC_FILM_FIRST 128u /* 16 strides of 8 replicates: 512 samples a pixel */

typedef struct ec_film_part {
    uint32_t first, count; /* batches; these two say what has been joined in which order */
    double samples[EC_REPLICATES_MOST]; /* of each replicate; set by the film */
    double set_samples[2]; /* that each set of features is the mean of; likewise */
    ec_sums sums;          /* of parts that are not kept as a single batch */
    float *batch;          /* of a single one with batches to its left, owned: EC_BATCH_FIELDS a pixel, finite; else NULL */
    float *features;       /* of such a one, owned: EC_FILM_FEATURES a pixel; NULL: it has none */
} ec_film_part;

/* Returns whether a part is a single batch that is kept as it is. A batch that begins a sum becomes one at once. */
static inline bool ec_film_part_is_batch(uint32_t first, uint32_t count)
{
    return count == 1 && first % EC_FILM_FIRST;
}

/* Returns whether `right` may be joined to `left`. */
bool ec_film_parts_fit(const ec_film_part *left, const ec_film_part *right);

/* Returns whether a part of these batches is possible; for parts that come from a file. */
bool ec_film_part_is_sound(uint64_t first, uint64_t count);

/* Returns how many bytes a pixel batches [first, end) take at most, with so many sets of features. */
uint64_t ec_film_bytes(uint32_t replicates, uint32_t sets, uint64_t first, uint64_t end);

#endif
