/* Merges slices of one job: see eclat merge. */
#ifndef EC_JOBS_MERGE_JOB_H
#define EC_JOBS_MERGE_JOB_H

#include "denoise/denoise.h"
#include "film/clamp.h"
#include "film/exposure.h"
#include "jobs/hash.h"
#include "jobs/write_outputs.h"
#include "report/error_text.h"
#include "store/merge.h"

typedef struct ec_merged {
    const char *command;
    ec_merge slices;
    ec_film_error error;
    ec_denoiser denoiser;  /* as asked for */
    ec_denoised denoised;
    ec_clamp_error clamp;
    ec_picture picture;
    uint64_t samples_per_pixel;
    char sha256[EC_HASH_SIZE], why[EC_ERROR_TEXT]; /* why: why there is no bound */
} ec_merged;

/* Merges the files. Sorts paths. is_partial: samples may be missing. Must be freed on failure too. */
ec_result ec_merged_make(char **paths, int count, bool is_partial, ec_denoiser denoiser, const char *command, ec_merged *merged, const ec_log *log,
                         ec_error *err);

/* Returns NULL if denoising was not asked for. */
const ec_denoised *ec_merged_denoised(const ec_merged *merged);

/* Returns --clamp of the slices; 0: none. */
double ec_merged_clamp(const ec_merged *merged);

/* Adds the attributes of the merged file; their texts belong to `merged`. */
void ec_merged_attributes(const ec_merged *merged, ec_report_attributes *attributes);

double ec_merged_stops(const ec_merged *merged, const ec_exposure *exposure); /* stops that it is shown with */
ec_result ec_merged_write(const ec_merged *merged, ec_outputs *outputs, const ec_exposure *exposure, ec_tonemap tonemap, ec_error *err);
void ec_merged_free(ec_merged *merged); /* zero-initialised is fine */

#endif
