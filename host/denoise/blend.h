/* Chooses how much of the denoised picture goes into the best one: a weight in the middle of each tile, and between these without a seam. See blend.c. */
#ifndef EC_DENOISE_BLEND_H
#define EC_DENOISE_BLEND_H

#include "denoise/judge.h"

enum { EC_BLEND_TILE = 16 };

/* Sums over pixels of a tile. */
typedef struct ec_tile_sums {
    double pixels, clean, noisy, apart, noise, gain, gain_apart, variance, plains; /* the last two: of `gain` */
    double apart_variance;
    double noisy_squares;         /* of single pixels' `noisy` */
    double excess;                /* `apart` less twice `noisy`; what a single pixel adds is limited */
} ec_tile_sums;

typedef struct ec_blend_tile {
    ec_tile_sums half[2];         /* of its upper and its lower half */
    double weight;                /* of the denoised picture, 0 to 1 */
    double slope;                 /* by how much the weight falls where what it is chosen by is higher by 1; 0: it is at an end */
} ec_blend_tile;

/* Pixels between the middles of four tiles, or beyond the outer ones: coefficients of the error, which is quadratic in the tiles' weights;
 * together: the covariance of linear[i] and square[i][i]; variance: of linear[i]; apart_variance: of the sum of square[i]. Corners are left and
 * right above, left and right below. */
typedef struct ec_blend_cell {
    double square[4][4], linear[4], together[4], variance[4], apart_variance[4], plains[4];
} ec_blend_cell;

typedef struct ec_blend {
    uint32_t columns, rows;
    double pixel_noise;           /* squared error of a noisy pixel, if ec_film_error.noisy_pixels of them made all the noise alike */
    ec_blend_tile *tiles;         /* row by row; owned, as the cells are */
    ec_blend_cell *cells;         /* columns + 1 times rows + 1 of them */
} ec_blend;

/* noisy: the error of the noisy picture, only read during the call. */
ec_result ec_blend_create(ec_blend *blend, uint32_t width, uint32_t height, const ec_film_error *noisy, ec_error *err);
void ec_blend_free(ec_blend *blend);

/* Sets the rows [*first, *end) of pixels of a row of cells, of which there are rows + 1: no two of them add to the same sums. */
void ec_blend_rows(uint32_t cells, uint32_t height, uint32_t *first, uint32_t *end);
void ec_blend_add_row(ec_blend *blend, uint32_t row, const ec_judged *pixels, uint32_t width);

/* Chooses the weights, once all rows are added. */
void ec_blend_choose(ec_blend *blend);

static inline ec_tile_sums ec_blend_sums(const ec_blend_tile *t)
{
    const ec_tile_sums *a = &t->half[0], *b = &t->half[1];
    return (ec_tile_sums){a->pixels + b->pixels, a->clean + b->clean, a->noisy + b->noisy, a->apart + b->apart,
                          a->noise + b->noise, a->gain + b->gain, a->gain_apart + b->gain_apart,
                          a->variance + b->variance, a->plains + b->plains, a->apart_variance + b->apart_variance,
                          a->noisy_squares + b->noisy_squares, a->excess + b->excess};
}

/* Values at a pixel, interpolated between tiles: the weight; the mean squared error of the denoised picture, at least that of its noise; and the part
 * of the pixel's variance by which its error looks too small, since weights depend on it. */
typedef struct ec_blend_at {
    double weight, square, optimism;
} ec_blend_at;
ec_blend_at ec_blend_look(const ec_blend *blend, uint32_t x, uint32_t y);

#endif
