/* Splits a range of triangles in two: bins, chooses, deals. */
#include <stdlib.h>

#include "accel/build_internal.h"

typedef struct chunk {
    ec_bins bins;
    uint32_t left, right; /* places where its triangles go */
    ec_range sides[2];
} chunk;

static ec_split bin(const ec_build_prim *prims, const ec_range *range, const ec_binning *binning, chunk *chunks,
                    uint32_t chunk_count)
{
    if (chunk_count == 1) {
        ec_bins_fill(&chunks[0].bins, binning, prims, range->count);
        return ec_bins_split(&chunks[0].bins, chunks[0].bins.count, range);
    }
#pragma omp taskloop default(shared)
    for (uint32_t i = 0; i < chunk_count; i++)
        ec_bins_fill(&chunks[i].bins, binning, prims + i * EC_CHUNK, ec_chunk_length(range, i));
    ec_bins total = chunks[0].bins;
    for (uint32_t i = 1; i < chunk_count; i++) ec_bins_merge(&total, &chunks[i].bins);
    return ec_bins_split(&total, total.count, range);
}

static void deal(const ec_builder *builder, const ec_range *range, const ec_binning *binning, const ec_split *split,
                 chunk *chunks, uint32_t chunk_count, ec_range children[2])
{
    const ec_build_prim *from = builder->prims[range->buffer] + range->first;
    ec_build_prim *to = builder->prims[1 - range->buffer] + range->first;
    uint32_t left = 0, right = children[1].first - range->first;
    if (chunk_count == 1) {
        ec_range sides[2];
        ec_prims_partition(from, range->count, binning, split, to, to + right, sides);
        for (int side = 0; side < 2; side++) ec_range_join(&children[side], &sides[side]);
        return;
    }
    for (uint32_t i = 0; i < chunk_count; i++) {
        uint32_t lefts = ec_bins_left(&chunks[i].bins, split);
        chunks[i].left = left;
        chunks[i].right = right;
        left += lefts;
        right += ec_chunk_length(range, i) - lefts;
    }
#pragma omp taskloop default(shared)
    for (uint32_t i = 0; i < chunk_count; i++)
        ec_prims_partition(from + i * EC_CHUNK, ec_chunk_length(range, i), binning, split, to + chunks[i].left,
                           to + chunks[i].right, chunks[i].sides);
    for (int side = 0; side < 2; side++)
        for (uint32_t i = 0; i < chunk_count; i++) ec_range_join(&children[side], &chunks[i].sides[side]);
}

/* Halves the range where it lies: for coincident triangles, for boxes without a finite area, and for trees that grow
 * too deep. */
static void split_in_the_middle(const ec_builder *builder, const ec_range *range, ec_range children[2])
{
    uint32_t left = range->count / 2;
    ec_range_place(range, left, range->count - left, 0, range->buffer, children);
    for (int side = 0; side < 2; side++)
        ec_prims_bound(builder->prims[range->buffer] + children[side].first, children[side].count, &children[side]);
}

int ec_range_split(ec_builder *builder, const ec_range *range, ec_range children[2])
{
    uint32_t chunk_count = ec_chunk_count(range);
    if (range->count <= 1) return 0;
    chunk one, *chunks = chunk_count == 1 ? &one : malloc(chunk_count * sizeof *chunks);
    if (!chunks) {
#pragma omp atomic write
        builder->failed = 1;
        return 0;
    }
    ec_binning binning = ec_binning_of(range);
    ec_split split = bin(builder->prims[range->buffer] + range->first, range, &binning, chunks, chunk_count);
    int fits = range->count <= builder->leaf_most, inner = 1;
    uint32_t larger = split.left_count > range->count / 2 ? split.left_count : range->count - split.left_count;
    if (fits && !(split.cost + split.node_cost < split.leaf_cost)) {
        inner = 0;
    } else if (split.axis < 0 || !ec_depth_allows(range->depth + 1, larger)) {
        split_in_the_middle(builder, range, children);
    } else if (!ec_range_cut(builder, range, &split, children)) {
        uint64_t slack = range->capacity - range->count;
        ec_range_place(range, split.left_count, range->count - split.left_count,
                       (uint32_t)(slack * split.left_count / range->count), 1 - range->buffer, children);
        deal(builder, range, &binning, &split, chunks, chunk_count, children);
        children[0].box = split.left;
        children[1].box = split.right;
    }
    if (chunks != &one) free(chunks);
    return inner;
}
