/* Converts linear radiance to sRGB of 8 and 16 bits. */
#include <math.h>

#include "image/image.h"

/* Applies the exposure; non-finite and negative values become 0. The upper limit keeps infinity out of the curves' squares if the exposure is absurd. */
static double expose(double value, double scale)
{
    if (!isfinite(value) || value <= 0) return 0;
    return fmin(value * scale, 1e30);
}

void ec_tonemap_pixel(double rgb[3], double scale, ec_tonemap tonemap)
{
    for (int c = 0; c < 3; c++) rgb[c] = expose(rgb[c], scale);
    ec_tone_curve_apply(tonemap, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = ec_srgb_encode(rgb[c]);
}

static void put(double x, const ec_raster *to, uint8_t *out, uint32_t channel)
{
    if (to->bits == 8) {
        out[channel] = (uint8_t)lrint(255 * x);
        return;
    }
    const long value = lrint(65535 * x);
    out[2 * channel] = (uint8_t)(value >> 8);
    out[2 * channel + 1] = (uint8_t)value;
}

/* The arguments of ec_screen_pixels. */
typedef struct showing {
    const ec_screen *screen;
    const float *rgb, *alpha;
    uint64_t stride, first;
    const ec_raster *to;
    uint8_t *out;
    double scale;     /* exposure as a factor */
    double behind[3]; /* the background's colour, linear */
    const ec_srgb_rounder *rounder;
} showing;

/* Computes a pixel's radiance after exposure, multiplied back from its coverage, which is returned. */
static double light_of(const showing *s, uint64_t i, double light[3])
{
    const ec_screen *screen = s->screen;
    const double alone = screen->background.kind != EC_BACKDROP_ENVIRONMENT ? fmin(fmax(s->alpha[s->stride * i], 0), 1) : 1, covered = screen->behind ? 1 : alone;
    double far[3] = {0};
    if (screen->behind && alone < 1) ec_behind_look(screen->behind, (uint32_t)((s->first + i) % s->to->width), (uint32_t)((s->first + i) / s->to->width), far);
    for (int c = 0; c < 3; c++) light[c] = covered > 0 ? expose(s->rgb[3 * i + (uint64_t)c] + (1 - alone) * far[c], s->scale / covered) : 0;
    return covered;
}

/* Writes a pixel. shown: from 0 to 1, before the sRGB curve. */
static void put_pixel(const showing *s, uint64_t i, const double shown[3], double covered)
{
    uint8_t *pixel = s->out + i * ec_raster_pixel_bytes(s->to);
    const bool lies_on = s->screen->background.kind == EC_BACKDROP_COLOR;
    for (uint32_t c = 0; c < 3; c++) {
        const double linear = lies_on ? covered * shown[c] + (1 - covered) * s->behind[c] : shown[c];
        if (s->to->bits == 8) pixel[c] = ec_srgb_round(s->rounder, linear);
        else put(ec_srgb_encode(linear), s->to, pixel, c);
    }
    if (s->to->channels == 4) put(covered, s->to, pixel, 3);
}

/* Writes a view's values, which are taken as sRGB. */
static void put_view(const showing *s, uint64_t i, const float *view, double covered)
{
    double shown[3];
    for (int c = 0; c < 3; c++) shown[c] = ec_srgb_to_linear(view[c] > 0 ? fmin(view[c], 1) : 0);
    put_pixel(s, i, shown, covered);
}

enum { BLOCK = 1 << 10 };

static void show_block(const showing *s, uint64_t first, uint64_t count)
{
    float view[3 * BLOCK];
    double covered[BLOCK], light[3];
    for (uint64_t i = 0; i < count; i++) {
        covered[i] = light_of(s, first + i, light);
        for (uint64_t c = 0; c < 3; c++) view[3 * i + c] = (float)light[c];
    }
    ec_ocio_show(s->screen->ocio, view, count);
    for (uint64_t i = 0; i < count; i++) put_view(s, first + i, view + 3 * i, covered[i]);
}

void ec_screen_pixels(const ec_screen *screen, const float *rgb, const float *alpha, uint32_t stride, uint64_t first, uint64_t count, const ec_raster *to, void *out)
{
    showing s = {.screen = screen, .rgb = rgb, .alpha = alpha, .stride = stride, .first = first, .to = to, .out = out};
    s.scale = exp2(screen->exposure);
    s.rounder = ec_srgb_get_rounder();
    for (int c = 0; c < 3; c++) s.behind[c] = ec_srgb_to_linear(screen->background.rgb[c] / 255.0);
#pragma omp parallel for schedule(static) if (count > 1 << 14)
    for (uint64_t block = 0; block < count; block += BLOCK) {
        const uint64_t end = count - block < BLOCK ? count : block + BLOCK;
        if (screen->ocio) show_block(&s, block, end - block);
        for (uint64_t i = block; !screen->ocio && i < end; i++) {
            double light[3];
            const double covered = light_of(&s, i, light);
            ec_tone_curve_apply(screen->tonemap, light);
            put_pixel(&s, i, light, covered);
        }
    }
}

void ec_tonemap_rgb(const float *in, uint8_t *out, uint64_t pixel_count, float exposure_ev, ec_tonemap tonemap)
{
    const ec_screen screen = {.exposure = exposure_ev, .tonemap = tonemap};
    ec_screen_pixels(&screen, in, NULL, 0, 0, pixel_count, &(ec_raster){.channels = 3, .bits = 8}, out);
}
