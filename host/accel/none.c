/* No structure: the triangles in blocks of eight. */
#include "accel/accel_internal.h"
#include "accel/build_internal.h"
#include "base/freed.h"

#define NONE_MOST 20000u /* triangles: a ray through so many takes about 30 us, and a small picture minutes */

ec_result ec_none_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    if (in->triangle_count > NONE_MOST)
        return ec_fail(err, "without an acceleration structure at most %u triangles can be traced, but the scene has %u; "
                       "use an --accel other than none", NONE_MOST, in->triangle_count);
    EC_FREED ec_ref *refs = NULL;
    ec_box bounds;
    uint32_t ref_count;
    EC_TRY(ec_accel_refs(in, &refs, &ref_count, &bounds, err));
    uint32_t count = (ref_count + 7) / 8;
    uint32_t *header = ec_allocate_lines(1, sizeof *header);
    ec_tri8 *blocks = ec_allocate_lines(count, sizeof *blocks);
    ec_box8 *boxes = in->bvh.boxes ? ec_allocate_lines(count, sizeof *boxes) : NULL;
    bool is_whole = header && blocks && (boxes || !in->bvh.boxes);
    for (uint32_t i = 0; is_whole && i < count; i++) {
        uint32_t which[8], first = 8 * i, left = ref_count - first;
        for (uint32_t k = 0; k < 8; k++) which[k] = first + k;
        ec_accel_block(in, refs, which, left < 8 ? left : 8, &blocks[i], boxes ? &boxes[i] : NULL);
    }
    if (header) *header = count;
    accel->buffers[0] = (ec_accel_buffer){"count", header, sizeof *header};
    accel->buffers[1] = (ec_accel_buffer){"triangle blocks", blocks, (uint64_t)count * sizeof *blocks};
    if (boxes) accel->buffers[2] = (ec_accel_buffer){"boxes", boxes, (uint64_t)count * sizeof *boxes};
    accel->stats = (ec_accel_stats){.leaves = count, .references = ref_count};
    return is_whole ? EC_OK : ec_fail(err, "out of memory for %u triangles", in->triangle_count);
}
