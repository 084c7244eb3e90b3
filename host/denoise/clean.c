#include "denoise/clean.h"

#include <math.h>
#include <stdlib.h>

#include "denoise/blend.h"
#include "film/pixel.h"

#define OFF 0.05 /* weights below it take away at most 2.5 % of the noise: the denoiser counts as off there */

typedef struct work {
    const ec_film *film;
    const float *const *half;
    ec_blend blend;
    ec_film_clean clean;   /* room for the result */
} work;

/* Sums of a row; rows are added in order, so that sums are the same for any number of threads. */
typedef struct row_sums {
    ec_judged_sum clean, best;
    double noise;
} row_sums;

static void write_pixel(work *w, uint64_t i, const ec_blend_at *at, const double *noisy)
{
    for (uint64_t c = 3 * i; c < 3 * i + 3; c++) {
        const double clean = 0.5 * ((double)w->half[0][c] + (double)w->half[1][c]);
        w->clean.denoised[c] = (float)clean;
        w->clean.best[c] = (float)(at->weight * clean + (1 - at->weight) * noisy[c - 3 * i]);
    }
    w->clean.error[i] = (float)sqrt(fmax(at->square, 0));
}

/* Writes a row of all three planes, and sums its pixels. */
static void finish_row(work *w, uint32_t y, ec_judged *judged, ec_pixel *pixels, row_sums *sums)
{
    const uint32_t width = w->film->width;
    const uint64_t first = (uint64_t)y * width;
    ec_judge_row(w->film, y, w->half, judged);
    ec_film_look(w->film, first, width, pixels);
    for (uint32_t x = 0; x < width; x++) {
        const ec_judged *j = &judged[x];
        const ec_blend_at at = ec_blend_look(&w->blend, x, y);
        const double a = at.weight, b = 1 - a;
        write_pixel(w, first + x, &at, pixels[x].mean);
        sums->noise += j->noise;
        const ec_judged_sum clean = {j->clean, j->clean_variance, j->clean_plain, 0, j->noise};
        const ec_judged_sum best = {a * j->clean + b * j->noisy - a * b * j->apart + at.optimism * 4 * (j->gain_variance + a * j->gain_apart),
                                    a * a * j->clean_variance + b * b * j->noisy_variance, a * a * j->clean_plain + 2 * b * b * j->noisy * j->noisy,
                                    b * b * j->noisy, a * a * j->noise};
        ec_judged_join(&sums->clean, &clean);
        ec_judged_join(&sums->best, &best);
    }
}

/* Returns the middle of a tile in one direction. */
static uint32_t middle(uint32_t tile, uint32_t pixels)
{
    const uint32_t first = tile * EC_BLEND_TILE, end = first + EC_BLEND_TILE;
    return (first + (end < pixels ? end : pixels)) / 2;
}

static void count_tiles(const work *w, ec_denoised *out)
{
    double harm = 0;
    out->tiles = w->blend.columns * w->blend.rows;
    for (uint32_t i = 0; i < out->tiles; i++) {
        const ec_tile_sums t = ec_blend_sums(&w->blend.tiles[i]);
        out->nearer += t.clean < t.noisy;
        if (w->blend.tiles[i].weight >= OFF) continue;
        out->off++;
        if (out->off > 1 && t.clean - t.noisy <= harm) continue;
        harm = t.clean - t.noisy;
        out->off_x = middle(i % w->blend.columns, w->film->width);
        out->off_y = middle(i / w->blend.columns, w->film->height);
    }
}

/* First sums up the tiles and chooses weights, then makes the picture that follows from them. A thread has one row of cells at a time. */
static ec_result judge(work *w, row_sums *all, ec_error *err)
{
    const uint32_t height = w->film->height, width = w->film->width, bands = w->blend.rows + 1;
    row_sums *rows = calloc(height, sizeof *rows);
    ec_judged *judged = malloc((size_t)bands * width * sizeof *judged);
    ec_pixel *pixels = malloc((size_t)bands * width * sizeof *pixels);
    const bool made = rows && judged && pixels;
#pragma omp parallel for schedule(dynamic, 1) if (made)
    for (uint32_t band = 0; band < (made ? bands : 0); band++) {
        uint32_t first, end;
        ec_blend_rows(band, height, &first, &end);
        for (uint32_t y = first; y < end; y++) {
            ec_judge_row(w->film, y, w->half, judged + (size_t)band * width);
            ec_blend_add_row(&w->blend, y, judged + (size_t)band * width, width);
        }
    }
    if (made) ec_blend_choose(&w->blend);
#pragma omp parallel for schedule(dynamic, 1) if (made)
    for (uint32_t band = 0; band < (made ? bands : 0); band++) {
        uint32_t first, end;
        ec_blend_rows(band, height, &first, &end);
        for (uint32_t y = first; y < end; y++) finish_row(w, y, judged + (size_t)band * width, pixels + (size_t)band * width, &rows[y]);
    }
    for (uint32_t y = 0; made && y < height; y++) {
        ec_judged_join(&all->clean, &rows[y].clean);
        ec_judged_join(&all->best, &rows[y].best);
        all->noise += rows[y].noise;
    }
    free(rows);
    free(judged);
    free(pixels);
    return made ? EC_OK : ec_fail(err, "out of memory for a row of --denoise");
}

static void tell(const work *w, const row_sums *sums, const ec_film_error *noisy, ec_denoised *out)
{
    const double pixels = (double)w->film->width * w->film->height;
    out->clean = ec_judged_state(&sums->clean, pixels, noisy);
    out->best = ec_judged_state(&sums->best, pixels, noisy);
    out->noisy = noisy->error;
    out->noise = sqrt(sums->noise / pixels) / noisy->mean_luminance;
    out->bias = sqrt(fmax(out->clean.error * out->clean.error - out->noise * out->noise, 0));
    count_tiles(w, out);
}

ec_result ec_clean_make(const ec_film *film, const float *const half[2], const ec_film_error *noisy, const ec_film_clean *into, ec_denoised *out,
                        ec_error *err)
{
    work w = {.film = film, .half = half, .clean = *into};
    row_sums sums = {0};
    EC_TRY(ec_blend_create(&w.blend, film->width, film->height, noisy, err));
    const ec_result result = judge(&w, &sums, err);
    if (result == EC_OK) tell(&w, &sums, noisy, out);
    ec_blend_free(&w.blend);
    return result;
}
