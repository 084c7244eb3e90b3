/* The references that grids and kd-trees sort into cells. */
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel_internal.h"
#include "accel/leaf.h"

#define TEAM_MIN 4096u /* fewer are done sooner than a second thread wakes */

int ec_accel_threads(const ec_accel_input *in, uint32_t count)
{
    return count < TEAM_MIN ? 1 : in->threads ? (int)in->threads : omp_get_max_threads();
}

/* Not a number counts as 0; infinity as the largest number. */
static float tame(float x)
{
    return !(x == x) ? 0.0f : fminf(fmaxf(x, -3e38f), 3e38f) + 0.0f;
}

static ec_ref ref_of(const ec_accel_input *in, uint32_t triangle)
{
    ec_ref ref = {.triangle = triangle};
    for (int axis = 0; axis < 3; axis++) {
        float v[3];
        for (int corner = 0; corner < 3; corner++)
            v[corner] = tame(ec_corner(in->positions, in->indices, triangle, (size_t)corner)[axis]);
        ref.lo[axis] = fminf(v[0], fminf(v[1], v[2]));
        ref.hi[axis] = fmaxf(v[0], fmaxf(v[1], v[2]));
    }
    return ref;
}

static void grow(ec_ref *box, const ec_ref *by)
{
    for (int axis = 0; axis < 3; axis++) {
        if (by->lo[axis] < box->lo[axis]) box->lo[axis] = by->lo[axis];
        if (by->hi[axis] > box->hi[axis]) box->hi[axis] = by->hi[axis];
    }
}

/* The parts that the BVH has cut triangles into: all structures must hold the same ones to give the same hits. */
static ec_ref part_of(const ec_bvh *bvh, uint32_t i)
{
    ec_ref ref = {.triangle = bvh->order[i]};
    memcpy(ref.lo, bvh->boxes[i].lo, sizeof ref.lo);
    memcpy(ref.hi, bvh->boxes[i].hi, sizeof ref.hi);
    return ref;
}

ec_result ec_accel_refs(ec_accel_input *in, ec_ref **refs, uint32_t *count, ec_ref *bounds, ec_error *err)
{
    EC_TRY(ec_accel_bvh(in, err));
    const ec_bvh *bvh = in->bvh.boxes ? &in->bvh : NULL;
    uint32_t n = bvh ? bvh->ref_count : in->triangle_count;
    ec_ref *r = malloc((n + (size_t)1) * sizeof *r);
    if (!r) return ec_fail(err, "out of memory for the boxes of %u triangles", n);
    memset(bounds, 0, sizeof *bounds);
    if (n) *bounds = bvh ? part_of(bvh, 0) : ref_of(in, 0);
#pragma omp parallel num_threads(ec_accel_threads(in, n))
    {
        ec_ref mine = *bounds;
#pragma omp barrier
#pragma omp for
        for (uint32_t i = 0; i < n; i++) {
            r[i] = bvh ? part_of(bvh, i) : ref_of(in, i);
            grow(&mine, &r[i]);
        }
#pragma omp critical(ec_accel_refs)
        grow(bounds, &mine);
    }
    *refs = r;
    *count = n;
    return EC_OK;
}

void ec_accel_block(const ec_accel_input *in, const ec_ref *refs, const uint32_t *which, uint32_t count, ec_tri8 *block,
                    ec_box8 *boxes)
{
    ec_block_clear(block, boxes);
    for (uint32_t slot = 0; slot < count; slot++) {
        const ec_ref *ref = &refs[which[slot]];
        ec_block_put(in->positions, in->indices, ref->triangle, ref->lo, ref->hi, slot, block, boxes);
    }
}
