/* Linear radiance to sRGB of 8 and 16 bits, and sRGB to linear. */
#include <math.h>
#include <pthread.h>

#include "image/image.h"

/* IEC 61966-2-1, on [0, 1]. */
static double srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

double ec_srgb_to_linear(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* Non-finite to 0 and negative to 0; the upper limit keeps infinity out of the curves' squares, when the exposure is absurd. */
static double expose(double value, double scale)
{
    if (!isfinite(value) || value <= 0) return 0;
    return fmin(value * scale, 1e30);
}

static double srgb_bytes[256];

static void fill_srgb_bytes(void)
{
    for (int i = 0; i < 256; i++) srgb_bytes[i] = ec_srgb_to_linear(i / 255.0);
}

const double *ec_srgb_bytes(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, fill_srgb_bytes);
    return srgb_bytes;
}

void ec_tonemap_pixel(double rgb[3], double scale, ec_tonemap tonemap)
{
    for (int c = 0; c < 3; c++) rgb[c] = expose(rgb[c], scale);
    ec_tone_curve_apply(tonemap, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = srgb_encode(rgb[c]);
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

void ec_screen_pixels(const ec_screen *s, const float *rgb, const float *alpha, uint32_t stride, uint64_t first, uint64_t count, const ec_raster *to, void *out)
{
    const double scale = exp2(s->exposure);
    const bool covers = s->background.kind != EC_BACKDROP_ENVIRONMENT, shows = s->background.kind == EC_BACKDROP_COLOR;
    double behind[3];
    for (int c = 0; c < 3; c++) behind[c] = ec_srgb_to_linear(s->background.rgb[c] / 255.0);
#pragma omp parallel for schedule(static) if (count > 1 << 14)
    for (uint64_t i = 0; i < count; i++) {
        const double alone = covers ? fmin(fmax(alpha[stride * i], 0), 1) : 1, covered = s->behind ? 1 : alone;
        uint8_t *pixel = (uint8_t *)out + i * ec_raster_pixel_bytes(to);
        double light[3], far[3] = {0};
        if (s->behind && alone < 1) ec_behind_look(s->behind, (uint32_t)((first + i) % to->width), (uint32_t)((first + i) / to->width), far);
        for (int c = 0; c < 3; c++) light[c] = covered > 0 ? expose(rgb[3 * i + (uint64_t)c] + (1 - alone) * far[c], scale / covered) : 0;
        ec_tone_curve_apply(s->tonemap, light);
        for (uint32_t c = 0; c < 3; c++) put(srgb_encode(shows ? covered * light[c] + (1 - covered) * behind[c] : light[c]), to, pixel, c);
        if (to->channels == 4) put(covered, to, pixel, 3);
    }
}

void ec_tonemap_rgb(const float *in, uint8_t *out, uint64_t pixel_count, float exposure_ev, ec_tonemap tonemap)
{
    const ec_screen screen = {.exposure = exposure_ev, .tonemap = tonemap};
    ec_screen_pixels(&screen, in, NULL, 0, 0, pixel_count, &(ec_raster){.channels = 3, .bits = 8}, out);
}
