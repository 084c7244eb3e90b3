/* The contents of leaves as the kernels read them: triangles, blocks of eight, their boxes. Private to host/accel. */
#ifndef EC_ACCEL_LEAF_H
#define EC_ACCEL_LEAF_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "shared/accel.h"

#define EC_NO_BOX ((ec_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}})

static inline void ec_box_grow(ec_box *box, const float lo[3], const float hi[3])
{
    for (int k = 0; k < 3; k++) {
        box->lo[k] = fminf(box->lo[k], lo[k]);
        box->hi[k] = fmaxf(box->hi[k], hi[k]);
    }
}

/* Returns half the surface of a box; 0 if it is empty. */
static inline double ec_box_half_area(const float lo[3], const float hi[3])
{
    const double x = (double)hi[0] - lo[0], y = (double)hi[1] - lo[1], z = (double)hi[2] - lo[2];
    return x >= 0 ? x * y + (x + y) * z : 0;
}

/* Returns a triangle's corner. positions: 3 floats a vertex; indices: 3 a triangle. */
static inline const float *ec_corner(const float *positions, const uint32_t *indices, uint32_t triangle, size_t corner)
{
    return positions + 3 * (size_t)indices[3 * (size_t)triangle + corner];
}

static inline ec_box ec_triangle_box(const float *positions, const uint32_t *indices, uint32_t triangle)
{
    ec_box box = EC_NO_BOX;
    for (size_t corner = 0; corner < 3; corner++) {
        const float *v = ec_corner(positions, indices, triangle, corner);
        ec_box_grow(&box, v, v);
    }
    return box;
}

/* For the binary layout, whose leaves test triangles one by one. */
static inline ec_tri ec_tri_of(const float *positions, const uint32_t *indices, uint32_t triangle)
{
    ec_tri tri = {.id = triangle};
    memcpy(tri.v0, ec_corner(positions, indices, triangle, 0), sizeof tri.v0);
    memcpy(tri.v1, ec_corner(positions, indices, triangle, 1), sizeof tri.v1);
    memcpy(tri.v2, ec_corner(positions, indices, triangle, 2), sizeof tri.v2);
    return tri;
}

/* Empties a block of eight; puts a triangle and its box into one of its slots. boxes may be NULL. */
static inline void ec_block_clear(ec_tri8 *block, ec_box8 *boxes)
{
    memset(block, 0, sizeof *block);
    if (boxes) memset(boxes, 0, sizeof *boxes);
    for (uint32_t slot = 0; slot < 8; slot++) block->id[slot] = EC_NO_ID;
}

static inline void ec_block_put(const float *positions, const uint32_t *indices, uint32_t triangle, const float lo[3], const float hi[3],
                                uint32_t slot, ec_tri8 *block, ec_box8 *boxes)
{
    block->id[slot] = triangle;
    for (size_t corner = 0; corner < 3; corner++) {
        const float *v = ec_corner(positions, indices, triangle, corner);
        for (int axis = 0; axis < 3; axis++) block->v[corner][axis][slot] = v[axis];
    }
    for (int axis = 0; boxes && axis < 3; axis++) boxes->lo[axis][slot] = lo[axis], boxes->hi[axis][slot] = hi[axis];
}

#endif
