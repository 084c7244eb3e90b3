/* First-hit features, the mean over a pixel's samples. Reads: the slots' features. Writes: 8 floats a pixel in row order from
 * film_row on. */
#include "../lib/film.h"
#include "../lib/kernel.h"
#include "../shared/path_state.h"

#define FEATURES_PARAMETERS(DO)                                                                                                                       \
    DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(uint, pixel_count) DO(global const float *, aov) DO(global float *, feature_film)

EC_KERNEL(ec_features, LANES, FEATURES_PARAMETERS, slot_entries(pixel_count, i))
{
    uint wave = params->wave, batch = params->batch;
    uint places[LANES];
    lane_u pixel = LANE_NUMBERS + (first_pixel + i);
    pixel_to_places(params, pixel_list ? gather_u(pixel_list, pixel * EC_LIST_WORDS) : pixel, places);
    for (uint k = 0; k < min(left, (uint)LANES); k++)
        for (uint c = 0; c < EC_AOV_FIELDS; c++) {
            float sum = 0.0f;
            for (uint s = 0; s < batch; s++) sum += aov[c * wave + (i + k) * batch + s];
            feature_film[EC_AOV_FIELDS * (ulong)places[k] + c] = sum / (float)batch;
        }
}
