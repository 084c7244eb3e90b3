/* Linear radiance to 8-bit sRGB, and sRGB to linear. */
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

void ec_tonemap_rgb(const float *in, uint8_t *out, uint64_t pixel_count, float exposure_ev, ec_tonemap tonemap)
{
    const double scale = exp2(exposure_ev);
#pragma omp parallel for schedule(static) if (pixel_count > 1 << 14)
    for (uint64_t i = 0; i < pixel_count; i++) {
        double rgb[3] = {in[3 * i], in[3 * i + 1], in[3 * i + 2]};
        ec_tonemap_pixel(rgb, scale, tonemap);
        for (int c = 0; c < 3; c++) out[3 * i + c] = (uint8_t)lrint(255 * rgb[c]);
    }
}
