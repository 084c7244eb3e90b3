/* The two BVHs behind the common interface: layouts of one and the same tree. */
#include "accel/accel_internal.h"

ec_result ec_accel_bvh(ec_accel_input *in, ec_error *err)
{
    if (in->bvh.nodes) return EC_OK;
    if (in->swept_count)
        return ec_bvh_build_swept(in->positions, in->indices, in->triangle_count, in->swept, in->swept_count,
                                  in->threads, &in->bvh, &in->bvh_stats, err);
    if (in->whole)
        return ec_bvh_build_whole(in->positions, in->indices, in->triangle_count, in->threads, &in->bvh, &in->bvh_stats,
                                  err);
    return ec_bvh_build(in->positions, in->indices, in->triangle_count, in->threads, &in->bvh, &in->bvh_stats, err);
}

ec_result ec_bvh2_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    ec_bvh2_node *nodes;
    ec_tri *triangles;
    ec_box *boxes;
    uint32_t node_count, triangle_count;
    EC_TRY(ec_accel_bvh(in, err));
    EC_TRY(ec_bvh2_layout(&in->bvh, in->positions, in->indices, &nodes, &node_count, &triangles, &boxes, &triangle_count, err));
    accel->buffers[0] = (ec_accel_buffer){"nodes", nodes, (uint64_t)node_count * sizeof *nodes};
    accel->buffers[1] = (ec_accel_buffer){"triangles", triangles, (uint64_t)triangle_count * sizeof *triangles};
    if (boxes) accel->buffers[2] = (ec_accel_buffer){"boxes", boxes, (uint64_t)triangle_count * sizeof *boxes};
    accel->stats = (ec_accel_stats){.nodes = node_count, .leaves = node_count + 1, .references = triangle_count,
                                    .sah_cost = in->bvh_stats.sah_cost};
    return EC_OK;
}

ec_result ec_bvh8_accel(ec_accel_input *in, ec_accel *accel, ec_error *err)
{
    ec_bvh8_node *nodes;
    ec_tri8 *blocks;
    ec_box8 *boxes;
    uint32_t node_count, block_count;
    EC_TRY(ec_accel_bvh(in, err));
    EC_TRY(ec_bvh8_layout(&in->bvh, in->positions, in->indices, &nodes, &node_count, &blocks, &boxes, &block_count, err));
    accel->buffers[0] = (ec_accel_buffer){"nodes", nodes, (uint64_t)node_count * sizeof *nodes};
    accel->buffers[1] = (ec_accel_buffer){"triangle blocks", blocks, (uint64_t)block_count * sizeof *blocks};
    if (boxes) accel->buffers[2] = (ec_accel_buffer){"boxes", boxes, (uint64_t)block_count * sizeof *boxes};
    accel->stats = (ec_accel_stats){.nodes = node_count, .leaves = block_count, .references = in->bvh.ref_count,
                                    .sah_cost = in->bvh_stats.sah_cost};
    return EC_OK;
}
