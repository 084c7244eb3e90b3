/* Finds lights that a ray can be aimed at. Inside host/rare only. */
#ifndef EC_RARE_SOURCES_H
#define EC_RARE_SOURCES_H

#include "rare/lights.h"

/* Adds them, once the environment's parts and lamps are among the lights. */
void ec_rare_sources_find(const ec_scene *scene, ec_rare_lights *all);

#endif
