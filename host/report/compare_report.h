/* The result of comparing two pictures, as text and as JSON. */
#ifndef EC_REPORT_COMPARE_REPORT_H
#define EC_REPORT_COMPARE_REPORT_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/error.h"
#include "film/difference.h"
#include "film/noise_test.h"

/* If noise makes more of the error than this, curves bend it in ways that standard errors do not tell. */
#define EC_NOISE_BENT 0.4

typedef struct ec_compare_report {
    const char *path_a, *path_b;
    const ec_measured *a, *b;
    const char *format_a, *format_b; /* "8-bit PNG"; NULL: linear floats */
    bool is_lossy_a;
    bool is_shown;               /* the values compared are sRGB from 0 to 1, linear pictures as shown by `tonemap` */
    unsigned tonemap;            /* ec_tonemap */
    double exposure;             /* stops, used for showing; or those by which A was fitted to a B that is linear too */
    char fitted;                 /* 'A' or 'B': the picture whose exposure was fitted; 0: none */
    bool is_estimated;           /* the noise of A was estimated from its difference to B */
    const char *why_a, *why_b;   /* why the file states no bound of its error; NULL: it does, or does not say why */
    ec_difference difference;
    bool tested;                 /* at least one of them has standard errors */
    ec_noise_test test;
    bool differ;                 /* by more than noise; without standard errors, in any pixel by more than rounding */
    double flip, ssim;           /* means; ssim NaN: no window fits into the picture */
    const char *diff_path;       /* path of the error map; NULL: not asked for */
} ec_compare_report;

void ec_compare_report_text(const ec_compare_report *report, FILE *to);
cJSON *ec_compare_report_json(const ec_compare_report *report); /* the caller deletes it */

#endif
