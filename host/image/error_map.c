#include "image/error_map.h"

#include <math.h>

#include "film/film.h"

void ec_error_map(const float *a, const float *b, uint64_t pixel_count, uint8_t *out)
{
    for (uint64_t p = 0; p < pixel_count; p++) {
        const float *x = a + 3 * p, *r = b + 3 * p;
        double square = 0;
        for (int c = 0; c < 3; c++) square += ((double)x[c] - r[c]) * ((double)x[c] - r[c]) / 3;
        double relative = sqrt(square) / (fabs(ec_luminance((double[3]){r[0], r[1], r[2]})) + EC_RELMSE_FLOOR);
        ec_magma(relative > 0 ? 1 + log10(relative) / 3 : 0, out + 3 * p);
    }
}
