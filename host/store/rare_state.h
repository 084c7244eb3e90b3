/* Rare paths (film/rare.h) in a checkpoint's or a slice's JSON object. */
#ifndef EC_STORE_RARE_STATE_H
#define EC_STORE_RARE_STATE_H

#include <cjson/cJSON.h>
#include <stdbool.h>

#include "film/rare.h"

void ec_rare_state_add(cJSON *state, const ec_rare *rare); /* NULL: none */

/* Returns false if it is not as it was written. */
bool ec_rare_state_read(const cJSON *state, ec_rare *rare);

#endif
