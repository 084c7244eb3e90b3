/* Predicts which paths of a picture hardly ever meet their light, how often they do and what they bring, by a first look at its paths. */
#ifndef EC_RARE_PATHS_H
#define EC_RARE_PATHS_H

#include "rare/chains.h"
#include "rare/lights.h"

/* Chains leave in directions that are spread as the surfaces spread them. Those that leave closest to a light, if they surround it, tell how dense
 * they are around it (Loftsgaarden & Quesenberry 1965, nearest neighbours), and so the chance that one meets the light, met or not. What it would
 * bring is known: its throughput times the light's radiance. *rare: the kinds that matter most (film/rare.h); empty where there are none. */
ec_result ec_rare_paths_of(const ec_rare_lights *lights, const ec_chains *chains, ec_pipeline *pipeline, ec_rare *rare, ec_error *err);

/* Does all of this, on a device that is loaded and has no work under way: traces the chains of the picture that its parameters are of. joined: how
 * many light paths pay; NULL if not asked for. */
ec_result ec_rare_paths_predict(const ec_rare_lights *lights, ec_pipeline *pipeline, ec_rare *rare, ec_joined_choice *joined, ec_error *err);

#endif
