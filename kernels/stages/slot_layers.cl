/* Averages the layers of a pixel's samples in this batch, added in sample order. Reads: the slots' layers. Writes: three floats a layer and pixel, in
 * row order from film_row on, or in the list's. After accumulate. */
#include "../lib/film.h"
#include "../lib/kernel.h"
#include "../lib/sum.h"

#define SLOT_LAYERS_PARAMETERS(DO)                                                                                                                    \
    DO(uint, first_pixel) DO(global const uint *, pixel_list) DO(uint, pixel_count) DO(global const float *, radiance)                                \
    DO(global float *, layer_film)

EC_KERNEL(ec_slot_layers, LANES, SLOT_LAYERS_PARAMETERS, slot_entries(pixel_count, i))
{
    uint wave = params->wave, batch = params->batch, fields = 3 * params->layer_count;
    uint places[LANES];
    pixel_to_places(params, LANE_NUMBERS + (first_pixel + i), places);
    for (uint k = 0; k < min(left, (uint)LANES); k++) {
        ulong place = pixel_list ? first_pixel + i + k : places[k];
        for (uint c = 0; c < fields; c++) layer_film[fields * place + c] = mean_of(radiance + (3 + c) * (ulong)wave + (i + k) * batch, batch);
    }
}
