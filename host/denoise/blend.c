/* Let s be a pixel's squared error of the noisy picture and q the square of its difference from the denoised one, which is known. A blend with weight w
 * of the denoised one has s - 2 w g + w^2 q: g, the gain, is s less the product of both errors. With w = sum of B_i w_i, B_i the shares of the tiles
 * around, the sum over pixels is, but for what is constant,
 *     sum over i, k of A_ik w_i w_k - 2 sum over i of b_i w_i,    A_ik = sum of q B_i B_k,  b_i = sum of g B_i,
 * which coordinate descent makes least, each weight from 0 to 1. Linear in x and y between the middles of tiles, so that no seam shows; and since all
 * are found together, a bright edge in one tile has its say in the tiles beside it too.
 *
 * g is estimated by what is expected of it (judge.c), not by (q + s - t) / 2, t the judged error of the denoised picture: that has the same expectation
 * and 3.7 times the variance, for normal noise and eight replicates.
 *
 * But q is of this very picture: its noise makes q and g larger together, so that g over q promises too much where it is large. b_i is worth
 * b_i - C_i / A_ii, C_i = sum of Cov(q, g) B_i^3 the covariance of both: of p pixels alike (p - 2) / p of it (James and Stein 1961), and nothing where one
 * pixel decides. At the lamps of Veach's plates the denoiser makes one pixel's error three times what it was, at 64 samples nine times: `best` was 5.5 %
 * worse than the noisy picture with t (64 samples, 15 seeds), with g alone 2.1 % and at 16 samples 6.7 % (20 seeds), and as it is -0.1 % and 0.0 % (100 seeds).
 *
 * Whether a denoiser pays at all is not always told: where single samples make the noise, s strays by more than itself, and q with the noise. The weight of
 * the whole picture is drawn in the same way, by WHOLE, to that of either picture, by as much as the variances of g and of q for that weight make. A
 * denoiser follows the noise, not its opposite: t >= q - s, and q is known. Where q is over 2 s the denoised picture is therefore the worse one. Were the
 * two alike, a pixel's q would be s times a chi-square of one degree of freedom whose centre is off by 1, of variance 6 s^2, and the estimate of s adds
 * 4 * 2 s^2 / (n - 1): q - 2 s strays by the square root of 7 sum s^2, with eight replicates. The weight is drawn to 1, as denoising mostly pays, but to 0
 * where q - 2 s is well over 0, and in between where it is less. No pixel alone says so unless it holds all the noise: where a few lamps hold it, one is
 * ten times s every few renders, as s is low where many replicates happen to agree. With every pixel counted in full and no variance of q `best` was 12 %
 * worse than the denoised picture in scenes/lamps (16 samples, 34 seeds), as it is 0.9 % better (100 seeds).
 *
 * The variances of b_i and A_ii make that of a weight, V / A^2, V = Var b + w^2 Var A, w that of the whole picture: even where both are alike and 1 is
 * right, s over q strays about it. A weight that goes by its own surroundings alone would follow the noise, so that it is drawn to the weight of the whole
 * picture, by a term V / (A S) (w_i - w)^2: the posterior mean where weights spread by a variance S, which is estimated from all of them. Without Var A
 * `best` was 3.3 % worse than the denoised picture of the ring with --clamp 10 (16 samples, 20 seeds), with it 1.1 %.
 *
 * Weights that are chosen to make an estimate small make it come out small: by twice the covariance of a weight with how far the estimate is over the
 * picture's own g. A weight goes as b / A. Through b that is Var g / A: the estimate that the error is stated by, (q + s - t) / 2, becomes this one when
 * it is averaged over all orders of the replicates, so that their covariance is this one's variance (of Gaussian estimates Stein 1981). And through A it
 * is w Cov(q, g) / A. The inverse of A is taken for diagonal: right where q is as the variance. */
#include "denoise/blend.h"

#include <math.h>
#include <stdlib.h>

#define SPREAD_MOST 0.09    /* variance of tiles' weights about the whole picture's: 0.3 squared, as of numbers from 0 to 1 … */
#define SPREAD_LEAST 0.0001 /* … and 0.01 squared: else few tiles decide */

#define WHOLE 0.09          /* variance of whole pictures' weights about 0 or 1 */
#define ALIKE 7             /* variance of a pixel's q - 2 s over s^2, were both pictures alike */
#define PIXEL_MOST 1.5      /* q - 2 s of a pixel counts for at most so many times the noise of a noisy pixel */
#define WORSE 0.5           /* the denoised picture is taken to be worse where the sum of q - 2 s is so many standard errors over 0 */
#define FOLLOWED 0.5        /* share of the variance of q in what draws the weight: q itself is known, and only what is expected of it is not */

ec_result ec_blend_create(ec_blend *blend, uint32_t width, uint32_t height, const ec_film_error *noisy, ec_error *err)
{
    const double error = noisy->error * noisy->mean_luminance, pixel_noise = error > 0 ? error * error * width * height / noisy->noisy_pixels : 0;
    *blend = (ec_blend){.pixel_noise = pixel_noise, .columns = (width - 1) / EC_BLEND_TILE + 1, .rows = (height - 1) / EC_BLEND_TILE + 1};
    blend->tiles = calloc((size_t)blend->columns * blend->rows, sizeof *blend->tiles);
    blend->cells = calloc(((size_t)blend->columns + 1) * (blend->rows + 1), sizeof *blend->cells);
    if (blend->tiles && blend->cells) return EC_OK;
    ec_blend_free(blend);
    return ec_fail(err, "out of memory for the tiles of --denoise");
}

void ec_blend_free(ec_blend *blend)
{
    free(blend->tiles);
    free(blend->cells);
    *blend = (ec_blend){0};
}

/* Returns a pixel's cell in one direction; share: of the corner behind. Beyond the outer tiles' middles everything belongs to the outer tile. */
static uint32_t cell_of(uint32_t pixel, uint32_t tiles, double *share)
{
    const uint32_t cell = (pixel + EC_BLEND_TILE / 2) / EC_BLEND_TILE;
    *share = cell == 0 ? 1 : cell == tiles ? 0 : (pixel + 0.5 + EC_BLEND_TILE / 2) / EC_BLEND_TILE - cell;
    return cell;
}

/* Returns the tile at the cell's near or far end; beyond the outer tiles, these. */
static uint32_t tile_at(uint32_t cell, uint32_t is_far, uint32_t tiles)
{
    const uint32_t tile = cell + is_far;
    return tile == 0 ? 0 : tile > tiles ? tiles - 1 : tile - 1;
}

void ec_blend_rows(uint32_t cells, uint32_t height, uint32_t *first, uint32_t *end)
{
    const uint32_t middle = EC_BLEND_TILE / 2, least = cells ? cells * EC_BLEND_TILE - middle : 0, most = cells * EC_BLEND_TILE + middle;
    *first = least < height ? least : height;
    *end = most < height ? most : height;
}

/* Returns the variance of a sum over pixels of which few may hold most: an unbiased estimate, plus one standard error of it, which vanishes among many. */
static double with_doubt(double variance, double plains) { return fmax(variance, 0) + sqrt(plains); }

static void add_to_tile(ec_tile_sums *t, const ec_judged *j, double pixel_noise)
{
    t->pixels++;
    t->clean += j->clean;
    t->noisy += j->noisy;
    t->apart += j->apart;
    t->noise += j->noise;
    t->gain += j->gain;
    t->gain_apart += j->gain_apart;
    t->noisy_squares += j->noisy * j->noisy;
    t->variance += j->gain_variance;
    t->excess += fmin(j->apart - 2 * j->noisy, PIXEL_MOST * fmax(j->noisy, pixel_noise));
    t->apart_variance += j->apart_variance;
    t->plains += j->gain_plain * j->gain_plain;
}

static void corner_shares(double right, double down, double share[4])
{
    share[0] = (1 - right) * (1 - down), share[1] = right * (1 - down), share[2] = (1 - right) * down, share[3] = right * down;
}

static void add_to_cell(ec_blend_cell *c, const ec_judged *j, const double share[4])
{
    for (int i = 0; i < 4; i++) {
        c->linear[i] += share[i] * j->gain;
        c->together[i] += share[i] * share[i] * share[i] * j->gain_apart;
        const double square = share[i] * share[i], plain = square * j->gain_plain;
        c->variance[i] += square * j->gain_variance;
        c->apart_variance[i] += square * j->apart_variance;
        c->plains[i] += plain * plain;
        for (int k = 0; k < 4; k++) c->square[i][k] += share[i] * share[k] * j->apart;
    }
}

void ec_blend_add_row(ec_blend *b, uint32_t row, const ec_judged *pixels, uint32_t width)
{
    double down, right, share[4];
    ec_blend_cell *cells = b->cells + (size_t)cell_of(row, b->rows, &down) * (b->columns + 1);
    ec_blend_tile *tiles = b->tiles + (size_t)(row / EC_BLEND_TILE) * b->columns;
    const uint32_t half = row % EC_BLEND_TILE / (EC_BLEND_TILE / 2);
    for (uint32_t x = 0; x < width; x++) {
        ec_blend_cell *cell = &cells[cell_of(x, b->columns, &right)];
        corner_shares(right, down, share);
        add_to_cell(cell, &pixels[x], share);
        add_to_tile(&tiles[x / EC_BLEND_TILE].half[half], &pixels[x], b->pixel_noise);
    }
}

static double within(double w) { return fmin(fmax(w, 0), 1); }

/* Chooses a single weight for the whole picture. */
static double choose_one(const ec_blend *b)
{
    double apart = 0, excess = 0, squares = 0, linear = 0, together = 0, variance = 0, plains = 0, apart_variance = 0;
    for (size_t i = 0; i < (size_t)b->columns * b->rows; i++) {
        const ec_tile_sums t = ec_blend_sums(&b->tiles[i]);
        apart += t.apart;
        excess += t.excess;
        squares += t.noisy_squares;
        linear += t.gain;
        together += t.gain_apart;
        variance += t.variance;
        apart_variance += t.apart_variance;
        plains += t.plains;
    }
    if (!(apart > 0)) return 1; /* the two pictures are alike */
    const double to = squares > 0 ? within(1 - excess / (WORSE * sqrt(ALIKE * squares))) : 0;
    const double draw = (with_doubt(variance, plains) + FOLLOWED * to * to * fmax(apart_variance, 0)) / (apart * WHOLE);
    linear -= fmax(together, 0) / apart;
    return within((linear + draw * to) / (apart + draw));
}

/* The sum over a tile's cells as a parabola in the tile's weight, the other weights being fixed: its vertex is at linear / square. */
typedef struct vertex {
    double square, linear, together, variance, apart_variance, plains;
} vertex;

static void look_at_cell(const ec_blend *b, uint32_t tile_row, uint32_t tile_column, uint32_t cell_row, uint32_t cell_column, vertex *v)
{
    const ec_blend_cell *c = &b->cells[(size_t)cell_row * (b->columns + 1) + cell_column];
    for (uint32_t i = 0; i < 4; i++) {
        if (tile_at(cell_row, i / 2, b->rows) != tile_row || tile_at(cell_column, i % 2, b->columns) != tile_column) continue;
        v->linear += c->linear[i];
        v->together += c->together[i];
        v->variance += c->variance[i];
        v->apart_variance += c->apart_variance[i];
        v->plains += c->plains[i];
        for (uint32_t k = 0; k < 4; k++) {
            const uint32_t row = tile_at(cell_row, k / 2, b->rows), column = tile_at(cell_column, k % 2, b->columns);
            if (row == tile_row && column == tile_column) v->square += c->square[i][k];
            else v->linear -= c->square[i][k] * b->tiles[(size_t)row * b->columns + column].weight;
        }
    }
}

/* Returns the variance of linear - square * weight, with the weight of the whole picture. */
static double noise_of(const vertex *v, double of_all)
{
    return with_doubt(v->variance, v->plains) + of_all * of_all * fmax(v->apart_variance, 0);
}

static vertex look_at_tile(const ec_blend *b, uint32_t row, uint32_t column)
{
    vertex v = {0};
    for (uint32_t k = 0; k < 4; k++) look_at_cell(b, row, column, row + k / 2, column + k % 2, &v);
    if (v.square > 0) v.linear -= fmax(v.together, 0) / v.square;
    return v;
}

/* Returns the variance of tiles' weights about the whole picture's, beyond what noise makes of it: the mean over tiles, each weighted by what it
 * tells (DerSimonian and Laird 1986). */
static double find_spread(const ec_blend *b, double of_all)
{
    double sum = 0, shares = 0;
    for (uint32_t row = 0; row < b->rows; row++)
        for (uint32_t column = 0; column < b->columns; column++) {
            const vertex v = look_at_tile(b, row, column);
            if (!(v.square > 0)) continue;
            const double noise = noise_of(&v, of_all) / (v.square * v.square), apart = within(v.linear / v.square) - of_all;
            const double share = 1 / ((noise + SPREAD_MOST) * (noise + SPREAD_MOST));
            sum += share * (apart * apart - noise);
            shares += share;
        }
    return shares > 0 ? fmin(fmax(sum / shares, SPREAD_LEAST), SPREAD_MOST) : SPREAD_MOST;
}

/* Makes a step of coordinate descent in one tile; returns how far the weight moves. */
static double step(ec_blend *b, uint32_t row, uint32_t column, double of_all, double spread)
{
    ec_blend_tile *t = &b->tiles[(size_t)row * b->columns + column];
    const vertex v = look_at_tile(b, row, column);
    const double before = t->weight, draw = v.square > 0 ? noise_of(&v, of_all) / (v.square * spread) : 1, square = v.square + draw;
    const double w = (v.linear + draw * of_all) / square;
    t->weight = within(w);
    t->slope = w > 0 && w < 1 && v.square > 0 ? 1 / (2 * square) : 0;
    return fabs(t->weight - before);
}

void ec_blend_choose(ec_blend *b)
{
    enum { SWEEPS = 100 };
    const double of_all = choose_one(b);
    double moved = 1, spread;
    for (size_t i = 0; i < (size_t)b->columns * b->rows; i++) b->tiles[i].weight = of_all;
    spread = find_spread(b, of_all);
    for (uint32_t k = 0; k < SWEEPS && moved > 1e-4; k++) {
        moved = 0;
        for (uint32_t row = 0; row < b->rows; row++)
            for (uint32_t column = 0; column < b->columns; column++) moved = fmax(moved, step(b, row, column, of_all, spread));
    }
}

ec_blend_at ec_blend_look(const ec_blend *b, uint32_t x, uint32_t y)
{
    double right, down, share[4];
    const uint32_t column = cell_of(x, b->columns, &right), row = cell_of(y, b->rows, &down);
    ec_blend_at at = {0};
    corner_shares(right, down, share);
    for (uint32_t i = 0; i < 4; i++) {
        const ec_blend_tile *t = &b->tiles[(size_t)tile_at(row, i / 2, b->rows) * b->columns + tile_at(column, i % 2, b->columns)];
        const ec_tile_sums sums = ec_blend_sums(t);
        at.weight += share[i] * t->weight;
        at.square += share[i] * fmax(sums.clean, sums.noise) / sums.pixels;
        at.optimism += share[i] * share[i] * t->slope;
    }
    return at;
}
