/* Opens OpenEXR files, and decodes their pixels to memory. Inside host/image. */
#ifndef EC_IMAGE_EXR_INPUT_H
#define EC_IMAGE_EXR_INPUT_H

#include <openexr.h>
#include <stdbool.h>

#include "image/image.h"

typedef struct ec_exr_input {
    exr_context_t context;
    const char *path;
    char message[512]; /* the library's first message, which tells the cause */
} ec_exr_input;

/* Opens a file; *input must not be moved until it is closed. A truncated picture is an error. */
exr_result_t ec_exr_input_open(ec_exr_input *input, const char *path);
exr_result_t ec_exr_input_open_strictly(ec_exr_input *input, const char *path); /* refuses all damage in the header */
void ec_exr_input_close(ec_exr_input *input);

const char *ec_exr_reason(const ec_exr_input *input, exr_result_t code);

/* Returns the channel's entry in a part's list; NULL: none. */
const exr_attr_chlist_entry_t *ec_exr_channel(const ec_exr_input *input, int part, const char *name);

/* Fills all rooms from scan lines or the first level of tiles: converted to floats, or as stored, which must then be 32 bits. */
exr_result_t ec_exr_decode(const ec_exr_input *input, int part, const ec_exr_room *rooms, uint32_t count, bool as_floats);

#endif
