/* A seal behind the end of a file: SHA-256 of all before it. Whoever checks it first reads nothing that was cut short or has a bit turned.
 * Readers of OpenEXR files do not look there. */
#ifndef EC_IMAGE_SEAL_H
#define EC_IMAGE_SEAL_H

#include "base/error.h"

/* Appends it; 0, or the errno value of what failed. */
int ec_seal(int fd);

/* Is the file whole and as it was written? */
ec_result ec_seal_check(const char *path, ec_error *err);

#endif
