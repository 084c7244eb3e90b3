/* The result of comparing two pictures, as text and as JSON. */
#ifndef EC_REPORT_COMPARE_REPORT_H
#define EC_REPORT_COMPARE_REPORT_H

#include <stdbool.h>
#include <stdio.h>

#include "base/error.h"
#include "film/difference.h"
#include "film/noise_test.h"

typedef struct ec_compare_report {
    const char *path_a, *path_b;
    const ec_measured *a, *b;
    const char *why_a, *why_b;   /* why the file states no bound of its error; NULL: it does, or says nothing */
    ec_difference difference;
    bool tested;                 /* at least one of them has standard errors */
    ec_noise_test test;
    bool differ;                 /* by more than noise; without standard errors, in any pixel by more than rounding */
    const char *diff_path;       /* the error map; NULL: none was asked for */
} ec_compare_report;

void ec_compare_report_text(const ec_compare_report *report, FILE *to);
ec_result ec_compare_report_json(const ec_compare_report *report, FILE *to, ec_error *err);

#endif
