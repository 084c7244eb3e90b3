/* The image as it grows: per-pixel mean and standard error from independent batches, in double precision.
 * 68 bytes a pixel up to 16 batches; beyond that a sum of batches in an order that does not depend on who adds them: film/parts.h.
 *
 * Image error (the manual's definition). With B batches, pixel p's luminance has standard error SE_p = s_p / sqrt(B), and
 *     error = sqrt(mean_p SE_p^2) / mean luminance
 * error_bound is a 95 % upper confidence bound of the relative RMS difference between this image and the converged one.
 * See film/error.c for its derivation, film/interval.h for the error of single pixels. */
#ifndef EC_FILM_FILM_H
#define EC_FILM_FILM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "film/parts.h"

/* Relative luminance of linear Rec.709 colour (IEC 61966-2-1); the weights sum to 1. */
static inline double ec_luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

enum { EC_FILM_FEATURES = 8 };

typedef struct ec_film {
    uint32_t width, height;
    uint32_t batch_count;         /* B: batches that every pixel has */
    uint32_t *counts;             /* of adaptive renders: batches of each pixel, >= B; else NULL. Owned */
    uint32_t samples_per_batch;   /* the same for every batch */
    double *mean;                 /* 3 per pixel: mean of the batch means */
    double *m2;                   /* 4 per pixel: sum of squared deviations of R, G, B and luminance (Welford) */
    float *m34;                   /* 2 per pixel: sums of cubed and fourth-power deviations of luminance (Pebay 2008) */
    float *largest;               /* 1 per pixel: luminance of its brightest batch */
    uint64_t invalid_count;       /* values that were NaN or infinite and counted as 0 */
    /* First-hit features, from the first batch; may be NULL. albedo 3, normal 3, depth 1, alpha 1 per pixel.
     * ec_film_create leaves it NULL; whoever sets it mallocs it, ec_film_destroy frees it. */
    float *aov;                   /* EC_FILM_FEATURES per pixel */
    /* Set only where the render was stopped within its first batch: 1 for pixels that have no sample. malloc'ed. */
    uint8_t *unsampled;
    /* What mean, m2, m34 and largest are joined from, by `first`, no two with batches in common. None where pixels have counts. Owned;
     * a single sum is mean, m2, m34 and largest itself. */
    ec_film_part *parts;
    uint32_t part_count;
    bool shows_late;              /* ask for it, and mean, m2, m34 and largest follow only where ec_film_show is called */
    bool is_behind;               /* they have not followed yet */
} ec_film;

ec_result ec_film_create(ec_film *film, uint32_t width, uint32_t height, uint32_t samples_per_batch, ec_error *err);
void ec_film_destroy(ec_film *film); /* zero-initialised or destroyed films are fine */

/* Adds the next batch: 3 floats a pixel, each the mean over samples_per_batch samples. What is not finite counts as 0. */
ec_result ec_film_add_batch(ec_film *film, const float *batch_mean, ec_error *err);

/* The same of any batch that is not there yet: the order in which they come makes no difference. Not where pixels have counts. */
ec_result ec_film_add_at(ec_film *film, uint32_t index, const float *batch_mean, ec_error *err);

/* Adds a part, whose memory the film takes on success. */
ec_result ec_film_insert(ec_film *film, ec_film_part *part, ec_error *err);

/* The sums of a film that is a single part, to be owned; the film is then fit to be destroyed only. */
ec_moments ec_film_give_sums(ec_film *film);

/* Adds all parts of another film of the same size, and its first-hit features where there are none; `from` is then fit to be destroyed
 * only. Fails where both have a batch, and then has changed nothing but for lack of memory. */
ec_result ec_film_take_parts(ec_film *film, ec_film *from, ec_error *err);

/* Brings mean, m2, m34 and largest up to date where shows_late keeps them from it. */
void ec_film_show(ec_film *film);

/* The same sums of a few pixels, from `first` on; `glass` is room for them if need be. */
enum { EC_FILM_GLASS = 512 }; /* pixels at most */
typedef struct ec_film_glass {
    double mean[3 * EC_FILM_GLASS], m2[4 * EC_FILM_GLASS];
    float m34[2 * EC_FILM_GLASS], largest[EC_FILM_GLASS];
} ec_film_glass;
ec_moments ec_film_look(const ec_film *film, uint64_t first, uint64_t pixels, ec_film_glass *glass);

void ec_film_part_free(ec_film_part *part);

/* Some rows of what is shown as a film of their own, whose memory is that of the whole: not to be added to, nor destroyed. */
ec_film ec_film_rows(const ec_film *film, uint32_t first, uint32_t rows);

/* Rows [first, first + rows) of a film that is shown over those from `to` on of one made by ec_film_create, as wide; first-hit features too
 * where both have them. Counts and marks are left out. */
void ec_film_copy_rows(ec_film *film, uint32_t to, const ec_film *from, uint32_t first, uint32_t rows);

/* What is shown stays; it can no longer be joined with other batches' sums. */
void ec_film_drop_parts(ec_film *film);

/* The number of the next batch. */
static inline uint32_t ec_film_end(const ec_film *film)
{
    const ec_film_part *last = film->part_count ? &film->parts[film->part_count - 1] : NULL;
    return last ? last->first + last->count : 0;
}

/* The same of some pixels only: of places[i], in row order, 3 floats at 3 i; a pixel may take part more than once. From now on pixels
 * have counts of their own. */
ec_result ec_film_add_some(ec_film *film, const float *means, const uint32_t *places, uint32_t count, ec_error *err);

static inline uint32_t ec_film_batches(const ec_film *film, uint64_t p)
{
    return film->counts ? film->counts[p] : film->batch_count;
}

typedef struct ec_film_error {
    double mean_luminance;   /* of the image */
    /* Relative RMS standard error. Infinity with fewer than 2 batches, and for a black image: its relative error is
     * undefined, and having seen no light yet is no evidence that there is none. 0 only for a lit image whose batches
     * all agree. Never NaN. */
    double error;
    double error_bound;      /* 95 % upper bound; infinity when error is. Wants 4 batches or more, see film/error.c */
    double noisy_pixels;     /* how many pixels of equal noise would tell as much of it: nu of film/error.c */
    double spread;           /* standard error of ln(error^2); over 0.3 a few rare events decide */
    /* What noise alone makes of mean((x - r)^2 / (r + 0.01)^2) over pixels and channels, r the converged image: SE^2 in
     * place of (x - r)^2, x in place of r. Infinity with fewer than 2 batches. Heavy tails make it too small: a pixel that
     * is bright by chance divides by too much. */
    double relmse;
} ec_film_error;
ec_film_error ec_film_estimate_error(const ec_film *film);

/* What an image's error is made of: sums over its pixels in row order, so that films which follow one another downwards, taken one after
 * the other, come to the bits of the whole. Begin with zeros. */
typedef struct ec_error_sums {
    double luminance, s2, s4; /* s2: s^2 / n, the variance of a pixel's mean */
    double ratio;             /* of s^4 n / (n - 1) */
    double relative;          /* of SE^2 / (x + 0.01)^2, all channels */
    double v4, v8;            /* of unbiased estimates of v^2, and of their squares (n >= 4) or those of s^8 (n < 4) */
} ec_error_sums;
void ec_film_sum_errors(const ec_film *film, ec_error_sums *sums);

/* The same of so many pixels that have `batches` batches each; varied: they have counts of their own, and at least these. */
ec_film_error ec_film_error_of(const ec_error_sums *sums, double pixels, uint32_t batches, bool varied);

/* The bound of an error whose square is `square`, after so many batches. */
double ec_film_error_bound(double square, double noisy_pixels, double pixels, double batches);

/* Keeps relMSE finite on black: as in pbrt's imgtool (metric MRSE), so that figures compare. */
#define EC_RELMSE_FLOOR 0.01

/* Float planes for output: rgb 3 per pixel, stderr 3 per pixel (0 with fewer than two batches). Either may be NULL. */
void ec_film_resolve(const ec_film *film, float *rgb, float *stderr_rgb);

/* The same of luminance: 1 per pixel. */
void ec_film_resolve_luminance_error(const ec_film *film, float *stderr_y);

/* Student's t quantile: P(T <= t) = p with nu degrees of freedom. */
double ec_student_t_quantile(double p, double nu);

#endif
