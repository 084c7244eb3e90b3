/* --channels: selects the channels of a picture's EXR. */
#ifndef EC_JOBS_CHANNEL_LIST_H
#define EC_JOBS_CHANNEL_LIST_H

#include <stdint.h>

#include "base/error.h"
#include "film/channels.h"

/* One bit for each row of ec_channel_rows. */
typedef uint64_t ec_channel_set;

ec_channel_set ec_channels_all(void); /* all but those that must be named */
ec_channel_set ec_channels_default(void);
ec_channel_set ec_channels_of(ec_plane plane);
uint32_t ec_channels_layers(ec_channel_set set); /* bits by ec_layer_kind: the layers that the channels belong to */
uint32_t ec_channels_mattes(ec_channel_set set); /* bits by ec_matte_kind, likewise */

/* Parses names of channels, or of layers such as stderr, separated by commas; also default and all. R, G and B are always included. */
ec_result ec_parse_channels(const char *option, const char *text, ec_channel_set *set, ec_error *err);

/* Returns the bytes per pixel in the file, uncompressed. */
uint32_t ec_channels_bytes(ec_channel_set set);

#endif
