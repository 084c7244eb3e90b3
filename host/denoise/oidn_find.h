/* Finds the library of Open Image Denoise. */
#ifndef EC_DENOISE_OIDN_FIND_H
#define EC_DENOISE_OIDN_FIND_H

#include <stdbool.h>

#include "base/error.h"

/* Returns whether the user has named a place for it ($ECLAT_OIDN). */
bool ec_oidn_is_named(void);

/* Loads it, for as long as the process lives; *library: a handle for dlsym. */
ec_result ec_oidn_load(void **library, ec_error *err);

#endif
