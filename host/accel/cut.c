/* Spatial splits: a plane cuts triangles, each of which goes to both sides with the box of its part there. Stich, Friedrich and Dietrich 2009,
 * "Spatial splits in bounding volume hierarchies". Pays where long triangles cross many small ones, and most in the upper tree. */
#include <float.h>
#include <stdlib.h>

#include "accel/build_internal.h"

/* Tried where the boxes of the best split of whole triangles share more than this of the scene's area (Stich et al.'s
 * alpha), and where a triangle is longer than this share of the node: a fine mesh is not worth the time. */
#define OVERLAP 1e-4f
#define LONG 0.5f

typedef struct chunk {
    ec_bins bins;
    ec_i4 ends[EC_BINS];
    uint32_t left, right; /* counts, then the places where its parts go */
    ec_range sides[2];    /* their bounds alone */
} chunk;

typedef struct plane {
    int axis;
    float at;
    ec_v4 scale;
    ec_box4 box[2]; /* of the sides, from the bins */
    float area[2], count[2];
} plane;

static ec_box4 box_of(const ec_build_prim *prim) { return (ec_box4){ec_prim_lo(prim), prim->hi}; }

static int is_empty(const ec_box4 *box)
{
    return !(box->lo[0] <= box->hi[0] && box->lo[1] <= box->hi[1] && box->lo[2] <= box->hi[2]);
}

void ec_triangle_cut(const ec_v4 vertices[3], const ec_box4 *box, int axis, float at, ec_box4 part[2])
{
    part[0] = part[1] = ec_box4_empty();
    for (int k = 0; k < 3; k++) {
        ec_v4 a = vertices[k] + ec_v4_all(0.0f), b = vertices[(k + 1) % 3]; /* no -0, see prim.c */
        if (a[axis] <= at) ec_box4_grow(&part[0], a, a);
        if (a[axis] >= at) ec_box4_grow(&part[1], a, a);
        if (!(a[axis] < at ? b[axis] > at : a[axis] > at && b[axis] < at)) continue;
        ec_v4 c = a + (b - a) * ec_v4_all((at - a[axis]) / (b[axis] - a[axis]));
        /* Six roundings, each at most half an ulp of |a| + |b|. */
        ec_v4 margin = (ec_v4_abs(a) + ec_v4_abs(b)) * ec_v4_all(4.0f * FLT_EPSILON) + ec_v4_all(FLT_MIN);
        for (int side = 0; side < 2; side++) ec_box4_grow(&part[side], c - margin, c + margin);
    }
    if (part[0].hi[axis] > at) part[0].hi[axis] = at;
    if (part[1].lo[axis] < at) part[1].lo[axis] = at;
    for (int side = 0; side < 2; side++) {
        part[side].lo = ec_v4_max(part[side].lo, box->lo);
        part[side].hi = ec_v4_min(part[side].hi, box->hi);
    }
}

/* Puts a triangle's parts into the bins in which they lie. */
static void fill_parts(chunk *c, const ec_binning *binning, const ec_v4 vertices[3], ec_box4 rest, int axis, int first,
                       int last)
{
    for (int i = first; i < last; i++) {
        ec_box4 part[2];
        ec_triangle_cut(vertices, &rest, axis, binning->origin[axis] + (float)(i + 1) / binning->scale[axis], part);
        ec_box4_grow(&c->bins.box[i][axis], part[0].lo, part[0].hi);
        rest = part[1];
    }
    ec_box4_grow(&c->bins.box[last][axis], rest.lo, rest.hi);
}

static void fill_bins(const ec_builder *builder, const ec_binning *binning, const ec_build_prim *prims, uint32_t count, chunk *c)
{
    for (int i = 0; i < EC_BINS; i++) {
        c->bins.box[i][0] = c->bins.box[i][1] = c->bins.box[i][2] = ec_box4_empty();
        c->bins.count[i] = c->ends[i] = ec_i4_all(0);
    }
    for (uint32_t i = 0; i < count; i++) {
        ec_box4 box = box_of(&prims[i]);
        ec_i4 first = ec_bin_of(binning, box.lo), last = ec_bin_of(binning, box.hi);
        ec_v4 vertices[3];
        int is_long = first[0] != last[0] || first[1] != last[1] || first[2] != last[2];
        if (is_long) ec_prim_vertices(builder->positions, builder->indices, ec_prim_id(&prims[i]), vertices);
        for (int axis = 0; axis < 3; axis++) {
            c->bins.count[first[axis]][axis]++;
            c->ends[last[axis]][axis]++;
            if (first[axis] == last[axis]) ec_box4_grow(&c->bins.box[first[axis]][axis], box.lo, box.hi);
            else fill_parts(c, binning, vertices, box, axis, first[axis], last[axis]);
        }
    }
}

static ec_split best_cut(const ec_builder *builder, const ec_range *range, const ec_binning *binning, chunk *chunks)
{
    const ec_build_prim *prims = builder->prims[range->buffer] + range->first;
    uint32_t chunk_count = ec_chunk_count(range);
#pragma omp taskloop default(shared) if (chunk_count > 1)
    for (uint32_t i = 0; i < chunk_count; i++)
        fill_bins(builder, binning, prims + i * EC_CHUNK, ec_chunk_length(range, i), &chunks[i]);
    chunk total = chunks[0];
    for (uint32_t i = 1; i < chunk_count; i++) {
        ec_bins_merge(&total.bins, &chunks[i].bins);
        for (int k = 0; k < EC_BINS; k++) total.ends[k] += chunks[i].ends[k];
    }
    ec_split split = ec_bins_split(&total.bins, total.ends, range);
    if (split.axis >= 0) {
        uint32_t right = 0;
        for (int k = split.bin; k < EC_BINS; k++) right += (uint32_t)total.ends[k][split.axis];
        split.right_count = right;
    }
    return split;
}

static plane plane_of(const ec_range *range, const ec_binning *binning, const ec_split *split)
{
    plane p = {.axis = split->axis, .scale = ec_box4_scale(&range->box), .box = {split->left, split->right}};
    p.at = binning->origin[p.axis] + (float)split->bin / binning->scale[p.axis];
    ec_box4 three[3] = {split->left, split->right, split->right};
    ec_v4 areas = ec_half_areas(three, p.scale);
    for (int side = 0; side < 2; side++) p.area[side] = areas[side];
    p.count[0] = (float)split->left_count;
    p.count[1] = (float)split->right_count;
    return p;
}

/* Returns to which sides a triangle goes: 1 the left one, 2 the right one, 3 both, in parts. It stays whole where that costs less (Stich et al.,
 * section 4.4). */
static int sides_of(const ec_builder *builder, const plane *p, const ec_build_prim *prim, ec_box4 part[2])
{
    ec_box4 box = box_of(prim);
    if (box.hi[p->axis] <= p->at) return 1;
    if (!(box.lo[p->axis] < p->at)) return 2;
    ec_v4 vertices[3];
    ec_prim_vertices(builder->positions, builder->indices, ec_prim_id(prim), vertices);
    ec_triangle_cut(vertices, &box, p->axis, p->at, part);
    if (is_empty(&part[0])) return 2;
    if (is_empty(&part[1])) return 1;
    ec_box4 whole[3] = {p->box[0], p->box[1], p->box[1]};
    for (int side = 0; side < 2; side++) ec_box4_grow(&whole[side], box.lo, box.hi);
    ec_v4 area = ec_half_areas(whole, p->scale);
    float both = p->area[0] * p->count[0] + p->area[1] * p->count[1];
    float left = area[0] * p->count[0] + p->area[1] * (p->count[1] - 1.0f);
    float right = p->area[0] * (p->count[0] - 1.0f) + area[1] * p->count[1];
    return both <= left && both <= right ? 3 : left <= right ? 1 : 2;
}

static void count_sides(const ec_builder *builder, const plane *p, const ec_build_prim *prims, uint32_t count, chunk *c)
{
    ec_box4 part[2];
    c->left = c->right = 0;
    for (uint32_t i = 0; i < count; i++) {
        int sides = sides_of(builder, p, &prims[i], part);
        c->left += sides & 1;
        c->right += sides >> 1;
    }
}

static void deal(const ec_builder *builder, const plane *p, const ec_build_prim *prims, uint32_t count, ec_build_prim *left,
                 ec_build_prim *right, chunk *c)
{
    ec_build_prim *to[2] = {left, right};
    for (uint32_t i = 0; i < count; i++) {
        ec_box4 part[2];
        int sides = sides_of(builder, p, &prims[i], part);
        for (int side = 0; side < 2; side++) {
            if (!(sides & 1 << side)) continue;
            *to[side] = sides == 3 ? ec_prim_of(&part[side], ec_prim_id(&prims[i])) : prims[i];
            to[side]++;
        }
    }
    ec_prims_bound(left, (uint32_t)(to[0] - left), &c->sides[0]);
    ec_prims_bound(right, (uint32_t)(to[1] - right), &c->sides[1]);
}

static int deal_all(const ec_builder *builder, const ec_range *range, const plane *p, chunk *chunks, ec_range children[2])
{
    const ec_build_prim *from = builder->prims[range->buffer] + range->first;
    ec_build_prim *to = builder->prims[1 - range->buffer];
    uint32_t chunk_count = ec_chunk_count(range);
#pragma omp taskloop default(shared) if (chunk_count > 1)
    for (uint32_t i = 0; i < chunk_count; i++)
        count_sides(builder, p, from + i * EC_CHUNK, ec_chunk_length(range, i), &chunks[i]);
    uint64_t left = 0, right = 0;
    for (uint32_t i = 0; i < chunk_count; i++) {
        uint32_t lefts = chunks[i].left, rights = chunks[i].right;
        chunks[i].left = (uint32_t)left;
        chunks[i].right = (uint32_t)right;
        left += lefts;
        right += rights;
    }
    if (!left || !right || left + right > range->capacity) return 0;
    if (!ec_depth_allows(range->depth + 1, (uint32_t)(left > right ? left : right))) return 0;
    uint64_t slack = range->capacity - (left + right);
    ec_range_place(range, (uint32_t)left, (uint32_t)right, (uint32_t)(slack * left / (left + right)), 1 - range->buffer,
                   children);
#pragma omp taskloop default(shared) if (chunk_count > 1)
    for (uint32_t i = 0; i < chunk_count; i++)
        deal(builder, p, from + i * EC_CHUNK, ec_chunk_length(range, i), to + children[0].first + chunks[i].left,
             to + children[1].first + chunks[i].right, &chunks[i]);
    for (int side = 0; side < 2; side++)
        for (uint32_t i = 0; i < chunk_count; i++) ec_range_join(&children[side], &chunks[i].sides[side]);
    return 1;
}

static int is_worth_a_try(const ec_builder *builder, const ec_range *range, const ec_split *objects)
{
    if (range->capacity == range->count) return 0;
    ec_v4 extent = range->box.hi - range->box.lo;
    int has_long = 0;
    for (int axis = 0; axis < 3; axis++) has_long |= range->longest[axis] > LONG * extent[axis];
    ec_box4 shared = {ec_v4_max(objects->left.lo, objects->right.lo), ec_v4_min(objects->left.hi, objects->right.hi)};
    if (!has_long || is_empty(&shared)) return 0;
    ec_box4 boxes[3] = {shared, builder->scene, builder->scene};
    ec_v4 areas = ec_half_areas(boxes, ec_box4_scale(&builder->scene));
    return areas[0] > OVERLAP * areas[1]; /* never if areas are not numbers */
}

int ec_range_cut(ec_builder *builder, const ec_range *range, const ec_split *objects, ec_range children[2])
{
    if (!is_worth_a_try(builder, range, objects)) return 0;
    chunk *chunks = malloc(ec_chunk_count(range) * sizeof *chunks);
    if (!chunks) return 0;
    ec_range boxes = *range; /* bins over the boxes' extent, not over that of their centres */
    boxes.centroids = range->box;
    ec_binning binning = ec_binning_of(&boxes);
    ec_split split = best_cut(builder, range, &binning, chunks);
    int done = 0;
    if (split.axis >= 0 && split.cost < objects->cost) {
        plane p = plane_of(range, &binning, &split);
        done = deal_all(builder, range, &p, chunks, children);
    }
    free(chunks);
    return done;
}
