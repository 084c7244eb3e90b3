/* A seal at the end of a file: the SHA-256 of everything before it, so that truncation or a flipped bit is found before reading. Readers of OpenEXR
 * files ignore it. */
#ifndef EC_IMAGE_SEAL_H
#define EC_IMAGE_SEAL_H

#include "base/error.h"

/* Appends the seal. Returns 0 or an errno value. */
int ec_seal(int fd);

/* Fails if the file is not complete and as it was written. */
ec_result ec_seal_check(const char *path, ec_error *err);

#endif
