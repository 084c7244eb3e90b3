/* What layers of a pixel's samples in this batch come to, added in sample order. Reads: the slots' layers. Writes: three floats a layer and
 * pixel, in row order from film_row on, or in the list's. After accumulate. */
#include "../lib/film.h"
#include "../lib/sum.h"

#if LANES != 1
#error "one work-item a pixel: build with LANES 1"
#endif

kernel void ec_slot_layers(constant ec_params *params, uint first_pixel, global const uint *pixel_list, uint pixel_count,
                           global const float *radiance, global float *layer_film)
{
    uint i = get_global_id(0), wave = params->wave, batch = params->batch, fields = 3 * params->layer_count;
    if (i >= pixel_count) return;
    uint x, y;
    pixel_to_xy(params, first_pixel + i, &x, &y);
    ulong place = pixel_list ? (ulong)(first_pixel + i) : (ulong)(y - params->film_row) * params->width + x;
    for (uint c = 0; c < fields; c++) layer_film[fields * place + c] = mean_of(radiance + (3 + c) * (ulong)wave + i * batch, batch);
}
