#include "film/exposure.h"

#include <math.h>

#include "film/pixel.h"

double ec_exposure_stops(const ec_exposure *exposure, const ec_film *film)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
    ec_pixel piece[EC_PIXELS];
    double sum = 0, lit = 0;
    for (uint64_t at = 0; exposure->is_auto && at < pixels; at += EC_PIXELS) {
        const uint64_t count = pixels - at < EC_PIXELS ? pixels - at : EC_PIXELS;
        ec_film_look(film, at, count, piece);
        for (uint64_t i = 0; i < count; i++) {
            const double y = ec_luminance(piece[i].mean);
            if (!(y > 0) || !isfinite(y)) continue;
            sum += log2(y);
            lit++;
        }
    }
    if (!exposure->is_auto) return exposure->stops;
    return lit > 0 ? fmin(fmax(log2(EC_EXPOSURE_KEY) - sum / lit, -EC_EXPOSURE_MOST), EC_EXPOSURE_MOST) : 0;
}
