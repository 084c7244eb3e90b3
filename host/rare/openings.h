/* Light through small openings: a patch that few shadow rays from the rooms behind would find. */
#ifndef EC_RARE_OPENINGS_H
#define EC_RARE_OPENINGS_H

#include "rare/patches.h"

/* Traces rays past edges, where openings begin, towards lights that a ray can be aimed at. Where one gets by and its light falls on something, more
 * rays tell how much is lit around that; where it is little, there is a patch. patches: have room for EC_RARE_PATCHES. */
ec_result ec_rare_openings_find(ec_rare_follower *follower, ec_rare_patches *patches, ec_error *err);

/* Finds openings towards the sky, each by its patches from all directions; all of these join the first. Where paths meet the sky often, none is needed. */
ec_result ec_rare_sky_openings_find(ec_rare_follower *follower, ec_rare_patches *patches, ec_error *err);

#endif
