/* --channels: which channels an EXR of a picture holds. */
#ifndef EC_JOBS_CHANNEL_LIST_H
#define EC_JOBS_CHANNEL_LIST_H

#include <stdint.h>

#include "base/error.h"
#include "film/channels.h"

/* A bit for each row of ec_channel_rows. */
typedef uint64_t ec_channel_set;

ec_channel_set ec_channels_all(void); /* but for those that have to be named */
ec_channel_set ec_channels_default(void);
ec_channel_set ec_channels_of(ec_plane plane);
uint32_t ec_channels_layers(ec_channel_set set); /* a bit for each ec_layer_kind that they are of */
uint32_t ec_channels_mattes(ec_channel_set set); /* likewise each ec_matte_kind */

/* Names of channels, or of layers as stderr, with commas between them; default and all. R, G and B are always among them. */
ec_result ec_parse_channels(const char *option, const char *text, ec_channel_set *set, ec_error *err);

/* Of a pixel in the file, uncompressed. */
uint32_t ec_channels_bytes(ec_channel_set set);

#endif
