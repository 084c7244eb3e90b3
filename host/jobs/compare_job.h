/* Two pictures are compared: see eclat compare. */
#ifndef EC_JOBS_COMPARE_JOB_H
#define EC_JOBS_COMPARE_JOB_H

#include "film/measured.h"
#include "image/image.h"
#include "report/compare_report.h"

/* A picture to be compared: an EXR of ours or of another renderer. */
typedef struct ec_compare_input {
    const char *path;
    ec_measured measured;       /* points into what follows */
    char *why;                  /* owned: why the file states no bound of its error; NULL: it does, or says nothing */
    float *rgb, *se, *se_y;     /* owned; se and se_y NULL where the file has none, or only one replicate */
} ec_compare_input;

/* The report points into the inputs: not to be moved. */
typedef struct ec_compare_job {
    ec_compare_input a, b;
    ec_compare_report report;
} ec_compare_job;

/* Reads both: R, G, B; stderr.R, .G, .B, .Y where there are any. Fails where a channel is missing or a value is not finite. To be freed on failure
 * too; zero-initialised is fine. */
ec_result ec_compare_load(const char *path_a, const char *path_b, ec_compare_job *job, ec_error *err);

/* Fills in the report of what was read; diff: a .png for the map of errors, or NULL. */
ec_result ec_compare_measure(ec_compare_report *report, const char *diff, ec_error *err);
void ec_compare_free(ec_compare_job *job);

#endif
