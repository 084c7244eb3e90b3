/* Packs pixels as in the chunks of an OpenEXR file: line by line, and within a line channel by channel. */
#ifndef EC_IMAGE_EXR_PACK_H
#define EC_IMAGE_EXR_PACK_H

#include "image/image.h"

uint32_t ec_channel_bytes(ec_channel_type type); /* bytes of a value in the file */

/* Packs values of a channel, pixels from `first` on, little-endian. Halves are rounded to nearest, but finite values become at most the largest
 * finite half, and values over 0 do not become 0: a standard error of 0 would mean none. */
void ec_exr_pack(const ec_channel *channel, uint64_t first, uint32_t count, uint8_t *to);

#endif
