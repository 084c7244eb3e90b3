/* First-hit features, the mean over a pixel's samples. Reads: the slots' features. Writes: 8 floats a pixel in row order from
 * film_row on, or in the list's. */
#include "../lib/film.h"
#include "../lib/kernel.h"
#include "../shared/path_state.h"

#define FEATURES_PARAMETERS(DO)                                                                                                                       \
    DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(uint, pixel_count) DO(global const float *, aov) DO(global float *, feature_film)

EC_KERNEL(ec_features, LANES, FEATURES_PARAMETERS, slot_entries(pixel_count, i))
{
    uint wave = params->wave, batch = params->batch;
    uint places[LANES];
    pixel_to_places(params, LANE_NUMBERS + (first_pixel + i), places);
    for (uint k = 0; k < min(left, (uint)LANES); k++) {
        ulong entry = pixel_list ? first_pixel + i + k : places[k];
        for (uint c = 0; c < EC_AOV_FIELDS; c++) {
            float sum = 0.0f;
            for (uint s = 0; s < batch; s++) sum += aov[c * wave + (i + k) * batch + s];
            feature_film[EC_AOV_FIELDS * entry + c] = sum / (float)batch;
        }
    }
}
