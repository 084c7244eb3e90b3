/* Sets up triangles in picture coordinates, and counts how many of them each tile may see. Reads: triangles. Writes: raster triangles; adds to the
 * tiles' counts. Once a render. Next: raster_fill. */
#include "../lib/raster.h"
#include "../shared/accel.h"
#include "../shared/scene_buffers.h"

kernel void ec_raster_setup(constant ec_params *params, uint triangle_count, global const float *prims, global ec_raster_tri *tris,
                            volatile global uint *counts)
{
    uint i = get_global_id(0);
    if (i >= triangle_count) return;
    view c = {point3_load(params->camera_right), point3_load(params->camera_up), point3_load(params->camera_forward),
              params->orthographic != 0u};
    point3 o = point3_load(params->camera_origin), v[3];
    for (uint k = 0; k < 3; k++) {
        global const float *p = prims + i * EC_PRIM_WORDS + 4 * k;
        v[k] = point3_sub(point3_make(p[0], p[1], p[2]), o);
    }
    global ec_raster_tri *t = tris + i;
    t->prim = EC_NO_ID;
    point3 n = point3_cross(point3_sub(v[1], v[0]), point3_sub(v[2], v[0]));
    float volume = point3_dot(v[0], point3_cross(v[1], v[2])), facing = point3_dot(n, c.forward);
    float side = c.is_flat ? facing : volume;
    float lo[2], hi[2];
    if (side == 0.0f || !isfinite(side) || !raster_box(&c, params, v, lo, hi)) return;

    float sign = side < 0.0f ? -1.0f : 1.0f;
    raster_edge(&c, v[1], v[2], sign, t->edge[0]);
    raster_edge(&c, v[2], v[0], sign, t->edge[1]);
    raster_edge(&c, v[0], v[1], sign, t->edge[2]);
    if (c.is_flat) {
        t->nearness[0] = point3_dot(n, c.right) / facing;
        t->nearness[1] = point3_dot(n, c.up) / facing;
        t->nearness[2] = -point3_dot(n, v[0]) / facing;
    } else {
        for (uint k = 0; k < 3; k++) t->nearness[k] = (t->edge[0][k] + t->edge[1][k] + t->edge[2][k]) / fabs(volume);
    }
    /* A pixel more on every side for the projection's rounding. */
    float w = (float)params->width - 1.0f, h = (float)params->height - 1.0f;
    uint x0 = (uint)clamp(lo[0] - 1.0f, 0.0f, w) / EC_TILE, x1 = (uint)clamp(hi[0] + 1.0f, 0.0f, w) / EC_TILE;
    uint y0 = (uint)clamp(lo[1] - 1.0f, 0.0f, h) / EC_TILE, y1 = (uint)clamp(hi[1] + 1.0f, 0.0f, h) / EC_TILE;
    t->first_tile = x0 | y0 << 16;
    t->last_tile = x1 | y1 << 16;
    t->prim = i;
    for (uint y = y0; y <= y1; y++)
        for (uint x = x0; x <= x1; x++)
            if (raster_meets_tile(params, t, x, y)) atomic_inc(&counts[raster_tile_one(params, x * EC_TILE, y * EC_TILE)]);
}
