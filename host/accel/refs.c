/* Makes the references that grids and kd-trees sort into cells. */
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel_internal.h"
#include "accel/leaf.h"

#define TEAM_MIN 4096u /* with fewer triangles the work is done before a second thread wakes */

int ec_accel_threads(const ec_accel_input *in, uint32_t count)
{
    return count < TEAM_MIN ? 1 : in->threads ? (int)in->threads : omp_get_max_threads();
}

/* Turns NaN into 0, and infinity into the largest number. */
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
        ref.box.lo[axis] = fminf(v[0], fminf(v[1], v[2]));
        ref.box.hi[axis] = fmaxf(v[0], fmaxf(v[1], v[2]));
    }
    return ref;
}

/* Returns one of the parts that the BVH has cut triangles into: all structures must hold the same ones to give the same hits. */
static ec_ref part_of(const ec_bvh *bvh, uint32_t i) { return (ec_ref){bvh->boxes[i], bvh->order[i]}; }

ec_result ec_accel_refs(ec_accel_input *in, ec_ref **refs, uint32_t *count, ec_box *bounds, ec_error *err)
{
    EC_TRY(ec_accel_bvh(in, err));
    const ec_bvh *bvh = in->bvh.boxes ? &in->bvh : NULL;
    uint32_t n = bvh ? bvh->ref_count : in->triangle_count;
    ec_ref *r = malloc((n + (size_t)1) * sizeof *r);
    if (!r) return ec_fail(err, "out of memory for the boxes of %u triangles", n);
    memset(bounds, 0, sizeof *bounds);
    if (n) *bounds = bvh ? part_of(bvh, 0).box : ref_of(in, 0).box;
#pragma omp parallel num_threads(ec_accel_threads(in, n))
    {
        ec_box mine = *bounds;
#pragma omp barrier
#pragma omp for
        for (uint32_t i = 0; i < n; i++) {
            r[i] = bvh ? part_of(bvh, i) : ref_of(in, i);
            ec_box_grow(&mine, r[i].box.lo, r[i].box.hi);
        }
#pragma omp critical(ec_accel_refs)
        ec_box_grow(bounds, mine.lo, mine.hi);
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
        ec_block_put(in->positions, in->indices, ref->triangle, ref->box.lo, ref->box.hi, slot, block, boxes);
    }
}
