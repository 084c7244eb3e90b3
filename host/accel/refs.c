/* The references that grids and kd-trees sort into cells. */
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel_internal.h"

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
            v[corner] = tame(in->positions[3 * (size_t)in->indices[3 * (size_t)triangle + corner] + axis]);
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

ec_result ec_accel_refs(const ec_accel_input *in, ec_ref **refs, uint32_t *count, ec_ref *bounds, ec_error *err)
{
    uint32_t n = in->triangle_count;
    ec_ref *r = malloc((n + (size_t)1) * sizeof *r);
    if (!r) return ec_fail(err, "out of memory for the boxes of %u triangles", n);
    memset(bounds, 0, sizeof *bounds);
    if (n) *bounds = ref_of(in, 0);
#pragma omp parallel num_threads(ec_accel_threads(in, n))
    {
        ec_ref mine = *bounds;
#pragma omp barrier
#pragma omp for
        for (uint32_t i = 0; i < n; i++) {
            r[i] = ref_of(in, i);
            grow(&mine, &r[i]);
        }
#pragma omp critical(ec_accel_refs)
        grow(bounds, &mine);
    }
    *refs = r;
    *count = n;
    return EC_OK;
}
