/* Sunlight through small openings: a patch that few shadow rays from the rooms behind would find. */
#ifndef EC_RARE_OPENINGS_H
#define EC_RARE_OPENINGS_H

#include "rare/chains.h"

/* Rays go past edges, where openings begin, towards lights that shine from one direction. Where one gets by and its light falls on something, how
 * much of that is lit is felt for around it. Where that is little, paths are traced to learn how often they come there: a kind is added. */
ec_result ec_rare_openings_find(const ec_rare_lights *lights, ec_pipeline *pipeline, ec_rare *rare, ec_error *err);

#endif
