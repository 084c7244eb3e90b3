/* The rasteriser: sorts triangles into tiles once, then makes a depth test a sample. */
#include <stdlib.h>

#include "device/pipeline.h"
#include "shared/raster.h"

/* Turns counts into the places where lists begin; returns their sum. */
static uint64_t scan(uint32_t *counts, uint64_t tiles)
{
    uint64_t sum = 0;
    for (uint64_t i = 0; i < tiles; i++) {
        uint32_t count = counts[i];
        counts[i] = (uint32_t)sum;
        sum += count;
    }
    return sum;
}

static ec_result sort_into_tiles(ec_pipeline *p, const uint32_t *scalars, uint32_t *tiles, uint64_t count, ec_error *err)
{
    cl_mem *starts = &p->buffers[EC_ARG_TILE_STARTS], *ends = &p->buffers[EC_ARG_TILE_ENDS];
    EC_TRY(ec_buffer_create(p->cl, "tile ends", count * 4, NULL, ends, err));
    EC_TRY(ec_buffer_zero(p->cl, *ends, 0, count * 4, err));
    EC_TRY(ec_pipeline_launch(p, EC_RASTER_SETUP, scalars, err));
    EC_TRY(ec_buffer_read(p->cl, *ends, 0, count * 4, tiles, err));
    uint64_t entries = scan(tiles, count);
    if (entries > UINT32_MAX)
        return ec_fail(err, "the tiles of %ux%u pixels would list %llu triangles, more than 2^32; give a smaller --size",
                       p->params.width, p->params.height, (unsigned long long)entries);
    EC_TRY(ec_buffer_create(p->cl, "tile starts", count * 4, tiles, starts, err));
    EC_TRY(ec_buffer_write(p->cl, *ends, 0, count * 4, tiles, err));
    EC_TRY(ec_buffer_create(p->cl, "tile lists", entries * 4, NULL, &p->buffers[EC_ARG_TILE_LIST], err));
    return ec_pipeline_launch(p, EC_RASTER_FILL, scalars, err);
}

static ec_result prepare(ec_pipeline *p, const uint32_t *scalars, ec_error *err)
{
    uint64_t bytes = (uint64_t)scalars[EC_ARG_TRIANGLE_COUNT] * sizeof(ec_raster_tri);
    EC_TRY(ec_buffer_create(p->cl, "raster triangles", bytes, NULL, &p->buffers[EC_ARG_RASTER_TRIS], err));
    uint64_t count = ((uint64_t)p->params.width + 7) / 8 * (((uint64_t)p->params.height + 7) / 8);
    uint32_t *tiles = malloc(count * sizeof *tiles);
    if (!tiles) return ec_fail(err, "out of memory for %llu tiles", (unsigned long long)count);
    ec_result result = sort_into_tiles(p, scalars, tiles, count, err);
    free(tiles);
    return result;
}

void ec_raster_forget(ec_pipeline *p)
{
    static const ec_arg of_camera[] = {EC_ARG_RASTER_TRIS, EC_ARG_TILE_STARTS, EC_ARG_TILE_ENDS, EC_ARG_TILE_LIST};
    for (size_t i = 0; i < sizeof of_camera / sizeof of_camera[0]; i++) ec_buffer_release(p->cl, &p->buffers[of_camera[i]]);
}

ec_result ec_integrate_raster(ec_pipeline *p, uint32_t *scalars, ec_error *err)
{
    if (!p->buffers[EC_ARG_TILE_LIST]) EC_TRY(prepare(p, scalars, err));
    p->rays += scalars[EC_ARG_PATH_COUNT];
    EC_TRY(ec_pipeline_launch(p, EC_RASTER, scalars, err));
    return ec_pipeline_launch(p, EC_SHADE_RASTER, scalars, err);
}
