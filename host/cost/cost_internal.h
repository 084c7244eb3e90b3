/* Between the files of cost/. */
#ifndef EC_COST_COST_INTERNAL_H
#define EC_COST_COST_INTERNAL_H

#include <cjson/cJSON.h>

#include "cost/cost.h"
#include "render/session.h"

/* Streams of random numbers: the reference's is none of the rungs'. */
enum { EC_COST_STREAM_REFERENCE = 1, EC_COST_STREAM_RUNGS = 2 };

typedef struct ec_cost_sum {
    double sum, square;
} ec_cost_sum;

/* tally.c: pictures of a rung against the reference. Levels go up: pictures of n samples, then of 2 n. */
typedef struct ec_cost_tally {
    uint64_t pixels;
    const ec_cost_reference *reference;
    double *mean, *m2;           /* 1 a pixel: luminance of the level's pictures (Welford) */
    double *sum, *sum_variance;  /* 1 a pixel: of all samples of finished levels, and its variance */
    double samples;              /* in sum */
    uint32_t level_samples, level_batches;
    ec_cost_sum mse, relmse;     /* over the level's pictures and pixels */
} ec_cost_tally;
ec_result ec_cost_tally_create(const ec_cost_reference *reference, uint64_t pixels, ec_cost_tally *tally, ec_error *err);
void ec_cost_tally_free(ec_cost_tally *tally);
void ec_cost_tally_begin(ec_cost_tally *tally, uint32_t samples);
void ec_cost_tally_add(ec_cost_tally *tally, const float *rgb);
/* Adds a point to the row, and the level's variance; a level of one picture gives a point and nothing else. */
void ec_cost_tally_end(ec_cost_tally *tally, ec_cost_row *row);
void ec_cost_tally_bias(const ec_cost_tally *tally, ec_cost_row *row);

/* fit.c: efficiency, seconds_to and the slope of a row whose points are there */
void ec_cost_conclude(ec_cost_row *row);

/* reference.c */
ec_result ec_cost_reference_render(ec_cost_study *study, double deadline, ec_error *err);
ec_result ec_cost_reference_read(ec_cost_study *study, ec_error *err);
/* The film has two replicates or more, whose spread is the reference's own error. */
ec_result ec_cost_reference_of(const ec_film *film, ec_cost_reference *reference, ec_error *err);
void ec_cost_reference_free(ec_cost_reference *reference);

/* A session and what is known of its speed. */
typedef struct ec_cost_runner {
    ec_cost_study *study;
    ec_session *session;
    float *mean;                 /* 3 a pixel, owned: the last picture */
    float *room;                 /* as much, for a replicate of it */
    double seconds_per_sample;   /* the last estimate */
    bool denoises;
    uint32_t replicates;         /* of a picture */
    double denoise_seconds;      /* of all pictures so far … */
    uint32_t denoised;           /* … so many */
    uint64_t pixels, invalid;
    bool stopped;                /* a picture was broken off */
} ec_cost_runner;
/* Sets up, edits included, and takes one picture of 1 sample for the kernels to be compiled. *setup: its seconds. */
ec_result ec_cost_runner_open(ec_cost_study *study, const ec_cost_rung *rung, ec_cost_runner *runner, ec_render_stats *stats,
                              double *setup, ec_error *err);
void ec_cost_runner_close(ec_cost_runner *runner);

/* Of a picture that is denoised, as far as it is known, beside those of its samples. */
static inline double ec_cost_runner_beside(const ec_cost_runner *r) { return r->denoised ? r->denoise_seconds / r->denoised : 0; }
ec_result ec_cost_runner_take(ec_cost_runner *runner, uint32_t seed, uint32_t samples, double *seconds, ec_error *err);

/* denoised.c: the same of a rung that denoises: the best of both pictures; seconds are those of its samples. */
ec_result ec_cost_denoised_take(ec_cost_runner *runner, uint32_t seed, uint32_t samples, bool (*go_on)(void *study), double *seconds,
                                ec_error *err);

/* measure.c: one rung, in `share` seconds, not beyond `latest`. */
typedef struct ec_cost_base {
    ec_cost_runner runner;
    double seconds_per_sample;   /* in its own turn: all relative times are multiples of this */
    uint32_t pair_samples;       /* samples of a picture for timing in turns */
    uint8_t *bits;               /* hash input of the speed picture: 3 floats a pixel; owned */
} ec_cost_base;
ec_result ec_cost_measure(ec_cost_study *study, ec_cost_base *base, ec_cost_row *row, double share, double latest, ec_error *err);

/* pictures.c: {"reference": uri, id of each rung: [picture, error map], "stages": {id: [picture or null for each point]}}, as data URIs of
 * small PNG files. Those of the stages are made smaller, so that together they have at most EC_COST_STAGE_PIXELS: some 6 MB of a page. */
enum { EC_COST_STAGE_PIXELS = 1500000 };
ec_result ec_cost_pictures(const ec_cost_study *study, cJSON **images, ec_error *err);

/* runner.c: false when the user wants to stop */
bool ec_cost_go_on(void *study);

#endif
