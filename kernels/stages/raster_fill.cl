/* Fills the tiles' lists of triangles. Reads: raster triangles. Writes: the lists; `ends` starts as where each begins and becomes where it ends. Once
 * a render. Next: raster. */
#include "../lib/raster.h"
#include "../shared/accel.h"

kernel void ec_raster_fill(constant ec_params *params, uint triangle_count, global const ec_raster_tri *tris,
                           volatile global uint *ends, global uint *list)
{
    uint i = get_global_id(0);
    if (i >= triangle_count || tris[i].prim == EC_NO_ID) return;
    global const ec_raster_tri *t = tris + i;
    for (uint y = t->first_tile >> 16; y <= t->last_tile >> 16; y++)
        for (uint x = t->first_tile & 0xffffu; x <= (t->last_tile & 0xffffu); x++)
            if (raster_meets_tile(params, t, x, y)) list[atomic_inc(&ends[raster_tile_one(params, x * EC_TILE, y * EC_TILE)])] = i;
}
