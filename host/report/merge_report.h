/* The result of merging slices. */
#ifndef EC_REPORT_MERGE_REPORT_H
#define EC_REPORT_MERGE_REPORT_H

#include <stdint.h>
#include <stdio.h>

#include "base/error.h"
#include "denoise/clean.h"
#include "film/clamp.h"

typedef struct ec_merge_report {
    int files;
    uint64_t samples_per_pixel, replicates, heavy_pixels;
    ec_film_error error;
    double limit, luminance; /* of --clamp; and the largest luminance of a sample that it allows; 0: none */
    ec_clamp_error clamp;
    const ec_denoised *denoised; /* NULL: not asked for */
    const char *image_sha256;
    double exposure;         /* stops, of the PNG */
    bool is_exposure_auto;
    const char **outputs;
    int output_count;
} ec_merge_report;
void ec_merge_report_text(const ec_merge_report *report, FILE *to);
ec_result ec_merge_report_json(const ec_merge_report *report, FILE *to, ec_error *err);

#endif
