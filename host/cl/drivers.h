/* The drivers that are installed, as the ICD loader finds them. */
#ifndef EC_CL_DRIVERS_H
#define EC_CL_DRIVERS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

/* Where no platform was found: is there a driver that cannot be loaded? Then err says which one and why. */
bool ec_drivers_explain(ec_error *err);

/* Is there a driver that no file of the loader's names, so that its devices are missing? Then `text` says which one and how to mend it. */
bool ec_drivers_unnamed(char *text, size_t size);

#endif
