/* Finds where in the picture lamps may be seen directly. */
#ifndef EC_DEVICE_LAMP_TILES_H
#define EC_DEVICE_LAMP_TILES_H

#include "device/pipeline.h"

/* Tiles of the picture (kernels/lib/film.h), row by row: 1 where a camera ray may meet a lamp that emits more than `least`, W sr^-1 m^-2 of luminance. */
typedef struct ec_lamp_tiles {
    uint32_t columns, rows;
    uint8_t *may; /* owned */
} ec_lamp_tiles;

ec_result ec_lamp_tiles_find(ec_pipeline *pipeline, float least, ec_lamp_tiles *tiles, ec_error *err);
/* Returns how many pixel numbers a tile has, from *first on. */
uint32_t ec_lamp_tile_numbers(const ec_params *params, const ec_lamp_tiles *tiles, uint32_t tile, uint32_t *first);

#endif
