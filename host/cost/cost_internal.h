/* Shared by the files of cost/. */
#ifndef EC_COST_COST_INTERNAL_H
#define EC_COST_COST_INTERNAL_H

#include <cjson/cJSON.h>

#include "cost/cost.h"
#include "render/session.h"

/* Streams of random numbers: the reference's differs from those of all rungs. */
enum { EC_COST_STREAM_REFERENCE = 1, EC_COST_STREAM_RUNGS = 2 };

typedef struct ec_cost_sum {
    double sum, square;
} ec_cost_sum;

/* tally.c: compares pictures of a rung with the reference. Levels ascend: pictures of n samples, then of 2 n. */
typedef struct ec_cost_tally {
    uint64_t pixels;
    const ec_cost_reference *reference;
    double *mean, *m2;           /* 1 per pixel: luminance of the level's pictures (Welford) */
    double *sum, *sum_variance;  /* 1 per pixel: of all samples of finished levels, and its variance */
    double samples;              /* number of samples in sum */
    uint32_t level_samples, level_batches;
    ec_cost_sum mse, relmse;     /* sums over the level's pictures and pixels */
} ec_cost_tally;
ec_result ec_cost_tally_create(const ec_cost_reference *reference, uint64_t pixels, ec_cost_tally *tally, ec_error *err);
void ec_cost_tally_free(ec_cost_tally *tally);
void ec_cost_tally_begin(ec_cost_tally *tally, uint32_t samples);
void ec_cost_tally_add(ec_cost_tally *tally, const float *rgb);
/* Adds a point to the row, and the level's variance; a level of one picture gives only a point. */
void ec_cost_tally_end(ec_cost_tally *tally, ec_cost_row *row);
void ec_cost_tally_bias(const ec_cost_tally *tally, ec_cost_row *row);

/* fit.c: computes efficiency, seconds_to and the slope of a row from its points. */
void ec_cost_conclude(ec_cost_row *row);

/* reference.c */
ec_result ec_cost_reference_render(ec_cost_study *study, double deadline, ec_error *err);
ec_result ec_cost_reference_read(ec_cost_study *study, ec_error *err);
/* Makes the reference of a film with two or more replicates, whose spread gives its error. */
ec_result ec_cost_reference_of(const ec_film *film, ec_cost_reference *reference, ec_error *err);
void ec_cost_reference_free(ec_cost_reference *reference);

/* A session, and what is known of its speed. */
typedef struct ec_cost_runner {
    ec_cost_study *study;
    ec_session *session;
    float *mean;                 /* 3 per pixel, owned: the last picture */
    float *room;                 /* as large, for one of its replicates */
    double seconds_per_sample;   /* latest estimate */
    bool denoises;
    uint32_t replicates;         /* number in a picture */
    double denoise_seconds;      /* for all pictures so far … */
    uint32_t denoised;           /* … and their number */
    uint64_t pixels, invalid;
    bool stopped;                /* a picture was interrupted */
} ec_cost_runner;
/* Sets up a rung, including edits of the scene, and takes a picture of 1 sample, so that kernels are compiled. *setup: the seconds it took. */
ec_result ec_cost_runner_open(ec_cost_study *study, const ec_cost_rung *rung, ec_cost_runner *runner, ec_render_stats *stats,
                              double *setup, ec_error *err);
void ec_cost_runner_close(ec_cost_runner *runner);

/* Returns the seconds of denoising a picture, as far as known, which come on top of those of its samples. */
static inline double ec_cost_runner_beside(const ec_cost_runner *r) { return r->denoised ? r->denoise_seconds / r->denoised : 0; }
ec_result ec_cost_runner_take(ec_cost_runner *runner, uint32_t seed, uint32_t samples, double *seconds, ec_error *err);

/* denoised.c: the same for a rung that denoises: takes the best of both pictures; *seconds are those of its samples. */
ec_result ec_cost_denoised_take(ec_cost_runner *runner, uint32_t seed, uint32_t samples, bool (*go_on)(void *study), double *seconds,
                                ec_error *err);

/* measure.c: measures one rung within `share` seconds, and not beyond the time `latest`. */
typedef struct ec_cost_base {
    ec_cost_runner runner;
    double seconds_per_sample;   /* of the base in its own turn; relative times are multiples of it */
    uint32_t pair_samples;       /* samples per pixel of a picture that is timed in turns */
    uint8_t *bits;               /* the picture whose bits are compared: 3 floats per pixel; owned */
} ec_cost_base;
ec_result ec_cost_measure(ec_cost_study *study, ec_cost_base *base, ec_cost_row *row, double share, double latest, ec_error *err);

/* pictures.c: makes {"reference": uri, id of each rung: [picture, error map], "stages": {id: [picture or null for each point]}}, with data URIs of
 * small PNG files. The stages are shrunk so that they have at most EC_COST_STAGE_PIXELS together: some 6 MB of a page. */
enum { EC_COST_STAGE_PIXELS = 1500000 };
ec_result ec_cost_pictures(const ec_cost_study *study, cJSON **images, ec_error *err);

/* runner.c: returns false when the user wants to stop */
bool ec_cost_go_on(void *study);

#endif
