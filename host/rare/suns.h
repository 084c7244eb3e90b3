/* Lights that shine from one direction, and the edges that their rays may pass. Inside host/rare only. */
#ifndef EC_RARE_SUNS_H
#define EC_RARE_SUNS_H

#include "rare/lights.h"

/* Finds suns and edges, once the environment's parts are among the lights. */
ec_result ec_rare_suns_find(const ec_pack *pack, ec_rare_lights *all, ec_error *err);

#endif
