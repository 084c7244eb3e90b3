/* Counts how many samples of each pixel have met which node and which material: whole numbers, the same in whatever order batches come. Cryptomatte
 * (Friedman and Jones, specification 1.2) is made of them: the names that most of a pixel's samples meet, by hash, and the shares that they have. */
#ifndef EC_FILM_MATTE_H
#define EC_FILM_MATTE_H

#include "base/error.h"
#include "film/layers.h"
#include "film/matte_log.h"

enum { EC_MATTE_FLOATS = 2 * EC_MATTE_RANKS, EC_MATTE_BYTES = 80 /* of a pixel, about: 4 + 16 for each thing that it sees, and as much in the log */ };

typedef struct ec_matte_seen {
    uint32_t next; /* next entry of its pixel, as in ec_matte.first */
    uint32_t node, material, samples;
} ec_matte_seen;

typedef struct ec_matte {
    uint32_t *first; /* by pixel: its first entry's number plus 1; 0: there is none. Owned */
    ec_matte_seen *seen; /* owned */
    uint64_t count, room;
} ec_matte;

ec_result ec_matte_create(ec_matte *matte, uint64_t pixels, ec_error *err);
void ec_matte_free(ec_matte *matte); /* zero-initialised ones are fine */

/* Adds what a batch has met. places: pixels of its positions; NULL: positions are pixels. */
ec_result ec_matte_take(ec_matte *matte, const ec_matte_log *log, const uint32_t *places, ec_error *err);

/* Writes EC_MATTE_RANKS times a hash and its coverage, for a pixel that has so many samples: the largest coverage first, of equal ones the lowest hash; 0
 * where there is nothing. */
void ec_matte_pixel(const ec_matte *matte, const ec_layers *layers, enum ec_matte_kind kind, uint64_t pixel, double samples, float *out);

#endif
