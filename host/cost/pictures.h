/* The report's pictures. */
#ifndef EC_COST_PICTURES_H
#define EC_COST_PICTURES_H

#include <cjson/cJSON.h>

#include "cost/cost.h"

/* {"reference": uri, id of each rung: [picture, error map]}, as data URIs of small PNG files. */
ec_result ec_cost_pictures(const ec_cost_study *study, cJSON **images, ec_error *err);

#endif
