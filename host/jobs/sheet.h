/* A contact sheet: small pictures of many in one. */
#ifndef EC_JOBS_SHEET_H
#define EC_JOBS_SHEET_H

#include <stdint.h>

#include "base/error.h"

/* Writes a PNG with the pictures of these files, PNG or EXR, in rows from the top left, each at most 192 pixels wide and high, with its name
 * below where the build has a font (image/label.h). An EXR is tone
 * mapped as its PNG is. What cannot be read stays empty. */
ec_result ec_sheet_write(const char *path, char *const *files, uint32_t count, ec_error *err);

#endif
