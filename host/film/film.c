/* Batches into means and sums of powers of deviations, and those into pictures. */
#include "film/film.h"

#include <math.h>
#include <stdlib.h>

ec_result ec_film_create(ec_film *film, uint32_t width, uint32_t height, uint32_t samples_per_batch, ec_error *err)
{
    uint64_t pixels = (uint64_t)width * height;
    *film = (ec_film){.width = width, .height = height, .samples_per_batch = samples_per_batch};
    if (pixels == 0) return ec_fail(err, "an image of %u x %u pixels is empty; ask for at least 1x1", width, height);
    film->mean = calloc(pixels, 3 * sizeof(double));
    film->m2 = calloc(pixels, 4 * sizeof(double));
    film->m34 = calloc(pixels, 2 * sizeof(float));
    film->largest = calloc(pixels, sizeof(float));
    if (film->mean && film->m2 && film->m34 && film->largest) return EC_OK;
    ec_film_destroy(film);
    return ec_fail(err, "out of memory for an image of %u x %u pixels (%.1f MB); ask for a smaller one", width, height,
                   (double)pixels * 68 / 1e6);
}

void ec_film_destroy(ec_film *film)
{
    free(film->mean);
    free(film->m2);
    free(film->m34);
    free(film->largest);
    free(film->aov);
    free(film->unsampled);
    free(film->counts);
    *film = (ec_film){0};
}

/* Welford's update (Technometrics 4, 1962) for a channel; n counts the new value x too. */
static inline void update_channel(double *mean, double *m2, double x, double n)
{
    double delta = x - *mean;
    *mean += delta / n;
    *m2 += delta * (x - *mean);
}

/* Its continuation to the third and fourth power: Pebay, Sandia report SAND2008-6212, eqs. 1.6 and 1.7 with one new
 * value. delta = x - old mean. Floats suffice: they only widen the error bound, which needs a few digits of them. */
static inline void update_luminance(double *m2, float *m34, double delta, double n)
{
    double step = delta / n, added = delta * step * (n - 1); /* what M2 grows by */
    double m3 = m34[0], m4 = m34[1];
    m34[1] = (float)(m4 + step * step * (added * (n * n - 3 * n + 3) + 6 * *m2) - 4 * step * m3);
    m34[0] = (float)(m3 + step * (added * (n - 2) - 3 * *m2));
    *m2 += added;
}

static inline void update_pixel(ec_film *film, uint64_t p, const float *rgb, double n)
{
    double *mean = film->mean + 3 * p, *m2 = film->m2 + 4 * p, x[3];
    for (int c = 0; c < 3; c++) {
        x[c] = rgb[c];
        if (!isfinite(x[c])) x[c] = 0, film->invalid_count++;
    }
    double luminance = ec_luminance(x);
    film->largest[p] = (float)fmax(film->largest[p], luminance);
    update_luminance(m2 + 3, film->m34 + 2 * p, luminance - ec_luminance(mean), n);
    for (int c = 0; c < 3; c++) update_channel(mean + c, m2 + c, x[c], n);
}

void ec_film_add_batch(ec_film *film, const float *batch_mean)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    film->batch_count++;
    for (uint64_t p = 0; p < pixels; p++) {
        if (film->counts) film->counts[p]++;
        update_pixel(film, p, batch_mean + 3 * p, ec_film_batches(film, p));
    }
}

ec_result ec_film_add_some(ec_film *film, const float *means, const uint32_t *places, uint32_t count, ec_error *err)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    if (!film->counts) {
        film->counts = malloc(pixels * sizeof *film->counts);
        if (!film->counts) return ec_fail(err, "out of memory for the sample counts of %llu pixels", (unsigned long long)pixels);
        for (uint64_t p = 0; p < pixels; p++) film->counts[p] = film->batch_count;
    }
    for (uint32_t i = 0; i < count; i++) update_pixel(film, places[i], means + 3 * (uint64_t)i, ++film->counts[places[i]]);
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
