/* Views of OpenColorIO: what a screen shows of linear Rec. 709, as a config has it. */
#ifndef EC_IMAGE_OCIO_H
#define EC_IMAGE_OCIO_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

/* config: a file, or a built-in one as ocio://default. The others may be NULL: the config's first display, its first view, and the colour space that
 * is linear Rec. 709 by one of the names that configs have for that. */
typedef struct ec_ocio_choice {
    const char *config, *display, *view, *space;
} ec_ocio_choice;

typedef struct ec_ocio ec_ocio;
extern const bool ec_has_ocio; /* was eclat built with it? */

ec_result ec_ocio_open(const ec_ocio_choice *choice, ec_ocio **ocio, ec_error *err);
void ec_ocio_show(const ec_ocio *ocio, float *rgb, uint64_t pixels); /* in place: values of the screen. By any thread */
void ec_ocio_close(ec_ocio *ocio); /* NULL is fine */

#endif
