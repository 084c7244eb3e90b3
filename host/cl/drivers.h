/* Looks at the drivers that are installed, as the ICD loader finds them. */
#ifndef EC_CL_DRIVERS_H
#define EC_CL_DRIVERS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

/* Returns whether there is a driver that cannot be loaded; err says which one and why. To be called if no platform was found. */
bool ec_drivers_explain(ec_error *err);

/* Returns whether there is a driver that no file names to the loader, so that its devices are missing; `text` says which one and how to mend it. */
bool ec_drivers_unnamed(char *text, size_t size);

#endif
