/* A film made, filled and shown as a picture. */
#include "film/film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

ec_result ec_film_create(ec_film *film, uint32_t width, uint32_t height, uint32_t samples_per_batch, ec_error *err)
{
    uint64_t pixels = (uint64_t)width * height;
    *film = (ec_film){.width = width, .height = height, .samples_per_batch = samples_per_batch};
    if (pixels == 0) return ec_fail(err, "an image of %u x %u pixels is empty; ask for at least 1x1", width, height);
    ec_moments sums;
    if (!ec_moments_create(&sums, pixels))
        return ec_fail(err, "out of memory for an image of %u x %u pixels (%.1f MB); ask for a smaller one", width, height,
                       (double)pixels * EC_MOMENTS_BYTES / 1e6);
    film->mean = sums.mean;
    film->m2 = sums.m2;
    film->m34 = sums.m34;
    film->largest = sums.largest;
    return EC_OK;
}

void ec_film_destroy(ec_film *film)
{
    ec_film_drop_parts(film);
    ec_moments_destroy(&(ec_moments){film->mean, film->m2, film->m34, film->largest});
    free(film->aov);
    free(film->unsampled);
    free(film->counts);
    *film = (ec_film){0};
}

ec_result ec_film_add_batch(ec_film *film, const float *batch_mean, ec_error *err)
{
    if (!film->counts) return ec_film_add_at(film, ec_film_end(film), batch_mean, err);
    const ec_moments sums = {film->mean, film->m2, film->m34, film->largest};
    film->batch_count++;
    for (uint64_t p = 0; p < (uint64_t)film->width * film->height; p++) {
        const ec_moments here = ec_moments_from(&sums, p);
        film->invalid_count += ec_moments_add(&here, batch_mean + 3 * p, ++film->counts[p], 1);
    }
    return EC_OK;
}

ec_result ec_film_add_some(ec_film *film, const float *means, const uint32_t *places, uint32_t count, ec_error *err)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    if (!film->counts) {
        film->counts = malloc(pixels * sizeof *film->counts);
        if (!film->counts) return ec_fail(err, "out of memory for the sample counts of %llu pixels", (unsigned long long)pixels);
        for (uint64_t p = 0; p < pixels; p++) film->counts[p] = film->batch_count;
        ec_film_drop_parts(film);
    }
    const ec_moments sums = {film->mean, film->m2, film->m34, film->largest};
    film->invalid_count += ec_moments_add_some(&sums, means, places, film->counts, count);
    return EC_OK;
}

static double to_variance_of_mean(const ec_film *film, uint64_t p)
{
    double n = ec_film_batches(film, p);
    return n >= 2 ? 1 / (n * (n - 1)) : 0;
}

void ec_film_resolve(const ec_film *film, float *rgb, float *stderr_rgb)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    for (uint64_t p = 0; p < pixels; p++)
        for (int c = 0; c < 3; c++) {
            if (rgb) rgb[3 * p + c] = (float)film->mean[3 * p + c];
            if (stderr_rgb) stderr_rgb[3 * p + c] = (float)sqrt(film->m2[4 * p + c] * to_variance_of_mean(film, p));
        }
}

void ec_film_resolve_luminance_error(const ec_film *film, float *stderr_y)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    for (uint64_t p = 0; p < pixels; p++) stderr_y[p] = (float)sqrt(film->m2[4 * p + 3] * to_variance_of_mean(film, p));
}

ec_film ec_film_rows(const ec_film *film, uint32_t first, uint32_t rows)
{
    const uint64_t before = (uint64_t)first * film->width;
    const ec_moments all = {film->mean, film->m2, film->m34, film->largest}, here = ec_moments_from(&all, before);
    return (ec_film){.width = film->width,
                     .height = rows,
                     .batch_count = film->batch_count,
                     .samples_per_batch = film->samples_per_batch,
                     .counts = film->counts ? film->counts + before : NULL,
                     .mean = here.mean,
                     .m2 = here.m2,
                     .m34 = here.m34,
                     .largest = here.largest,
                     .aov = film->aov ? film->aov + EC_FILM_FEATURES * before : NULL,
                     .unsampled = film->unsampled ? film->unsampled + before : NULL};
}

void ec_film_copy_rows(ec_film *film, uint32_t to, const ec_film *from, uint32_t first, uint32_t rows)
{
    const ec_film there = ec_film_rows(from, first, rows), here = ec_film_rows(film, to, rows);
    const uint64_t pixels = (uint64_t)rows * film->width;
    ec_moments_copy(&(ec_moments){here.mean, here.m2, here.m34, here.largest},
                    &(ec_moments){there.mean, there.m2, there.m34, there.largest}, pixels);
    if (here.aov && there.aov) memcpy(here.aov, there.aov, pixels * EC_FILM_FEATURES * sizeof *here.aov);
    film->batch_count = from->batch_count;
}
