#include "accel/leaf.h"

#include <string.h>

ec_tri ec_tri_of(const float *positions, const uint32_t *indices, uint32_t triangle)
{
    ec_tri tri = {.id = triangle};
    memcpy(tri.v0, ec_corner(positions, indices, triangle, 0), sizeof tri.v0);
    memcpy(tri.v1, ec_corner(positions, indices, triangle, 1), sizeof tri.v1);
    memcpy(tri.v2, ec_corner(positions, indices, triangle, 2), sizeof tri.v2);
    return tri;
}

void ec_block_clear(ec_tri8 *block, ec_box8 *boxes)
{
    memset(block, 0, sizeof *block);
    if (boxes) memset(boxes, 0, sizeof *boxes);
    for (uint32_t slot = 0; slot < 8; slot++) block->id[slot] = EC_NO_ID;
}

void ec_block_put(const float *positions, const uint32_t *indices, uint32_t triangle, const float lo[3], const float hi[3], uint32_t slot, ec_tri8 *block,
                  ec_box8 *boxes)
{
    block->id[slot] = triangle;
    for (size_t corner = 0; corner < 3; corner++) {
        const float *v = ec_corner(positions, indices, triangle, corner);
        for (int axis = 0; axis < 3; axis++) block->v[corner][axis][slot] = v[axis];
    }
    for (int axis = 0; boxes && axis < 3; axis++) boxes->lo[axis][slot] = lo[axis], boxes->hi[axis][slot] = hi[axis];
}
