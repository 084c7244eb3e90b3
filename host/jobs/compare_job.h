/* Compares two pictures: see eclat compare. */
#ifndef EC_JOBS_COMPARE_JOB_H
#define EC_JOBS_COMPARE_JOB_H

#include "image/shown.h"
#include "jobs/compare_input.h"
#include "report/compare_report.h"

/* How two pictures are compared. All zero: both as they are if both are linear; if one is made for a screen, the other is shown by --tonemap neutral. */
typedef struct ec_compare_options {
    ec_look look;             /* how linear pictures are shown */
    bool is_shown;            /* show both, even if both are linear */
    bool fits_exposure;       /* fit the exposure of the linear one, instead of using the look's */
    bool estimates_noise;     /* estimate the noise of A if it states none */
    const char *mask;         /* paths, like diff; NULL: none */
    const char *diff;
} ec_compare_options;

/* Must not be moved, as the report points into the other fields. */
typedef struct ec_compare_job {
    ec_compare_input a, b;
    uint8_t *mask;            /* owned; NULL: all pixels count */
    float *seen[2], *flip;    /* owned: both as shown, 3 floats per pixel, and FLIP's map, 1 float */
    ec_compare_report report;
} ec_compare_job;

/* Reads both. Must be freed on failure too; zero-initialised is fine. */
ec_result ec_compare_load(const char *path_a, const char *path_b, ec_compare_job *job, ec_error *err);

/* Fills in the report. To be called once, as it replaces linear pictures by what is shown of them. */
ec_result ec_compare_measure(ec_compare_job *job, const ec_compare_options *options, ec_error *err);
void ec_compare_free(ec_compare_job *job);

/* Writes the map of --diff, 3 bytes per pixel: where they differ. To be called after measuring. */
void ec_compare_map(const ec_compare_job *job, uint8_t *rgb);

#endif
