/* Light through small openings: a patch that few shadow rays from the rooms behind would find. */
#ifndef EC_RARE_OPENINGS_H
#define EC_RARE_OPENINGS_H

#include "rare/chains.h"

/* A place on which light of a sun, or of a lamp, falls. */
typedef struct ec_rare_patch {
    float point[3], normal[3]; /* the normal is on the sun's side */
    double irradiance, area;
    const ec_rare_sun *sun;    /* of the lights */
} ec_rare_patch;

typedef struct ec_rare_openings {
    uint32_t count;
    ec_rare_patch *patches;    /* owned */
} ec_rare_openings;

/* Traces rays past edges, where openings begin, towards lights that shine from one direction. Where one gets by and its light falls on something,
 * more rays tell how much is lit around that; where it is little, there is a patch. */
ec_result ec_rare_openings_find(const ec_rare_lights *lights, ec_pipeline *pipeline, ec_rare_openings *openings, ec_error *err);
void ec_rare_openings_free(ec_rare_openings *openings); /* zero-initialised or freed is fine */

/* Adds a kind for each patch that paths seldom come to. paths: with vertices. */
void ec_rare_openings_judge(const ec_rare_openings *openings, const ec_rare_lights *lights, const ec_chains *paths, ec_rare *rare);

#endif
