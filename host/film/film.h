/* The image as it grows: replicates of each pixel (film/schedule.h), the spread of whose means is the pixel's error. film/parts.h and film/sums.h say
 * how they are kept, film/pixel.h what they say of a pixel.
 *
 * Image error (the manual's definition). With R replicates, pixel p's luminance has standard error SE_p = s_p / sqrt(R), s_p the spread of
 * the replicates' means, and
 *     error = sqrt(mean_p SE_p^2) / mean luminance
 * error_bound is a 95 % upper confidence bound of the relative RMS difference between this image and the converged one.
 * See film/image_error.c for its derivation, film/interval.h for the error of single pixels. */
#ifndef EC_FILM_FILM_H
#define EC_FILM_FILM_H

#include "base/error.h"
#include "base/luminance.h"
#include "film/layers.h"
#include "film/matte.h"
#include "film/parts.h"
#include "film/rare.h"
#include "film/tail.h"

/* A denoiser's result for a film (host/denoise): 3, 3 and 1 floats a pixel, rows from the top. All NULL: none was asked for. */
typedef struct ec_film_clean {
    float *denoised, *best; /* radiance: denoised throughout, and where that is nearer to the truth */
    float *error;           /* of the denoised luminance: estimated root mean square over the pixels around */
} ec_film_clean;

/* Returns the arrays from a pixel on. */
static inline ec_film_clean ec_film_clean_from(const ec_film_clean *c, uint64_t pixel)
{
    return c->best ? (ec_film_clean){c->denoised + 3 * pixel, c->best + 3 * pixel, c->error + pixel} : (ec_film_clean){0};
}

typedef struct ec_film {
    uint32_t width, height, replicates;
    uint32_t batch_count;         /* batches that all pixels have */
    uint32_t cut;                 /* samples that the last batch lacks: the picture ended within it. No batch comes after that */
    uint32_t *counts;             /* of adaptive renders: samples of each replicate of each pixel; else NULL. Owned */
    double samples[EC_REPLICATES_MOST]; /* of each replicate, in pixels without counts */
    float limit;                  /* of the luminance of a sample's indirect light (film/clamp.h); 0: none */
    uint64_t invalid_count;       /* values that were NaN or infinite and counted as 0 */
    uint32_t feature_sets;        /* of first-hit features (film/sums.h): 2, so that each half has its own for a denoiser; 0: none are wanted … */
    uint32_t feature_end;         /* … else batches before this one have them; if it is UINT32_MAX, also samples that pixels get by themselves */
    float *shadow;                /* least alpha of each pixel, for shadows on what cannot be seen itself; NULL: none. Owned */
    /* Set only where the render was stopped within its first batch: 1 for pixels that have no sample. malloc'ed. */
    uint8_t *unsampled;
    ec_sums room;                 /* zeros for the first batch (ec_film_make_room), owned; all NULL if none was made, or the batch has taken it */
    ec_film_part *parts;          /* by `first`, no two with batches in common; a single one where pixels have counts. Owned */
    uint32_t part_count;
    ec_film_clean clean;          /* owned; of the samples that there were when it was made */
    ec_layers layers;             /* that the picture has beside its radiance … */
    struct ec_film *layer_films;  /* … and a film of each (film/layer_films.h); NULL: none. Owned */
    struct ec_film *light;        /* what light paths bring, where it is kept apart: all pixels have its samples, and it is added to their values.
                                   * NULL: it is not. Owned */
    ec_matte matte;               /* what its samples meet, where layers has mattes; else zeros. Owned */
    ec_rare *rare;                /* light that hardly any sample meets; NULL: there is none, or it was not looked for. Owned */
} ec_film;

ec_result ec_film_create(ec_film *film, uint32_t width, uint32_t height, uint32_t replicates, ec_error *err);
void ec_film_destroy(ec_film *film); /* zero-initialised or destroyed films are fine */

/* Keeps what light paths bring in a film of its own from now on. */
ec_result ec_film_part_light(ec_film *film, ec_error *err);

/* Takes `clean`, which the film then owns, in place of what it had; zeros: none. */
void ec_film_set_clean(ec_film *film, ec_film_clean clean);

/* Takes a copy of `rare` in place of what the film had; NULL: none. */
ec_result ec_film_set_rare(ec_film *film, const ec_rare *rare, ec_error *err);

/* Asks for first-hit features in `sets` sets, of batches before `end`. */
void ec_film_want_features(ec_film *film, uint32_t sets, uint32_t end);

typedef struct ec_film_batch {
    uint32_t index;
    uint32_t cut;          /* samples that it lacks: it is the last one */
    const float *values;   /* EC_BATCH_FIELDS a pixel */
    const float *features; /* EC_FILM_FEATURES a pixel; NULL: it brings none */
    uint64_t missing;      /* pixels at the end of a first batch in which the picture was stopped: nothing is known of them */
} ec_film_batch;

/* Adds a batch that the film does not have yet; the order in which batches come makes no difference. Values that are not finite count as 0, and
 * features that the film does not want are ignored. Not allowed where pixels have counts. */
ec_result ec_film_take(ec_film *film, const ec_film_batch *batch, ec_error *err);

/* Likewise, for a batch without features. */
ec_result ec_film_add(ec_film *film, uint32_t index, const float *batch, ec_error *err);

/* Sets by how many samples the last batch is short, of a film whose parts are all there. */
void ec_film_set_cut(ec_film *film, uint32_t cut);

/* Returns how many sets of features a part has that begins with batch `first`. */
uint32_t ec_film_sets(const ec_film *film, uint64_t first);

/* Returns the samples of a pixel that features are averaged over, of those that all pixels have; 0: there are no features. */
double ec_film_feature_samples(const ec_film *film);

/* Writes the features of the replicates of one half, 0 the even ones and 1 the odd ones, where halves are kept apart, else of all; EC_BOTH_HALVES: of
 * all. EC_FILM_FEATURES floats a pixel; zeros where there are none. */
enum { EC_BOTH_HALVES = 2 };
void ec_film_features_of(const ec_film *film, uint32_t half, uint64_t first, uint64_t count, float *out);

/* Returns the features of all replicates from pixel `first` on if the film holds them in that form; NULL: ec_film_features_of puts them together. */
const float *ec_film_features_at(const ec_film *film, uint64_t first);

/* Allocates memory for pixels [from, to) of the first batch before it is added, and writes to each page: new memory is most of the time that adding
 * takes, and a stop within the batch would wait for it (2.2 of 2.5 s at 8192x4096). If there is none, adding reports it. */
void ec_film_make_room(ec_film *film, uint64_t from, uint64_t to);

/* Adds a part, whose memory the film takes on success. */
ec_result ec_film_insert(ec_film *film, ec_film_part *part, ec_error *err);

/* Returns the sums of a film that is a single part, which the caller owns; the film may only be destroyed then. */
ec_sums ec_film_give_sums(ec_film *film);

/* Adds all parts of another film of the same size and with the same layers and sets of features; `from` is then fit to be destroyed
 * only. Fails where both have a batch, and then has changed nothing but for lack of memory. */
ec_result ec_film_take_parts(ec_film *film, ec_film *from, ec_error *err);

void ec_film_part_free(ec_film_part *part);

/* Creates a film of `rows` rows that can hold what `like` holds of as many. */
ec_result ec_film_create_like(ec_film *film, const ec_film *like, uint32_t rows, ec_error *err);

/* Copies rows [first, first + rows) of `from` over those from `to` on of a film made like it. Marks of unsampled pixels are left out. */
void ec_film_copy_rows(ec_film *film, uint32_t to, const ec_film *from, uint32_t first, uint32_t rows);

/* The number of the next batch. */
static inline uint32_t ec_film_end(const ec_film *film)
{
    const ec_film_part *last = film->part_count ? &film->parts[film->part_count - 1] : NULL;
    return last ? last->first + last->count : 0;
}

/* Adds samples to some pixels: entry i is `samples` more samples of pixel places[i], replicate i % R. Each pixel comes with all its replicates, 0
 * first, once or several times, and all its entries one after the other. batch, features: of each entry, as in ec_film_batch of each pixel. From
 * now on pixels have counts of their own. */
ec_result ec_film_add_some(ec_film *film, const float *batch, const float *features, const uint32_t *places, uint32_t count, uint32_t samples,
                           ec_error *err);

/* Returns how many replicates have samples. */
static inline uint32_t ec_film_replicates(const ec_film *film)
{
    uint32_t count = 0;
    for (uint32_t r = 0; r < film->replicates; r++) count += film->samples[r] > 0;
    return count;
}

/* Return the samples of a pixel, and those that all pixels have. */
double ec_film_samples(const ec_film *film, uint64_t p);
double ec_film_samples_of_all(const ec_film *film);

typedef struct ec_film_error {
    double mean_luminance;   /* of the image */
    /* Relative RMS standard error. Infinity with fewer than 2 replicates, and for a black image: its relative error is
     * undefined, and having seen no light yet is no evidence that there is none. 0 only for a lit image whose replicates
     * all agree. Never NaN. */
    double error;
    double error_bound;      /* 95 % upper bound; infinity when error is, and where light may be missing. Wants 4 replicates or more, see film/image_error.c */
    bool is_open;            /* light that hardly any sample has met may decide: there is no bound, and `error` is the least that it is */
    double bound_if_met;     /* what the bound would be if no light were missing */
    double missing_light;    /* relative RMS error if the light that samples may have missed is missing (film/rare.h) */
    double missing_light_samples; /* samples a pixel until EC_RARE_MET of those paths are expected; 0: nothing is missing */
    double tail_share;       /* part of the noise that the EC_TAIL_FEW largest samples hold */
    char through[EC_RARE_NAME], light[EC_RARE_NAME]; /* of the rare paths; through is empty where the camera sees the light itself */
    double noisy_pixels;     /* how many pixels of equal noise would tell as much of it: nu of film/image_error.c */
    double bright_samples;   /* how many equal ones would make the noise as the largest few do: few where single samples decide; infinite where none stands out */
    double larger;           /* error of samples larger than any yet that may exist and did not come, over `error` */
    double larger_falls;     /* with n times as many samples it is that over n to this power */
    double spread;           /* standard error of ln(error^2); over 0.3 a few rare events decide */
    /* The part of noise in mean((x - r)^2 / (r + 0.01)^2) over pixels and channels, r the converged image: SE^2 in
     * place of (x - r)^2, x in place of r. Infinity with fewer than 2 replicates. Heavy tails make it too small: a pixel that
     * is bright by chance divides by too much. */
    double relmse;
} ec_film_error;
ec_film_error ec_film_estimate_error(const ec_film *film);

/* The sums that an image's error is computed from: over its pixels in row order, so that films that follow one another downwards, added one after the other,
 * give the bits of the whole. Begin with zeros. */
typedef struct ec_error_sums {
    double luminance, s2, s4; /* s2: s^2 / n, the variance of a pixel's mean */
    double relative;          /* of SE^2 / (x + 0.01)^2, all channels */
    double samples;
    double largest;           /* variance of a pixel's mean, R, G or B */
    ec_tail tail, single;     /* by how much the largest sample of each pixel moved its mean; of pixels with one bright sample */
    double v4, v8;            /* of unbiased estimates of v^2, and of their squares (n >= 4) or those of s^8 (n < 4) */
    double u2, u4;            /* of the variance of a pixel's mean as its single samples tell it, and of its square */
} ec_error_sums;
void ec_film_sum_errors(const ec_film *film, ec_error_sums *sums);

/* Like ec_film_estimate_error; *sums: what the error is made of. */
ec_film_error ec_film_look_at_error(const ec_film *film, ec_error_sums *sums);

/* Returns the error of `pixels` pixels that have `replicates` replicates each. rare, limit: as in ec_film. */
ec_film_error ec_film_error_of(const ec_error_sums *sums, double pixels, uint32_t replicates, const ec_rare *rare, double limit);

/* Returns the bound of an error whose square is `square`; other parameters are as in ec_film_error. */
double ec_film_error_bound(double square, double noisy_pixels, double bright_samples, double larger, double pixels, double replicates);

/* Keeps relMSE finite on black: as in pbrt's imgtool (metric MRSE), so that figures compare. */
#define EC_RELMSE_FLOOR 0.01

#endif
