/* Intel's Open Image Denoise 2 by its C API (https://www.openimagedenoise.org), loaded when it is used: nothing of it is linked, and only the
 * functions that are called are declared here. */
#ifndef EC_DENOISE_OIDN_H
#define EC_DENOISE_OIDN_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

typedef struct ec_oidn ec_oidn;

/* Opens the library, with a device of its own: the processor, whatever renders. It is searched for where $ECLAT_OIDN says, where the system's loader
 * looks, and among Python's packages. *oidn is NULL on failure. */
ec_result ec_oidn_open(ec_oidn **oidn, ec_error *err);
void ec_oidn_close(ec_oidn *oidn); /* NULL is fine */

const char *ec_oidn_version(const ec_oidn *oidn); /* "2.5.1" */

/* Images of one size, 3 floats a pixel; absent ones are NULL. The colours, linear and unbounded, are filtered in place with the help of the guides; a
 * guide that comes alone is filtered itself. */
typedef enum ec_oidn_quality { EC_OIDN_FAST = 4, EC_OIDN_BALANCED = 5, EC_OIDN_HIGH = 6 } ec_oidn_quality; /* OIDNQuality */

typedef struct ec_oidn_image {
    uint32_t width, height;
    float *color, *albedo, *normal;
    bool has_clean_guides; /* the guides are free of noise */
    ec_oidn_quality quality;
} ec_oidn_image;

/* A filter of these images, which may be run again when they have new contents. The caller owns it, and frees it before ec_oidn_close. NULL on failure. */
typedef struct ec_oidn_filter ec_oidn_filter;
ec_result ec_oidn_filter_create(ec_oidn *oidn, const ec_oidn_image *image, ec_oidn_filter **filter, ec_error *err);
ec_result ec_oidn_filter_run(ec_oidn *oidn, ec_oidn_filter *filter, ec_error *err);
void ec_oidn_filter_free(ec_oidn *oidn, ec_oidn_filter *filter); /* NULL is fine */

#endif
