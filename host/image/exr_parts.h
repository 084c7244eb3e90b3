/* Reads parts of a sealed EXR file as written by ec_exr_write_parts: scan lines of 32-bit values, bit for bit. */
#ifndef EC_IMAGE_EXR_PARTS_H
#define EC_IMAGE_EXR_PARTS_H

#include "image/image.h"

typedef struct ec_exr_file ec_exr_file;

/* Opens a file after checking its seal. The size is that of the first part. */
ec_result ec_exr_open(const char *path, ec_exr_file **file, uint32_t *width, uint32_t *height, ec_error *err);
void ec_exr_close(ec_exr_file *file); /* NULL is fine */

/* Returns a text attribute of the first part, which belongs to the file; NULL if there is none. */
const char *ec_exr_text(const ec_exr_file *file, const char *name);

/* Tells whether the part has a channel of that name. */
bool ec_exr_has(const ec_exr_file *file, const char *part, const char *channel);

/* Fills all rooms from one part, which must have the file's size, and these channels with 32 bits per value. Others are skipped. */
ec_result ec_exr_fill(ec_exr_file *file, const char *part, const ec_exr_room *rooms, uint32_t count, ec_error *err);

#endif
