/* Adds to each sample of a pixel that a lamp's edge goes through what it sees of lamps at first sight: the mean of EC_EDGE_RAYS camera rays of its
 * own, which end there (host/device/lamp_edges.h). Reads: params, the list of the wave. Changes: the radiance of the samples' slots, whose paths
 * leave that light out. */
#include "../lib/kernel.h"
#include "../lib/slot_layers.h"
#include "../lib/sum.h"

#define LAMP_EDGES_PARAMETERS(DO)                                                                                                                     \
    DO(global const uint *, pixel_list) DO(uint, path_count) DO(uint, pixel_count) DO(global float *, radiance)

/* Return how many positions of the wave such rays take, and how many pixels these belong to. */
EC_INLINED uint edge_positions(constant ec_params *params, uint path_count, uint pixel_count) { return path_count / params->batch - pixel_count; }
EC_INLINED uint edge_pixels(constant ec_params *params, uint path_count, uint pixel_count)
{
    return edge_positions(params, path_count, pixel_count) / EC_EDGE_RAYS;
}

EC_RUN_KERNEL(ec_lamp_edges, LAMP_EDGES_PARAMETERS, slot_entries(edge_pixels(params, path_count, pixel_count), i))
{
    uint wave = params->wave, batch = params->batch, positions = edge_positions(params, path_count, pixel_count);
    uint pixel = pixel_list[EC_LIST_WORDS * (pixel_count + positions + i)];
    for (uint layer = 0; layer <= (HAS(LAYERS) ? params->layer_count : 0u); layer++) {
        if (layer && (layer == params->layer_of[EC_LAYER_POSITION] || layer == params->layer_of[EC_LAYER_UV] || layer == params->layer_of[EC_LAYER_MOTION])) continue;
        global float *samples = layer_at(params, radiance, layer) + pixel * batch;
        global const float *rays = layer_at(params, radiance, layer) + (pixel_count + i * EC_EDGE_RAYS) * batch;
        for (uint c = 0; c < 3u; c++)
            for (uint s = 0; s < batch; s++) samples[c * wave + s] += mean_of(rays + c * wave + s * EC_EDGE_RAYS, EC_EDGE_RAYS);
    }
}
