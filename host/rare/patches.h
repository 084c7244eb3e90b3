/* Small lit patches: those that few shadow rays would find, from surfaces of which few paths come to them. */
#ifndef EC_RARE_PATCHES_H
#define EC_RARE_PATCHES_H

#include "rare/follow.h"

/* A place on which light falls. */
typedef struct ec_rare_patch {
    float point[3], normal[3]; /* the normal, unit, is on the light's side */
    double irradiance, area;
    double chance;             /* that a sample there meets the light */
    double weight;             /* so many like it, it included */
    uint32_t edge;             /* that the light passes, of the lights' edges, if it comes through an opening */
    const char *light;         /* its name, of the lights */
    bool is_sky;               /* it is lit by a part of a sky, as the patches are that join it: all together they tell what comes through an opening */
    bool joins;                /* the patch before it: whoever meets one of them meets light of one kind */
} ec_rare_patch;

enum { EC_RARE_PATCHES = 192 };
typedef struct ec_rare_patches {
    uint32_t count;
    ec_rare_patch *list;       /* owned */
} ec_rare_patches;

/* Adds a kind for each patch, with those that join it, that paths seldom come to. paths: with vertices. */
ec_result ec_rare_patches_judge(const ec_rare_patches *patches, ec_rare_follower *follower, const ec_chains *paths, ec_rare *rare, ec_error *err);
void ec_rare_patches_free(ec_rare_patches *patches); /* zero-initialised or freed is fine */

#endif
