/* First-hit features, the mean over a pixel's samples. Reads: the slots' features. Writes: 8 floats a pixel in row order from
 * film_row on. */
#include "../lib/film.h"
#include "../lib/kernel.h"
#include "../shared/path_state.h"

#define FEATURES_PARAMETERS(DO)                                                                                                                       \
    DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(uint, pixel_count) DO(global const float *, aov) DO(global float *, feature_film)

EC_KERNEL(ec_features, 1u, FEATURES_PARAMETERS, slot_entries(pixel_count, i))
{
    uint wave = params->wave, batch = params->batch;
    uint x, y;
    pixel_to_xy_one(params, pixel_list ? pixel_list[EC_LIST_WORDS * (first_pixel + i)] : first_pixel + i, &x, &y);
    global float *out = feature_film + EC_AOV_FIELDS * ((ulong)(y - params->film_row) * params->width + x);
    for (uint c = 0; c < EC_AOV_FIELDS; c++) {
        float sum = 0.0f;
        for (uint s = 0; s < batch; s++) sum += aov[c * wave + i * batch + s];
        out[c] = sum / (float)batch;
    }
}
