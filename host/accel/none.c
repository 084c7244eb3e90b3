/* No structure: the triangles in blocks of eight. */
#include "accel/accel_internal.h"
#include "accel/build_internal.h"

#define NONE_MOST 20000u /* triangles: a ray through so many takes about 30 us, and a small picture minutes */

ec_result ec_none_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    if (in->triangle_count > NONE_MOST)
        return ec_fail(err, "without an acceleration structure at most %u triangles are traced, and the scene has %u: "
                       "take another --accel than none", NONE_MOST, in->triangle_count);
    uint32_t count = (in->triangle_count + 7) / 8;
    uint32_t *header = ec_allocate_lines(1, sizeof *header);
    ec_tri8 *blocks = ec_allocate_lines(count, sizeof *blocks);
    accel->buffers[0] = (ec_accel_buffer){"count", header, sizeof *header};
    accel->buffers[1] = (ec_accel_buffer){"triangle blocks", blocks, (uint64_t)count * sizeof *blocks};
    if (!header || !blocks) return ec_fail(err, "out of memory for %u triangles", in->triangle_count);
    *header = count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t ids[8], first = 8 * i, left = in->triangle_count - first;
        for (uint32_t k = 0; k < 8; k++) ids[k] = first + k;
        ec_accel_block(in, ids, left < 8 ? left : 8, &blocks[i]);
    }
    accel->stats = (ec_accel_stats){.leaves = count, .references = in->triangle_count};
    return EC_OK;
}
