/* Pixels as the chunks of an OpenEXR file hold them: line by line, and in a line channel by channel. */
#ifndef EC_IMAGE_EXR_PACK_H
#define EC_IMAGE_EXR_PACK_H

#include "image/image.h"

uint32_t ec_channel_bytes(ec_channel_type type); /* of a value in the file */

/* Values of a channel, the pixels from `first` on, little-endian into `to`. Halves are the nearest ones, but at most the largest finite one for
 * what is finite, and not 0 for what is more than that: of a standard error that makes none of what is none. */
void ec_exr_pack(const ec_channel *channel, uint64_t first, uint32_t count, uint8_t *to);

#endif
