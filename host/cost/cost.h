/* Measures what buys accuracy cheapest on a scene: `eclat cost`. Every rung (a way to render the scene) is rendered in independent pictures of
 * 1, 2, 4, … samples a pixel, each in replicates as `eclat render` takes them (film/schedule.h), and compared with a reference of the whole
 * scene, within a budget of time.
 *
 * Definitions, as in docs/cost.md. y is luminance, M the reference's mean of it, all errors are relative to M.
 *   error(n)   root of the mean over pixels of (y - reference)^2 for one picture of n samples a pixel, the reference's own variance
 *              subtracted; averaged over the independent pictures of that n
 *   relmse(n)  mean over pixels of (y - reference)^2 / (reference + 0.01)^2, likewise: dark pixels count as much as bright ones
 *   variance   n times the mean over pixels of the variance between pictures of n samples: one sample's share
 *   bias^2     mean over pixels of (mean of all pictures - reference)^2, the variance of both subtracted
 *   efficiency 1 / (error(n)^2 s), s the seconds that one picture of n samples takes
 * Variance and efficiency hardly depend on n where samples are independent. With stratified ones they do, so n is EC_COST_UNIT for all rungs
 * (or the largest taken, where that is less). */
#ifndef EC_COST_COST_H
#define EC_COST_COST_H

#include "film/film.h"
#include "render/render.h"

enum { EC_COST_LEVELS_MOST = 15, EC_COST_TARGETS = 4, EC_COST_UNIT = 16 };
extern const double ec_cost_targets[EC_COST_TARGETS]; /* 5, 2, 1, 0.5 % */

/* A way to render the scene. */
typedef struct ec_cost_rung {
    char id[48];                 /* e.g. "sample-light": the same in every study */
    char name[96];               /* for people; not escaped */
    const char *group;           /* what it changes, e.g. "sampling" */
    const char *title;           /* of the group, e.g. "Sampling, instead of mis" */
    bool is_base;                /* what `eclat render` does by default */
    bool speed_only;             /* gives the same bits: only its time is measured, and the bits are checked */
    bool unbiased;               /* by design */
    bool fades;                  /* its bias vanishes with more samples, as a denoiser's does */
    bool is_effect;              /* an effect is left out: of the scene (options.without), or of light transport */
    ec_render_options options;
} ec_cost_rung;

typedef enum ec_cost_state {
    EC_COST_PENDING,   /* not begun: the study was interrupted or its budget ended before */
    EC_COST_MEASURED,
    EC_COST_TOO_SMALL, /* the budget is too small: note says what it takes */
    EC_COST_REFUSED    /* it could not be rendered: note says why */
} ec_cost_state;

typedef struct ec_cost_point {
    uint32_t samples, batches;   /* samples per pixel of one picture; number of independent pictures */
    double seconds;              /* for one picture, without set-up */
    double mse, mse_se;          /* squared error of one picture; standard error of this figure */
    double relmse, relmse_se;    /* the same, with each pixel relative to itself */
} ec_cost_point;

typedef struct ec_cost_fit {
    double slope, se;            /* of log error against log samples; NaN if there are too few points */
} ec_cost_fit;

typedef struct ec_cost_row {
    ec_cost_rung rung;
    ec_cost_state state;
    char note[256];
    double setup_seconds;        /* for buffers, acceleration structure, kernels and their first launch; in no other figure */
    double picture_seconds;      /* per picture, for any number of samples: the denoiser's */
    double seconds_per_sample, relative_time, relative_time_se; /* relative to the base, measured in turns with it */
    uint64_t samples_per_pixel;  /* of all pictures together */
    uint64_t invalid;            /* number of values that were not finite */
    uint64_t device_bytes;       /* largest total of its buffers */
    bool same_bits;              /* for speed_only: the picture has exactly the base's bits */
    /* Everything below is not set for speed_only rungs. */
    ec_cost_point points[EC_COST_LEVELS_MOST];
    uint32_t point_count;
    uint32_t unit;               /* n for variance and efficiency */
    double variance, bias2, bias2_se;
    bool biased;                 /* bias2 > 3 bias2_se, and not unbiased by design */
    bool lacks_light;            /* unbiased by design, yet bias2 > 4 bias2_se: there is light that it has not found yet */
    ec_cost_fit fit;
    double efficiency, relative_efficiency; /* 1/s: by mse; by relmse */
    double seconds_to[EC_COST_TARGETS]; /* NaN: unknown; INFINITY: never */
    bool extrapolated[EC_COST_TARGETS]; /* beyond the largest picture taken */
    float *picture;              /* thumbnail of the last picture with the most samples: 3 floats per pixel, owned */
    uint8_t *stages[EC_COST_LEVELS_MOST]; /* by point: tone-mapped thumbnail of its last picture, 3 bytes per pixel, owned; NULL: interrupted */
} ec_cost_row;

typedef struct ec_cost_reference {
    const char *source;          /* path; NULL: rendered here */
    float *rgb;                  /* 3 per pixel, owned */
    double *luminance, *variance; /* 1 per pixel, owned; variance is that of the mean */
    double mean_luminance, noise; /* noise: mean variance of pixels, relative to mean_luminance^2 */
    bool has_variance;           /* false: the file states none, and is taken as exact */
    uint64_t samples_per_pixel;  /* 0: unknown */
    double seconds, setup_seconds;
} ec_cost_reference;

typedef struct ec_cost_progress {
    const char *doing;
    uint32_t done, count;        /* rungs */
    double seconds, budget;
} ec_cost_progress;

typedef struct ec_cost_study {
    /* Set by the caller. */
    ec_cl *cl;
    ec_scene *scene;
    ec_render_options options;   /* those of the base: size, camera, seed */
    double start, budget;        /* ec_now() when the command began; seconds from then on */
    const char *reference_file;  /* path or NULL */
    bool may_shrink;             /* options.width and height may be halved, to fit the budget */
    bool (*go_on)(void *user, const ec_cost_progress *progress); /* called often; returning false ends the study successfully */
    void *user;
    const ec_log *log;
    /* Results. */
    ec_cost_reference reference;
    ec_cost_row *rows;
    uint32_t row_count;
    bool interrupted;            /* go_on or a failure ended it early */
    const char *doing;           /* for the progress line */
    double seconds;              /* since `start` */
} ec_cost_study;

/* Runs the study and fills in the results. On failure too, the rows measured before are valid. */
ec_result ec_cost_run(ec_cost_study *study, ec_error *err);
void ec_cost_free(ec_cost_study *study);

/* pictures.c: returns a thumbnail, 3 floats per pixel; malloc'ed, NULL when out of memory. */
float *ec_cost_shrink(const ec_render_options *options, const float *rgb);
uint8_t *ec_cost_stage(const ec_render_options *options, const float *rgb); /* the same, tone-mapped: 3 bytes per pixel */

/* rungs.c: lists the rungs that this scene has, the most informative first; malloc'ed. */
ec_result ec_cost_list(const ec_scene *scene, const ec_render_options *base, ec_cost_row **rows, uint32_t *count, ec_error *err);

/* Returns the seconds until one picture's error is below `target`: NaN: unknown, INFINITY: never. *extrapolated: beyond the largest picture taken. */
double ec_cost_seconds_to(const ec_cost_row *row, double target, bool *extrapolated);

/* Says in words from which error on denoising pays on this scene, and to which; empty if it was not measured. */
void ec_cost_denoise_words(const ec_cost_study *study, char *text, size_t size);

/* Columns of which the best row is reported. */
typedef enum ec_cost_column { EC_COST_TIME, EC_COST_VARIANCE, EC_COST_TO_FIRST, EC_COST_COLUMNS = EC_COST_TO_FIRST + EC_COST_TARGETS } ec_cost_column;
typedef struct ec_cost_figure {
    double value, se; /* with its standard error; NaN: the row has none, or does not compete */
} ec_cost_figure;
/* verdict.c: returns a row's figure; smaller is better. */
ec_cost_figure ec_cost_figure_of(const ec_cost_study *study, const ec_cost_row *row, ec_cost_column column);
/* Returns the best of the rows that beat the default by more than three standard errors; 0: none does; UINT32_MAX: the default's figure is unknown. */
uint32_t ec_cost_best(const ec_cost_study *study, ec_cost_column column);
/* Summarises the study in sentences that agree with ec_cost_best. */
void ec_cost_words(const ec_cost_study *study, char *text, size_t size);
enum { EC_COST_WORDS = 1600 };
/* Writes a rung's name for use outside of its group. */
void ec_cost_label(const ec_cost_rung *rung, char *text, size_t size);

/* Finds the (row, point) pairs that no other pair beats in both time and error, from fast to precise; returns their number. */
typedef struct ec_cost_place {
    uint32_t row, point;
} ec_cost_place;
uint32_t ec_cost_pareto(const ec_cost_study *study, ec_cost_place *places, uint32_t most);

#endif
