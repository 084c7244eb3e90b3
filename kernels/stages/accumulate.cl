/* The mean of a pixel's samples in this batch, added in sample order. Reads: the slots' radiance. Writes: the batch film,
 * 3 floats a pixel in row order, or in the list's. Last stage of a wave. */
#include "../lib/film.h"

#if LANES != 1
#error "one work-item a pixel: build with LANES 1"
#endif

kernel void ec_accumulate(constant ec_params *params, uint first_pixel, global const uint *pixel_list, uint pixel_count, global const float *radiance,
                          global float *batch_film)
{
    uint i = get_global_id(0), wave = params->wave, batch = params->batch;
    if (i >= pixel_count) return;
    uint x, y;
    pixel_to_xy(params, first_pixel + i, &x, &y);
    global float *out = batch_film + 3 * (pixel_list ? (ulong)(first_pixel + i) : (ulong)y * params->width + x);
    for (uint c = 0; c < 3; c++) {
        global const float *in = radiance + c * wave + i * batch;
        float sum = 0.0f;
        for (uint s = 0; s < batch; s++) sum += in[s];
        out[c] = sum / (float)batch;
    }
}
