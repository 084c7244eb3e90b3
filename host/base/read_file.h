/* Reads a whole file at once. */
#ifndef EC_BASE_READ_FILE_H
#define EC_BASE_READ_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

/* *bytes is malloc'ed, and must be freed on failure too. The error is "cannot open" or "cannot read", the path and the reason. */
ec_result ec_read_file(const char *path, uint8_t **bytes, size_t *size, ec_error *err);

#endif
