/* Two pictures are compared: see eclat compare. */
#ifndef EC_JOBS_COMPARE_JOB_H
#define EC_JOBS_COMPARE_JOB_H

#include "image/shown.h"
#include "jobs/compare_input.h"
#include "report/compare_report.h"

/* How two pictures are compared. All zero: both are linear as they are; where one is a picture for a screen, the other is shown by --tonemap neutral. */
typedef struct ec_compare_options {
    ec_look look;             /* of linear pictures */
    bool is_shown;            /* so, even if both are linear */
    bool fits_exposure;       /* of the one that is linear, in place of the look's */
    bool estimates_noise;     /* of A, if it states none */
    const char *mask;         /* files; NULL: none */
    const char *diff;
} ec_compare_options;

/* The report points into all else: not to be moved. */
typedef struct ec_compare_job {
    ec_compare_input a, b;
    uint8_t *mask;            /* owned; NULL: all pixels count */
    float *seen[2], *flip;    /* owned: both as they are shown, 3 floats a pixel, and FLIP's map, 1 */
    ec_compare_report report;
} ec_compare_job;

/* Reads both. To be freed on failure too; zero-initialised is fine. */
ec_result ec_compare_load(const char *path_a, const char *path_b, ec_compare_job *job, ec_error *err);

/* Fills in the report of what was read: once, as linear pictures are replaced by what is shown of them. */
ec_result ec_compare_measure(ec_compare_job *job, const ec_compare_options *options, ec_error *err);
void ec_compare_free(ec_compare_job *job);

/* Where they differ, once measured, 3 bytes a pixel: the map of --diff. */
void ec_compare_map(const ec_compare_job *job, uint8_t *rgb);

#endif
