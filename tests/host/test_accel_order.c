/* tier: quick */
/* A node of eight children stores an order of them for each octant of directions: each child once, the farther ones first. */
#include <stdbool.h>

#include "accel/bvh.h"
#include "test_accel_meshes.h"

/* Position of a child's centre along the octant's diagonal. */
static double along(const ec_bvh8_node *node, uint32_t slot, uint32_t octant)
{
    double sum = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double centre = 0.5 * ((double)node->bound[2 * axis][slot] + node->bound[2 * axis + 1][slot]);
        sum += octant >> axis & 1 ? -centre : centre;
    }
    return sum;
}

static bool is_in_order(const ec_bvh8_node *node, uint32_t octant)
{
    uint32_t expected = 0, seen = 0;
    double last = INFINITY;
    for (uint32_t k = 0; k < 8; k++) {
        const uint32_t slot = node->order[octant] >> 3 * k & 7, bit = 1u << slot;
        expected |= (node->child[k] != EC_NO_CHILD) << k;
        if (node->child[slot] == EC_NO_CHILD) continue;
        const double here = along(node, slot, octant);
        if (seen & bit || here > last + 1e-5 * (1.0 + fabs(last))) return false;
        seen |= bit;
        last = here;
    }
    return seen == expected;
}

int main(void)
{
    for (size_t k = 0; k < MESH_KIND_COUNT; k++) {
        ec_error err;
        mesh m = mesh_make(&mesh_kinds[k]);
        ec_bvh bvh;
        ec_bvh8 layout;
        CHECK_OK(ec_bvh_build(m.positions, m.indices, m.triangle_count, 0, &bvh, NULL, &err), err);
        CHECK_OK(ec_bvh8_layout(&bvh, m.positions, m.indices, &layout, &err), err);
        uint32_t bad = 0;
        for (uint32_t i = 0; i < layout.node_count; i++)
            for (uint32_t octant = 0; octant < 8; octant++) bad += !is_in_order(&layout.nodes[i], octant);
        CHECK_MSG(!bad, "%s: %u orders of %u nodes", m.name, bad, layout.node_count);
        free(layout.nodes);
        free(layout.blocks);
        free(layout.boxes);
        ec_bvh_free(&bvh);
        mesh_free(&m);
    }
    TEST_END();
}
