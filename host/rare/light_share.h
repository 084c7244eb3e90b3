/* Chooses how many of the light samples go to lights at infinity, and how many to lamps, by the noise that each brings. */
#ifndef EC_RARE_LIGHT_SHARE_H
#define EC_RARE_LIGHT_SHARE_H

#include "device/pipeline.h"

/* Gives lights at infinity the share that has the least noise; 0: there are not both kinds, and nothing changes. */
ec_result ec_light_share_choose(ec_pipeline *pipeline, double *share, ec_error *err);

#endif
