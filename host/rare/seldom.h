/* Lights of which few light paths start, although they light what the camera sees. */
#ifndef EC_RARE_SELDOM_H
#define EC_RARE_SELDOM_H

#include "rare/follow.h"

/* Adds a kind for each of them, for pictures of light paths alone. camera: chains with those of the camera. */
ec_result ec_rare_seldom_find(ec_rare_follower *follower, const ec_chains *camera, ec_rare *rare, ec_error *err);

#endif
