/* A contact sheet: small versions of many pictures in one. */
#ifndef EC_JOBS_SHEET_H
#define EC_JOBS_SHEET_H

#include <stdint.h>

#include "base/error.h"

/* Writes a PNG of these files, PNG or EXR, in rows from the top left, each at most 192 pixels wide and high, with its name below if the build has a
 * font (image/label.h). An EXR is tone mapped like the PNG beside it. Files that cannot be read leave their place empty. */
ec_result ec_sheet_write(const char *path, char *const *files, uint32_t count, ec_error *err);

#endif
