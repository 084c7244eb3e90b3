/* One range of triangles into two: bin, choose, deal. Long ranges go chunk by chunk on all cores; the chunks are the same
 * for any number of cores, and so is everything that comes out. */
#include <stdlib.h>

#include "accel/build_internal.h"

#define CHUNK 16384u
#define PARALLEL_MIN (4 * CHUNK)

typedef struct chunk {
    ec_bins bins;
    uint32_t left, right; /* where its triangles go */
    ec_box4 centroids[2];
} chunk;

static uint32_t chunk_count_of(uint32_t count) { return count < PARALLEL_MIN ? 1 : (count + CHUNK - 1) / CHUNK; }

static uint32_t chunk_length(const ec_range *range, uint32_t chunk_count, uint32_t index)
{
    return index + 1 < chunk_count ? CHUNK : range->count - index * CHUNK;
}

static ec_split bin(const ec_prim *prims, const ec_range *range, const ec_binning *binning, chunk *chunks,
                    uint32_t chunk_count)
{
    if (chunk_count == 1) {
        ec_bins_fill(&chunks[0].bins, binning, prims, range->count);
        return ec_bins_split(&chunks[0].bins, range);
    }
#pragma omp taskloop default(shared)
    for (uint32_t i = 0; i < chunk_count; i++)
        ec_bins_fill(&chunks[i].bins, binning, prims + i * CHUNK, chunk_length(range, chunk_count, i));
    ec_bins total = chunks[0].bins;
    for (uint32_t i = 1; i < chunk_count; i++) ec_bins_merge(&total, &chunks[i].bins);
    return ec_bins_split(&total, range);
}

static void deal(const ec_builder *builder, const ec_range *range, const ec_binning *binning, const ec_split *split,
                 chunk *chunks, uint32_t chunk_count, ec_range children[2])
{
    const ec_prim *from = builder->prims[range->buffer] + range->first;
    ec_prim *to = builder->prims[1 - range->buffer] + range->first;
    uint32_t left = 0, right = split->left_count;
    if (chunk_count == 1) {
        ec_box4 centroids[2];
        ec_prims_partition(from, range->count, binning, split, to, to + right, centroids);
        children[0].centroids = centroids[0];
        children[1].centroids = centroids[1];
        return;
    }
    for (uint32_t i = 0; i < chunk_count; i++) {
        uint32_t lefts = ec_bins_left(&chunks[i].bins, split);
        chunks[i].left = left;
        chunks[i].right = right;
        left += lefts;
        right += chunk_length(range, chunk_count, i) - lefts;
    }
#pragma omp taskloop default(shared)
    for (uint32_t i = 0; i < chunk_count; i++)
        ec_prims_partition(from + i * CHUNK, chunk_length(range, chunk_count, i), binning, split, to + chunks[i].left,
                           to + chunks[i].right, chunks[i].centroids);
    for (int side = 0; side < 2; side++) {
        children[side].centroids = ec_box4_empty();
        for (uint32_t i = 0; i < chunk_count; i++)
            ec_box4_grow(&children[side].centroids, chunks[i].centroids[side].lo, chunks[i].centroids[side].hi);
    }
}

static void place_children(const ec_range *range, uint32_t left_count, uint32_t buffer, ec_range children[2])
{
    children[0].first = range->first;
    children[0].count = left_count;
    children[1].first = range->first + left_count;
    children[1].count = range->count - left_count;
    for (int side = 0; side < 2; side++) {
        children[side].depth = range->depth + 1;
        children[side].buffer = buffer;
    }
}

/* Halves the range where it lies: for coincident triangles, for boxes without a finite area, and for trees that grow
 * too deep. */
static void split_in_the_middle(const ec_builder *builder, const ec_range *range, ec_range children[2])
{
    place_children(range, range->count / 2, range->buffer, children);
    for (int side = 0; side < 2; side++)
        ec_prims_bound(builder->prims[range->buffer] + children[side].first, children[side].count, &children[side]);
}

int ec_range_split(ec_builder *builder, const ec_range *range, ec_range children[2])
{
    uint32_t chunk_count = chunk_count_of(range->count);
    if (range->count <= 1) return 0;
    chunk one, *chunks = chunk_count == 1 ? &one : malloc(chunk_count * sizeof *chunks);
    if (!chunks) {
#pragma omp atomic write
        builder->failed = 1;
        return 0;
    }
    ec_binning binning = ec_binning_of(range);
    ec_split split = bin(builder->prims[range->buffer] + range->first, range, &binning, chunks, chunk_count);
    int fits = range->count <= EC_LEAF_MAX, inner = 1;
    uint32_t larger = split.left_count > range->count / 2 ? split.left_count : range->count - split.left_count;
    if (fits && !(split.cost + split.node_cost < split.leaf_cost)) {
        inner = 0;
    } else if (split.axis < 0 || !ec_depth_allows(range->depth + 1, larger)) {
        split_in_the_middle(builder, range, children);
    } else {
        deal(builder, range, &binning, &split, chunks, chunk_count, children);
        place_children(range, split.left_count, 1 - range->buffer, children);
        children[0].box = split.left;
        children[1].box = split.right;
    }
    if (chunks != &one) free(chunks);
    return inner;
}
