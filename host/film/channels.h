/* The table of a picture's channels, in its EXR and for callers of the library, by which they are written, read and listed. */
#ifndef EC_FILM_CHANNELS_H
#define EC_FILM_CHANNELS_H

#include <stdbool.h>
#include <stdint.h>

#include "film/layers.h"

/* Arrays of floats that a picture has for each pixel. */
typedef enum ec_plane {
    EC_PLANE_RGB, EC_PLANE_SAMPLES, EC_PLANE_STDERR, EC_PLANE_STDERR_Y, EC_PLANE_LOW, EC_PLANE_HIGH, EC_PLANE_HEAVY, EC_PLANE_CLAMPED,
    EC_PLANE_DENOISED, EC_PLANE_BEST, EC_PLANE_DENOISED_STDERR, /* where --denoise made them */
    EC_PLANE_FEATURES, /* of first hits */
    EC_PLANE_MATTE, /* EC_MATTE_FLOATS (film/matte.h) of each ec_matte_kind: this one, and those that follow */
    EC_PLANE_MATTE_END = EC_PLANE_MATTE + EC_MATTE_KINDS - 1,
    EC_PLANE_LAYER /* EC_LAYER_PLANES (film/layer_films.h) of the layer of each ec_layer_kind: this one, and those that follow */
} ec_plane;

/* How a file keeps the values of an array. */
typedef enum ec_channel_type {
    EC_CHANNEL_FLOAT, /* 32-bit floats, as they are */
    EC_CHANNEL_HALF,  /* floats in 16 bits: 11 significant ones */
    EC_CHANNEL_UINT,  /* floats that are whole numbers, in 32 bits */
    EC_CHANNEL_WORDS  /* 32-bit unsigned integers, as they are */
} ec_channel_type;

/* When a picture that can have a channel has it: always; if it, its layer or all are asked for; if it or its layer is, since it makes a render dearer. */
typedef enum ec_channel_choice { EC_CHANNEL_DEFAULT, EC_CHANNEL_OF_ALL, EC_CHANNEL_BY_NAME } ec_channel_choice;

typedef struct ec_channel_row {
    const char *name;
    ec_plane plane;
    uint32_t place;       /* among the plane's floats of a pixel */
    ec_channel_type type; /* in the EXR of a picture; with its sums (store/layout.h) all come as 32-bit floats */
    ec_channel_choice when;
} ec_channel_row;

/* Two names of a pixel and their coverages are four channels of a file: CryptoObject00.R, .G, .B, .A, CryptoObject01.R … */
static inline bool ec_channel_is_matte(const ec_channel_row *row) { return row->plane >= EC_PLANE_MATTE && row->plane <= EC_PLANE_MATTE_END; }
static inline uint32_t ec_channel_count(const ec_channel_row *row) { return ec_channel_is_matte(row) ? 2 * EC_MATTE_RANKS : 1; }

enum { EC_CHANNEL_ROWS = 56 };
extern const ec_channel_row ec_channel_rows[EC_CHANNEL_ROWS];

/* Channels of a light group, whose names begin with "light.NAME.". */
enum { EC_GROUP_ROWS = 7 };
extern const ec_channel_row ec_group_rows[EC_GROUP_ROWS];

/* Returns the name of a plane's float; NULL: it has none. */
const char *ec_channel_name_of(ec_plane plane, uint32_t place);

#endif
