/* Weights the layers of a picture anew: see eclat mix. */
#ifndef EC_JOBS_MIX_JOB_H
#define EC_JOBS_MIX_JOB_H

#include "jobs/hash.h"
#include "jobs/write_outputs.h"
#include "report/attributes.h"

#define EC_MIX_WHY "errors of a mix are upper bounds, since its layers may err alike"

typedef struct ec_mix {
    const char *command;
    double gains[EC_LAYER_KINDS + EC_GROUPS_MOST][3]; /* of each layer of the picture */
    bool is_even;           /* all gains are equal */
    ec_picture picture;     /* the mix, and its layers with their gains; its standard errors are upper bounds */
    double mean_luminance, error; /* of the mix; error: an upper bound. INFINITY if no errors are known, or it is black */
    double replicates;      /* 0: unknown */
    char sha256[EC_HASH_SIZE];
} ec_mix;

/* Reads a picture and weights its light groups, or direct and indirect light if those are named. gains: NAME=GAIN or NAME=R,G,B each; layers not
 * named have gain 1. Must be freed on failure too. */
ec_result ec_mix_make(const char *path, char **gains, int count, const char *command, ec_mix *mix, ec_error *err);
void ec_mix_attributes(const ec_mix *mix, ec_report_attributes *attributes);
ec_result ec_mix_write(const ec_mix *mix, ec_outputs *outputs, double exposure, ec_tonemap tonemap, ec_error *err);
void ec_mix_free(ec_mix *mix); /* zero-initialised is fine */

#endif
