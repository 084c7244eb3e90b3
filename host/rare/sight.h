/* Finds which lights are in sight of where a few chains start, when these are too few to tell from their directions where others would go. */
#ifndef EC_RARE_SIGHT_H
#define EC_RARE_SIGHT_H

#include "rare/chains.h"

/* in_sight: by light that is not all around, by lamp of it (one of an environment's part), by chain; owned by the caller, NULL where there are no chains. */
ec_result ec_rare_sight(const ec_rare_lights *lights, const ec_chain *const *chains, uint32_t count, ec_pipeline *pipeline, bool **in_sight, ec_error *err);

#endif
