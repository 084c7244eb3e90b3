/* First-hit features, the mean over a pixel's samples. Reads: the slots' features. Writes: 8 floats a pixel in row order from
 * film_row on. */
#include "../lib/film.h"
#include "../shared/path_state.h"

#if LANES != 1
#error "one work-item a pixel: build with LANES 1"
#endif

kernel void ec_features(constant ec_params *params, uint first_pixel, global const uint *pixel_list, uint pixel_count,
                        global const float *aov, global float *feature_film)
{
    uint i = get_global_id(0), wave = params->wave, batch = params->batch;
    if (i >= pixel_count) return;
    uint x, y;
    pixel_to_xy(params, pixel_list ? pixel_list[EC_LIST_WORDS * (first_pixel + i)] : first_pixel + i, &x, &y);
    global float *out = feature_film + EC_AOV_FIELDS * ((ulong)(y - params->film_row) * params->width + x);
    for (uint c = 0; c < EC_AOV_FIELDS; c++) {
        float sum = 0.0f;
        for (uint s = 0; s < batch; s++) sum += aov[c * wave + i * batch + s];
        out[c] = sum / (float)batch;
    }
}
