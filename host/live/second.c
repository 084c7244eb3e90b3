#include "live/renderer.h"

#include <math.h>
#include <stdlib.h>

#include "film/pixel.h"
#include "image/error_map.h"

#define OTHER_SAMPLES 4u

void ec_live_second_forget(ec_live_second *s)
{
    free(s->other);
    s->other = NULL;
}

void ec_live_second_close(ec_live_second *s)
{
    ec_live_second_forget(s);
    free(s->fitted);
}

ec_result ec_live_second_render(ec_live_second *s, ec_session *session, uint32_t width, uint32_t height, bool (*go_on)(void *user), void *user,
                                ec_error *err)
{
    float *mean = malloc((size_t)width * height * 3 * sizeof *mean);
    if (!mean) return ec_fail(err, "out of memory for a second picture");
    ec_session_batch batch = {.samples = OTHER_SAMPLES, .go_on = go_on, .user = user, .slice = EC_LIVE_SLICE, .rgb = mean};
    ec_result result = ec_session_take(session, &batch, err);
    if (result == EC_OK && batch.complete) s->other = mean;
    else free(mean);
    return result;
}

/* Resamples the file to the picture's size: the mean of the pixels that each pixel covers, or the nearest. */
static void resample(const ec_live *live, float *out, uint32_t width, uint32_t height)
{
    const uint32_t across = live->against_width, down = live->against_height;
    for (uint64_t y = 0; y < height; y++)
        for (uint64_t x = 0; x < width; x++) {
            uint64_t x0 = x * across / width, x1 = (x + 1) * across / width, y0 = y * down / height, y1 = (y + 1) * down / height, count = 0;
            double sum[3] = {0, 0, 0};
            for (uint64_t v = y0; v == y0 || v < y1; v++)
                for (uint64_t u = x0; u == x0 || u < x1; u++, count++)
                    for (int c = 0; c < 3; c++) sum[c] += (double)live->against[3 * (v * across + u) + c];
            for (int c = 0; c < 3; c++) out[3 * (y * width + x) + c] = (float)(sum[c] / (double)count);
        }
}

/* Shows the file at the picture's size, to compare pixel by pixel. */
static ec_result show_file(ec_live_second *s, ec_live *live, const eclat_view_request *view, uint32_t width, uint32_t height, ec_error *err)
{
    if (s->fitted_width != width || s->fitted_height != height) free(s->fitted), s->fitted = NULL;
    if (!s->fitted && (s->fitted = malloc((size_t)width * height * 3 * sizeof *s->fitted))) resample(live, s->fitted, width, height);
    if (!s->fitted) return ec_fail(err, "out of memory for a second picture");
    s->fitted_width = width;
    s->fitted_height = height;
    return ec_live_show(live, view, ECLAT_SECOND_PICTURE, s->fitted, width, height, err);
}

/* Draws the standard error as `eclat compare --diff` draws a difference. */
static void draw_error(const ec_film *film, const float *mean, uint8_t *bytes)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
    for (uint64_t p = 0; p < pixels; p++) {
        ec_pixel pixel;
        float off[3];
        ec_film_look(film, p, 1, &pixel);
        for (int c = 0; c < 3; c++) off[c] = mean[3 * p + (uint64_t)c] + (float)sqrt(ec_pixel_se2(&pixel, c));
        ec_error_map(off, mean + 3 * p, 1, bytes + 3 * p);
    }
}

/* Draws samples per pixel: none is black, the most is pale yellow. */
static void draw_samples(const ec_film *film, uint8_t *bytes)
{
    uint64_t pixels = (uint64_t)film->width * film->height;
    double most = 1;
    for (uint64_t p = 0; p < pixels; p++) most = fmax(most, ec_film_samples(film, p));
    for (uint64_t p = 0; p < pixels; p++) ec_magma(ec_film_samples(film, p) / most, bytes + 3 * p);
}

/* Tells whether the second picture is available. An error needs two batches. */
static bool has(const ec_live_second *s, const ec_live *live, eclat_second kind, const ec_film *film)
{
    switch (kind) {
    case ECLAT_SECOND_ERROR: return film->batch_count > 1;
    case ECLAT_SECOND_SAMPLES: return true;
    case ECLAT_SECOND_INTEGRATOR: return s->other != NULL;
    case ECLAT_SECOND_FILE: return live->against != NULL;
    default: return false;
    }
}

ec_result ec_live_second_show(ec_live_second *s, ec_live *live, const eclat_view_request *view, const ec_film *film, const float *mean, bool *is_there,
                              ec_error *err)
{
    uint8_t *bytes;
    *is_there = has(s, live, view->second, film);
    if (!*is_there) return EC_OK;
    if (view->second == ECLAT_SECOND_FILE) return show_file(s, live, view, film->width, film->height, err);
    if (view->second == ECLAT_SECOND_INTEGRATOR) return ec_live_show(live, view, ECLAT_SECOND_PICTURE, s->other, film->width, film->height, err);
    EC_TRY(ec_live_canvas(live, ECLAT_SECOND_PICTURE, film->width, film->height, &bytes, err));
    if (view->second == ECLAT_SECOND_ERROR) draw_error(film, mean, bytes);
    else draw_samples(film, bytes);
    ec_live_hand_out(live, ECLAT_SECOND_PICTURE);
    return EC_OK;
}
