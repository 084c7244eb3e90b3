/* The two BVHs behind the common interface: two layouts of the same tree. */
#include "accel/accel_internal.h"

ec_result ec_accel_bvh(ec_accel_input *in, ec_error *err)
{
    if (in->bvh.nodes) return EC_OK;
    if (in->swept_count || in->whole)
        return ec_bvh_build_whole(in->positions, in->indices, in->triangle_count, in->swept, in->swept_count, in->threads, &in->bvh,
                                  &in->bvh_stats, err);
    return ec_bvh_build(in->positions, in->indices, in->triangle_count, in->threads, &in->bvh, &in->bvh_stats, err);
}

ec_result ec_bvh2_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    ec_bvh2 b;
    EC_TRY(ec_accel_bvh(in, err));
    EC_TRY(ec_bvh2_layout(&in->bvh, in->positions, in->indices, &b, err));
    accel->buffers[0] = (ec_accel_buffer){"nodes", b.nodes, (uint64_t)b.node_count * sizeof *b.nodes};
    accel->buffers[1] = (ec_accel_buffer){"triangles", b.triangles, (uint64_t)b.triangle_count * sizeof *b.triangles};
    if (b.boxes) accel->buffers[2] = (ec_accel_buffer){"boxes", b.boxes, (uint64_t)b.triangle_count * sizeof *b.boxes};
    accel->stats = (ec_accel_stats){.nodes = b.node_count, .leaves = b.node_count + 1, .references = b.triangle_count,
                                    .sah_cost = in->bvh_stats.sah_cost};
    return EC_OK;
}

ec_result ec_bvh8_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    ec_bvh8 b;
    EC_TRY(ec_accel_bvh(in, err));
    EC_TRY(ec_bvh8_layout(&in->bvh, in->positions, in->indices, &b, err));
    accel->buffers[0] = (ec_accel_buffer){"nodes", b.nodes, (uint64_t)b.node_count * sizeof *b.nodes};
    accel->buffers[1] = (ec_accel_buffer){"triangle blocks", b.blocks, (uint64_t)b.block_count * sizeof *b.blocks};
    if (b.boxes) accel->buffers[2] = (ec_accel_buffer){"boxes", b.boxes, (uint64_t)b.block_count * sizeof *b.boxes};
    accel->stats = (ec_accel_stats){.nodes = b.node_count, .leaves = b.block_count, .references = in->bvh.ref_count,
                                    .sah_cost = in->bvh_stats.sah_cost};
    return EC_OK;
}
