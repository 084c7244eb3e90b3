/* Maps slots to pixels. Pixels are numbered in tiles of 8 x 8, so that a wave covers a compact part of the picture. Tiles at the picture's edge are
 * narrower or lower, so that every number is a pixel. */
#ifndef EC_LIB_FILM_H
#define EC_LIB_FILM_H

#include "../shared/params.h"
#include "lanes.h"

#define EC_TILE 8u

/* Sets the numbers of the slot's pixel and sample, of which random numbers are a function. Pixel numbers of replicate r are those of the picture's
 * pixels plus r times their count. pixel_list: EC_LIST_WORDS for each pixel of the pass, or NULL for all pixels. */
EC_FN void slot_to_pixel(constant ec_params *params, uint first_pixel, global const uint *pixel_list, lane_u slot, lane_u *pixel,
                         lane_u *sample)
{
    lane_u local_pixel = divide(slot, params->batch);
    *sample = slot - local_pixel * params->batch + params->first_sample;
    *pixel = local_pixel + first_pixel;
    if (pixel_list) {
        lane_u at = *pixel * EC_LIST_WORDS;
        *pixel = gather_u(pixel_list, at);
        *sample += gather_u(pixel_list, at + 1u);
    }
}

/* Turns a pixel number into coordinates. A row of tiles holds width * 8 pixels (fewer rows at the bottom), a tile 8 * rows (narrower at the right). */
EC_FN void pixel_to_xy(constant ec_params *params, lane_u pixel, lane_u *x, lane_u *y)
{
    uint width = params->width, height = params->height, low = height % EC_TILE, narrow = width % EC_TILE;
    pixel = pixel - divide(pixel, width * height) * (width * height);
    lane_u tile_row = divide(pixel, width * EC_TILE);
    lane_u in_row = pixel - tile_row * (width * EC_TILE);
    lane_u rows = min(U(EC_TILE), height - tile_row * EC_TILE);
    lane_u tile = rows < EC_TILE ? divide(in_row, max(low, 1u) * EC_TILE) : in_row / (EC_TILE * EC_TILE);
    lane_u in_tile = in_row - tile * rows * EC_TILE;
    lane_u columns = min(U(EC_TILE), width - tile * EC_TILE);
    lane_u line = columns < EC_TILE ? divide(in_tile, max(narrow, 1u)) : in_tile / EC_TILE;
    *x = tile * EC_TILE + (in_tile - line * columns);
    *y = tile_row * EC_TILE + line;
}

/* Sets the pixels' indices in a film in row order whose first row is film_row. */
EC_FN void pixel_to_places(constant ec_params *params, lane_u pixel, uint places[LANES])
{
    lane_u x, y;
    pixel_to_xy(params, pixel, &x, &y);
    LANE_STORE((y - params->film_row) * params->width + x, places);
}

#endif
