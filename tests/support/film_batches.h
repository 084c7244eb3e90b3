/* Small films of repeatable batches.
 *
 *     replicates = 3, sets = 1;                    of the films made from here on
 *     ec_film film = empty(), part = slice(4, 9);  of batches 4 to 8
 *     add(&film, 17, 0, &err);                     batch 17, whole
 *     ec_film_destroy(&film); */
#ifndef EC_TESTS_SUPPORT_FILM_BATCHES_H
#define EC_TESTS_SUPPORT_FILM_BATCHES_H

#include "support/films.h"
#include "support/random.h"
#include "support/test.h"

enum { W = 3, H = 2, P = W * H, FIELDS = EC_BATCH_FIELDS * P };

static uint32_t replicates = EC_REPLICATES, sets, feature_end = UINT32_MAX;

/* Fills batch k of any film. Values are heavy-tailed and far from 0, where sums in another order round differently. */
static inline const float *batch_of(uint32_t k)
{
    static float batch[FIELDS];
    for (uint32_t i = 0; i < P; i++) {
        float *to = batch + EC_BATCH_FIELDS * i, *tail = to + EC_BATCH_LARGEST;
        test_random own = {k * 1000003ull + i};
        test_uniform(&own);
        for (uint32_t c = 0; c < 3; c++) to[c] = (float)(10 * (3 * i + c) + 1 / (0.01 + test_uniform(&own)));
        tail[0] = (float)(ec_luminance((double[3]){to[0], to[1], to[2]}) * (1 + 3 * test_uniform(&own)));
        tail[2] = (float)(1 + test_uniform(&own));
        tail[1] = (float)(tail[2] + 2 * test_uniform(&own));
    }
    return batch;
}

static inline float feature(uint32_t k, uint32_t i) { return (float)(1 + (k * 31 + i * 7) % 97 / 97.0); }

/* Fills its features. */
static inline const float *features_of(uint32_t k)
{
    static float features[EC_FILM_FEATURES * P];
    for (uint32_t i = 0; i < EC_FILM_FEATURES * P; i++) features[i] = feature(k, i);
    return features;
}

static inline ec_result add(ec_film *film, uint32_t k, uint32_t cut, ec_error *err)
{
    return ec_film_take(film, &(ec_film_batch){.index = k, .cut = cut, .values = batch_of(k), .features = sets ? features_of(k) : NULL}, err);
}

static inline ec_film empty(void)
{
    ec_film film;
    ec_error err;
    CHECK_OK(ec_film_create(&film, W, H, replicates, &err), err);
    ec_film_want_features(&film, sets, feature_end);
    return film;
}

static inline ec_film slice(uint32_t first, uint32_t end)
{
    ec_film film = empty();
    ec_error err;
    for (uint32_t k = first; k < end; k++) CHECK_OK(add(&film, k, 0, &err), err);
    return film;
}

/* Bytes of the film for each pixel. */
static inline uint64_t bytes_of(const ec_film *film)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < film->part_count; i++) {
        const ec_film_part *part = &film->parts[i];
        bytes += part->batch ? 4 * EC_BATCH_FIELDS + (part->features ? 4 * EC_FILM_FEATURES : 0) : ec_sums_bytes(replicates, part->sums.sets);
    }
    return bytes;
}

#endif
