/* For the builders behind accel.h. Private to host/accel. */
#ifndef EC_ACCEL_ACCEL_INTERNAL_H
#define EC_ACCEL_ACCEL_INTERNAL_H

#include "accel/accel.h"

#define EC_ACCEL_DECLARE(name, lanes, summary)                                                     \
    ec_result ec_##name##_accel(ec_accel_input *input, ec_accel *accel, ec_error *err);
EC_ACCELS(EC_ACCEL_DECLARE)

/* An entry of a grid or kd-tree: a triangle, or a part of one, in a box of its own. A hit's t is clamped to the near side of
 * this very box (kernels/lib/ray.h), so whoever puts a reference into every cell that the box overlaps, and leaves no cell
 * out that the ray enters before t, cannot lose a hit. Cutting triangles to their cells would be tighter, but a triangle seen
 * edge-on has a t of any error, and would be missed where its box has no part. */
typedef struct ec_ref {
    ec_box box;         /* no -0, no NaN */
    uint32_t triangle;
} ec_ref;
/* Makes the references, malloc'ed and the caller's. bounds: of all of them; 0 if there are none. */
ec_result ec_accel_refs(ec_accel_input *input, ec_ref **refs, uint32_t *count, ec_box *bounds, ec_error *err);

/* Returns how many threads a builder may use. */
int ec_accel_threads(const ec_accel_input *input, uint32_t count);

/* Builds the binary tree if it has not been built yet. */
ec_result ec_accel_bvh(ec_accel_input *input, ec_error *err);

/* Writes references which[0 .. count), at most 8, into a block, and their boxes if `boxes` is not NULL. */
void ec_accel_block(const ec_accel_input *input, const ec_ref *refs, const uint32_t *which, uint32_t count, ec_tri8 *block,
                    ec_box8 *boxes);

#endif
