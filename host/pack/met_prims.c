/* Places a triangle, with the corners that scene/write_out.c writes. Only triangles that rounding makes lines are not dropped: nothing lies on them
 * anyway. */
#include "pack/met_prims.h"

#include <stdlib.h>
#include <string.h>

static void place_prim(const ec_placed *placed, const ec_prim *from, ec_prim *to)
{
    *to = *from;
    ec_placed_point(placed, from->v0, to->v0);
    ec_placed_point(placed, placed->mirrored ? from->v2 : from->v1, to->v1);
    ec_placed_point(placed, placed->mirrored ? from->v1 : from->v2, to->v2);
}

ec_result ec_pack_met_prims(const ec_scene *s, const ec_pack *pack, ec_prim **met, uint32_t *count, ec_error *err)
{
    const uint64_t all = ec_scene_met_count(s);
    *met = pack->prims;
    *count = pack->prim_count;
    if (!s->placed_count) return EC_OK;
    *met = NULL;
    if (all > EC_MET_PRIMS_MOST) return EC_OK;
    *count = (uint32_t)all;
    *met = malloc(all * sizeof **met);
    if (!*met) return ec_fail(err, "out of memory for %u triangles", *count);
    memcpy(*met, pack->prims, ec_scene_flat_count(s) * sizeof **met);
    for (uint32_t i = 0; i < s->placed_count; i++) {
        const ec_placed *placed = &s->placed[i];
        const ec_shape *shape = &s->shapes[placed->shape];
        for (uint32_t t = 0; t < shape->count; t++) place_prim(placed, &pack->prims[shape->first + t], &(*met)[placed->id + t]);
    }
    return EC_OK;
}
