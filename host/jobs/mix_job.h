/* Layers of a picture weighed anew: see eclat mix. */
#ifndef EC_JOBS_MIX_JOB_H
#define EC_JOBS_MIX_JOB_H

#include "jobs/hash.h"
#include "jobs/write_outputs.h"
#include "report/attributes.h"

#define EC_MIX_WHY "errors of a mix are upper bounds, since its layers may err alike"

typedef struct ec_mix {
    const char *command;
    double gains[EC_LAYER_KINDS + EC_GROUPS_MOST][3]; /* of each of the picture's layers */
    bool is_even;           /* they are all the same */
    ec_picture picture;     /* the mix, its layers with their gains; its standard errors are upper bounds */
    double mean_luminance, error; /* of that picture; error: at most. Infinity where no errors are known, or it is black */
    double replicates;      /* 0: not known */
    char sha256[EC_HASH_SIZE];
} ec_mix;

/* Reads a picture and weighs its light groups, or direct and indirect light if those are named. gains: NAME=GAIN or NAME=R,G,B each; 1 of layers that
 * are not named. To be freed on failure too. */
ec_result ec_mix_make(const char *path, char **gains, int count, const char *command, ec_mix *mix, ec_error *err);
void ec_mix_attributes(const ec_mix *mix, ec_report_attributes *attributes);
ec_result ec_mix_write(const ec_mix *mix, ec_outputs *outputs, double exposure, ec_tonemap tonemap, ec_error *err);
void ec_mix_free(ec_mix *mix); /* zero-initialised is fine */

#endif
