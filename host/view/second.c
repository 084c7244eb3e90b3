#include "view/second.h"

#include <math.h>
#include <stdlib.h>

#include "film/pixel.h"
#include "image/error_map.h"
#include "view/slice.h"

#define RUNG_SAMPLES 4u

void ec_view_others_open(ec_view_others *o, const char *against)
{
    *o = (ec_view_others){0};
    if (against && ec_image_read_rgb(against, &o->file_width, &o->file_height, &o->file, NULL) != EC_OK) o->file = NULL;
}

void ec_view_others_forget(ec_view_others *o)
{
    free(o->rung);
    o->rung = NULL;
}

void ec_view_others_close(ec_view_others *o)
{
    ec_view_others_forget(o);
    free(o->file);
    free(o->fitted);
    o->file = o->fitted = NULL;
}

ec_result ec_view_others_render(ec_view_others *o, ec_session *session, uint32_t width, uint32_t height,
                                bool (*go_on)(void *user), void *user, ec_error *err)
{
    float *mean = malloc((size_t)width * height * 3 * sizeof *mean);
    if (!mean) return ec_fail(err, "out of memory for a second picture");
    ec_session_batch batch = {.samples = RUNG_SAMPLES, .go_on = go_on, .user = user, .slice = EC_VIEW_SLICE, .rgb = mean};
    ec_result result = ec_session_take(session, &batch, err);
    if (result == EC_OK && batch.complete) o->rung = mean;
    else free(mean);
    return result;
}

/* The mean of what a pixel of another grid covers; of a coarser one the nearest. */
static void resample(const ec_view_others *o, float *out, uint32_t width, uint32_t height)
{
    for (uint64_t y = 0; y < height; y++)
        for (uint64_t x = 0; x < width; x++) {
            uint64_t x0 = x * o->file_width / width, x1 = (x + 1) * o->file_width / width, y0 = y * o->file_height / height;
            uint64_t y1 = (y + 1) * o->file_height / height, count = 0;
            double sum[3] = {0, 0, 0};
            for (uint64_t v = y0; v == y0 || v < y1; v++)
                for (uint64_t u = x0; u == x0 || u < x1; u++, count++)
                    for (int c = 0; c < 3; c++) sum[c] += (double)o->file[3 * (v * o->file_width + u) + c];
            for (int c = 0; c < 3; c++) out[3 * (y * width + x) + c] = (float)(sum[c] / (double)count);
        }
}

/* At the picture's size: that is what the window has textures and buffers for. */
static bool show_file(ec_view_others *o, ec_view *view, const ec_view_wish *wish, uint32_t width, uint32_t height)
{
    if (!o->file) return true;
    if (o->fitted && (o->fitted_width != width || o->fitted_height != height)) free(o->fitted), o->fitted = NULL;
    if (!o->fitted && (o->fitted = malloc((size_t)width * height * 3 * sizeof *o->fitted))) resample(o, o->fitted, width, height);
    o->fitted_width = width;
    o->fitted_height = height;
    return !o->fitted || ec_view_show(view, wish, EC_ROLE_SECOND, o->fitted, width, height);
}

typedef struct maps {
    const ec_film *film;
    const float *mean;
} maps;

/* As `eclat compare --diff`: the standard error in the place of a difference. */
static void fill_error(const void *user, uint8_t *bytes)
{
    const maps *m = user;
    const uint64_t pixels = (uint64_t)m->film->width * m->film->height;
    for (uint64_t p = 0; p < pixels; p++) {
        ec_pixel pixel;
        float off[3];
        ec_film_look(m->film, p, 1, &pixel);
        for (int c = 0; c < 3; c++) off[c] = m->mean[3 * p + (uint64_t)c] + (float)sqrt(ec_pixel_se2(&pixel, c));
        ec_error_map(off, m->mean + 3 * p, 1, bytes + 3 * p);
    }
}

/* Black none, pale yellow the most there are. */
static void fill_samples(const void *user, uint8_t *bytes)
{
    const maps *m = user;
    uint64_t pixels = (uint64_t)m->film->width * m->film->height;
    double most = 1;
    for (uint64_t p = 0; p < pixels; p++) most = fmax(most, ec_film_samples(m->film, p));
    for (uint64_t p = 0; p < pixels; p++) ec_magma(ec_film_samples(m->film, p) / most, bytes + 3 * p);
}

bool ec_view_others_has(const ec_view_others *o, ec_view_second second, const ec_film *film)
{
    switch (second) {
    case EC_SECOND_ERROR: return film->batch_count > 1;
    case EC_SECOND_RUNG: return o->rung != NULL;
    case EC_SECOND_FILE: return o->file != NULL;
    default: return true;
    }
}

bool ec_view_others_show(ec_view_others *o, ec_view *view, const ec_view_wish *wish, const ec_film *film, const float *mean)
{
    const maps m = {film, mean};
    switch (wish->second) {
    case EC_SECOND_ERROR: return ec_view_show_filled(view, EC_ROLE_SECOND, film->width, film->height, fill_error, &m);
    case EC_SECOND_SAMPLES: return ec_view_show_filled(view, EC_ROLE_SECOND, film->width, film->height, fill_samples, &m);
    case EC_SECOND_RUNG: return !o->rung || ec_view_show(view, wish, EC_ROLE_SECOND, o->rung, film->width, film->height);
    case EC_SECOND_FILE: return show_file(o, view, wish, film->width, film->height);
    default: return true;
    }
}
