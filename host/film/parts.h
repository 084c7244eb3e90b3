/* The order in which batches are added up, so that whoever adds them, in whatever order they come, gets the same bits.
 *
 * Batches are numbered from 0. 16 of them, from a multiple of 16 on, are added one after the other (Welford); 16 such sums, from a multiple of
 * 256 on, are joined one after the other (Pebay); and so on. What has no left neighbour to be joined to yet waits as a part of its
 * own: a single batch as it is, 12 bytes a pixel, else a sum, 68. What the film shows is the parts joined from left to right.
 *
 * Batches 0 to B therefore take ceil(log16(B)) sums at most, and one more for what the film shows if there is more than one; a film
 * of up to 16 batches is one sum, as if there were no parts. Batches from elsewhere on wait for their left neighbours: up
 * to 15 batches, 15 sums of 16, 15 of 256. */
#ifndef EC_FILM_PARTS_H
#define EC_FILM_PARTS_H

#include "film/moments.h"

#define EC_FILM_RADIX 16

typedef struct ec_film_part {
    uint32_t first, count; /* batches; these two say what has been joined in which order */
    ec_moments sums;       /* of parts that are no single batch */
    float *batch;          /* of a single one with batches to its left, owned: 3 floats a pixel, finite; else NULL */
} ec_film_part;

/* Is a part of one batch kept as it is? One that begins 16 is a sum at once. */
static inline bool ec_film_part_is_batch(uint32_t first, uint32_t count)
{
    return count == 1 && first % EC_FILM_RADIX;
}

/* May `right` be joined to `left`? */
bool ec_film_parts_fit(const ec_film_part *left, const ec_film_part *right);

/* May a part of these batches be at all? For those that come from a file. */
bool ec_film_part_is_sound(uint64_t first, uint64_t count);

/* How many films' worth of memory batches 0 to `batches` take at most. */
uint32_t ec_film_copies(uint64_t batches);

/* Bytes a pixel that batches first to end, of a slice, take at most as they come in order. */
uint64_t ec_film_bytes(uint64_t first, uint64_t end);

#endif
