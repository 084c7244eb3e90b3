/* The mean of a pixel's samples in this batch, added in sample order. Reads: the slots' radiance. Writes: the batch film,
 * 3 floats a pixel in row order from film_row on, or in the list's. Last stage of a wave. */
#include "../lib/film.h"
#include "../lib/math.h"

#if LANES != 1
#error "one work-item a pixel: build with LANES 1"
#endif

/* Of 64 plainly, of those sums with what each addition loses put back (Kahan 1965): plain floats gain or lose 6e-4 in 65536. */
static float sum_of(global const float *in, uint count, float scale)
{
    float sum = 0.0f, lost = 0.0f;
    for (uint first = 0; first < count; first += 64) {
        float part = 0.0f;
        for (uint s = first; s < min(first + 64, count); s++) part += in[s] * scale;
        float add = part - lost, next = sum + add;
        lost = (next - sum) - add;
        sum = next;
    }
    return sum;
}

kernel void ec_accumulate(constant ec_params *params, uint first_pixel, global const uint *pixel_list, uint pixel_count,
                          global const float *radiance, global float *batch_film)
{
    uint i = get_global_id(0), wave = params->wave, batch = params->batch;
    if (i >= pixel_count) return;
    uint x, y;
    pixel_to_xy(params, first_pixel + i, &x, &y);
    global float *out =
        batch_film + 3 * (pixel_list ? (ulong)(first_pixel + i) : (ulong)(y - params->film_row) * params->width + x);
    for (uint c = 0; c < 3; c++) {
        global const float *in = radiance + c * wave + i * batch;
        float mean = sum_of(in, batch, 1.0f) / (float)batch;
        out[c] = is_finite_bits(mean) ? mean : sum_of(in, batch, 1.0f / (float)batch); /* their sum is more than a float holds */
    }
}
