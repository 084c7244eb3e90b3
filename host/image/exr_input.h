/* For those who read: an OpenEXR file, and the one way from its pixels to memory. */
#ifndef EC_IMAGE_EXR_INPUT_H
#define EC_IMAGE_EXR_INPUT_H

#include <openexr.h>
#include <stdbool.h>

#include "image/image.h"

typedef struct ec_exr_input {
    exr_context_t context;
    const char *path;
    char message[512]; /* the library's first complaint, which names the cause */
} ec_exr_input;

/* It must stay where it is until it is closed; half a picture is an error, not a picture. */
exr_result_t ec_exr_input_open(ec_exr_input *input, const char *path);
exr_result_t ec_exr_input_open_strictly(ec_exr_input *input, const char *path); /* nothing damaged in the header is passed over */
void ec_exr_input_close(ec_exr_input *input);

const char *ec_exr_reason(const ec_exr_input *input, exr_result_t code);

/* Its entry in a part's list; NULL: there is none. */
const exr_attr_chlist_entry_t *ec_exr_channel(const ec_exr_input *input, int part, const char *name);

/* Fills all rooms from scan lines or the first level of tiles; as floats, or as they are stored, in 32 bits then. */
exr_result_t ec_exr_decode(const ec_exr_input *input, int part, const ec_exr_room *rooms, uint32_t count, bool as_floats);

#endif
