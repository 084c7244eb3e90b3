/* Small spots that a light close to a surface, or a narrow spot light, makes very bright. */
#ifndef EC_RARE_SPOTS_H
#define EC_RARE_SPOTS_H

#include "rare/patches.h"

/* Traces rays from point and spot lights and from the strongest lamps, and adds patches for those that land in little area. patches: have room for
 * EC_RARE_PATCHES. */
ec_result ec_rare_spots_find(ec_rare_follower *follower, ec_rare_patches *patches, ec_error *err);

#endif
