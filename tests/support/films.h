/* Films of plain values. Each R, G, B becomes a batch whose samples are all equal or, in the first stride, a single sample. A film of R
 * replicates and R such batches has R independent values a pixel, from which its errors follow. */
#ifndef EC_TESTS_SUPPORT_FILMS_H
#define EC_TESTS_SUPPORT_FILMS_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/pixel.h"

/* rgb: 3 a pixel; batch: EC_BATCH_FIELDS a pixel. The tail is that of one sample: squares and fourth powers are 1 where it is lit. */
static inline void films_lay_out(const float *rgb, uint64_t pixels, float *batch)
{
    for (uint64_t p = 0; p < pixels; p++) {
        const float *from = rgb + 3 * p;
        const double y = ec_luminance((double[3]){from[0], from[1], from[2]});
        float *to = batch + EC_BATCH_FIELDS * p;
        for (int c = 0; c < 3; c++) to[c] = from[c];
        to[EC_BATCH_LARGEST] = isfinite(y) && y > 0 ? (float)y : 0;
        to[EC_BATCH_SQUARES] = to[EC_BATCH_FOURTHS] = to[EC_BATCH_LARGEST] > 0;
    }
}

/* Batch `index` of the film, `cut` samples short; rgb: 3 a pixel, features: EC_FILM_FEATURES, or NULL. */
static inline ec_result films_add_with(ec_film *film, uint32_t index, uint32_t cut, const float *rgb, const float *features, ec_error *err)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
    float *batch = malloc(pixels * EC_BATCH_FIELDS * sizeof *batch);
    if (!batch) return ec_fail(err, "out of memory");
    films_lay_out(rgb, pixels, batch);
    const ec_result result = ec_film_take(film, &(ec_film_batch){.index = index, .cut = cut, .values = batch, .features = features}, err);
    free(batch);
    return result;
}

static inline ec_result films_add(ec_film *film, uint32_t index, const float *rgb, ec_error *err)
{
    return films_add_with(film, index, 0, rgb, NULL, err);
}

static inline ec_pixel films_pixel(const ec_film *film, uint64_t p)
{
    ec_pixel pixel;
    ec_film_look(film, p, 1, &pixel);
    return pixel;
}

/* Compares all figures of all pixels bit for bit. The layout in parts may differ. */
static inline bool films_same_bits(const ec_film *a, const ec_film *b)
{
    const uint64_t pixels = (uint64_t)a->width * a->height;
    bool same = a->width == b->width && a->height == b->height && a->batch_count == b->batch_count && a->cut == b->cut;
    for (uint64_t p = 0; same && p < pixels; p++) {
        const ec_pixel x = films_pixel(a, p), y = films_pixel(b, p);
        for (int c = 0; c < 4; c++) same &= x.m2[c] == y.m2[c] && (c == 3 || (x.mean[c] == y.mean[c] && x.tail[c] == y.tail[c]));
        same &= x.m3 == y.m3 && x.m4 == y.m4 && x.n == y.n && x.samples == y.samples;
    }
    return same;
}

/* Compares the features too, in halves and as a whole. */
static inline bool films_same_features(const ec_film *a, const ec_film *b)
{
    const uint64_t pixels = (uint64_t)a->width * a->height;
    bool same = ec_film_feature_samples(a) == ec_film_feature_samples(b);
    for (uint64_t p = 0; same && p < pixels; p++)
        for (uint32_t half = 0; half < 3; half++) {
            float x[EC_FILM_FEATURES], y[EC_FILM_FEATURES];
            ec_film_features_of(a, half, p, 1, x);
            ec_film_features_of(b, half, p, 1, y);
            same &= !memcmp(x, y, sizeof x);
        }
    return same;
}

#endif
