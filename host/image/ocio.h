/* Applies views of OpenColorIO: what a screen shows of linear Rec. 709 according to a config. */
#ifndef EC_IMAGE_OCIO_H
#define EC_IMAGE_OCIO_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

/* config: a file, or a built-in one such as ocio://default. The others may be NULL: the config's first display, its first view, and its colour space
 * with one of the usual names of linear Rec. 709. */
typedef struct ec_ocio_choice {
    const char *config, *display, *view, *space;
} ec_ocio_choice;

typedef struct ec_ocio ec_ocio;
extern const bool ec_has_ocio; /* the build has OpenColorIO */

ec_result ec_ocio_open(const ec_ocio_choice *choice, ec_ocio **ocio, ec_error *err);
void ec_ocio_show(const ec_ocio *ocio, float *rgb, uint64_t pixels); /* converts to values of the screen in place; thread-safe */
void ec_ocio_close(ec_ocio *ocio); /* NULL is fine */

#endif
