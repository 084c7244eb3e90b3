/* Light that no path of the first look came near: lamps whose light falls on mirrors or glass that the camera's paths hardly ever meet, as that
 * of a lamp in a small glass bulb does. */
#ifndef EC_RARE_BLIND_H
#define EC_RARE_BLIND_H

#include "rare/chains.h"

/* Rays are traced from the lights. Where a material that is sharp by its factors sends on EC_BLIND_SHARE or more of all light, and the paths have
 * met it fewer than EC_BLIND_VISITS times, a kind is added: how often samples meet it is not known, but that its light may be missing is. */
#define EC_BLIND_SHARE 0.02
#define EC_BLIND_VISITS 8
ec_result ec_rare_blind_find(const ec_rare_lights *lights, const ec_chains *chains, ec_pipeline *pipeline, ec_rare *rare, ec_error *err);

#endif
