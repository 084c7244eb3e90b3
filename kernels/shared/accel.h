/* Acceleration structures as the kernels read them. */
#ifndef EC_SHARED_ACCEL_H
#define EC_SHARED_ACCEL_H

#include "types.h"

#define EC_ACCEL_BUFFERS 5      /* buffers that an accelerator may have on the device */

#define EC_BVH_STACK 96         /* entries of a binary traversal stack; the builder keeps trees no deeper than 64 */
#define EC_BVH8_STACK 96        /* the same for eight children; layout8.c keeps every path within it */
#define EC_LEAF_BIT 0x80000000u
#define EC_NO_CHILD 0xffffffffu

/* Binary node with both children's boxes. child: inner = node index; leaf = EC_LEAF_BIT | first << 4 | count, where
 * count <= 8 triangles start at ec_tri[first]. A tree that is one leaf has a root whose child[0] is it, and child[1] is
 * EC_NO_CHILD with an empty box (lo = +inf, hi = -inf). */
typedef struct ec_bvh2_node {
    ec_float lo[2][3];   /* scene units, recentred frame */
    ec_float hi[2][3];
    ec_uint child[2];
    ec_uint pad[2];
} ec_bvh2_node;
EC_ASSERT_SIZE(ec_bvh2_node, 64);

/* One triangle in leaf order for the binary layout. Where the next one in the leaf is (v0, v2, s), the two form a quad and
 * are tested together: four vertices and five edges instead of six and six. */
typedef struct ec_tri {
    ec_float v0[3];
    ec_uint id;          /* index in the scene: breaks ties, names the triangle in hits */
    ec_float v1[3];
    ec_uint has_pair;    /* 1: forms a quad with the next one */
    ec_float v2[3];
    ec_uint pad1;
} ec_tri;
EC_ASSERT_SIZE(ec_tri, 48);

/* Eight children in structure-of-arrays form. bound[0..5] = lo.x, hi.x, lo.y, hi.y, lo.z, hi.z. child: inner = node
 * index; leaf = EC_LEAF_BIT | index of one ec_tri8 block; unused = EC_NO_CHILD with an empty box. A leaf child holds
 * exactly one block. order: by octant of the ray's direction (bit k: its component k is negative) the slots from the farthest child to
 * the nearest, an octal digit each, from the last digit on. */
typedef struct ec_bvh8_node {
    ec_float bound[6][8];
    ec_uint child[8];
    ec_uint order[8];
} ec_bvh8_node;
EC_ASSERT_SIZE(ec_bvh8_node, 256);

/* Up to eight triangles. v[k][axis][slot]; unused slots have id EC_NO_ID and all vertices 0. */
typedef struct ec_tri8 {
    ec_float v[3][3][8];
    ec_uint id[8];
} ec_tri8;
EC_ASSERT_SIZE(ec_tri8, 320);

/* Two levels: nodes[0] is the root of the triangles that belong to no instance. Leaves of the upper tree are instances: EC_LEAF_BIT | EC_INSTANCE_BIT
 * | index of an ec_instance, whose mesh has a tree and blocks in its own space, with ids that count from 0. The first ec_instance is not an instance:
 * its root is that of the upper tree. */
#define EC_INSTANCE_BIT 0x40000000u
#define EC_TWOLEVEL_STACK (2 * EC_BVH8_STACK)
typedef struct ec_instance {
    ec_float place[3][4];   /* rows: world = place x (point, 1) */
    ec_float inverse[3][4]; /* rows of the 3 x 3 inverse; the fourth is how far a ray transformed by it may be off, over its reach */
    ec_uint id;             /* of the mesh's first triangle here */
    ec_uint root;
    ec_uint turned;         /* 1: corners 1 and 2 change places */
    ec_float longest;       /* longest edge of a triangle's box in the world */
    ec_float reach;         /* no coordinate of the scene is larger */
    ec_uint pad[3];
} ec_instance;
EC_ASSERT_SIZE(ec_instance, 128);

/* Uniform grid, in blocks of 4 x 4 x 4 cells. Behind the header stand the planes between the cells, 4 blocks[0] + 1 along x, then
 * y, then z, ascending: the host says where a cell ends and the kernels only compare. Block (x, y, z) is x + blocks[0] *
 * (y + blocks[1] * z); bit x + 4 y + 16 z of occupied stands for a cell of it. The n-th cell of the block that is occupied
 * has the entries from starts[first + n] to starts[first + n + 1]; an entry is the index of an ec_tri. */
typedef struct ec_grid {
    ec_uint blocks[3];    /* along each axis */
    ec_uint start_count;  /* starts; the entries stand behind them */
    ec_float per_unit[3]; /* blocks a scene unit, for first guesses only */
    ec_uint pad1;
} ec_grid;
EC_ASSERT_SIZE(ec_grid, 32);
typedef struct ec_grid_block {
    ec_uint occupied[2];  /* low and high half */
    ec_uint first;
    ec_uint pad;
} ec_grid_block;
EC_ASSERT_SIZE(ec_grid_block, 16);

/* Kd-tree, three levels of splits a node, in a cache line. Planes in the order of a heap: 0 divides all eight children, 1 and 2 the first and the
 * last four, 3 to 6 the pairs; bit 2 of a child's number says on which side of plane 0 it lies (1: above), bits 1 and 0 on which side of the
 * planes below that. axes: two bits a plane, x first; EC_KD_NO_PLANE divides nothing. child: EC_NO_CHILD; a node; or a leaf, EC_LEAF_BIT | first
 * block << 6 | count. A triangle is in every leaf that its box overlaps. */
typedef struct ec_kd_node {
    ec_float plane[7];
    ec_uint axes;
    ec_uint child[8];
} ec_kd_node;
EC_ASSERT_SIZE(ec_kd_node, 64);
#define EC_KD_NO_PLANE 3u
#define EC_KD_LEAF_MOST 63u /* blocks */
#define EC_KD_STACK 160     /* seven entries a level, 12 levels of planes and 8 that leaves of any size may need */

/* Before the nodes, the box of everything. */
typedef struct ec_kd_header {
    ec_float lo[3];
    ec_uint pad0;
    ec_float hi[3];
    ec_uint pad1;
} ec_kd_header;
EC_ASSERT_SIZE(ec_kd_header, 32);
/* Boxes of references, in scenes where the builder has cut triangles: one beside each ec_tri, eight beside each ec_tri8.
 * Elsewhere there are none, and the boxes meant are those of the vertices. */
typedef struct ec_box {
    ec_float lo[3], hi[3];
} ec_box;
EC_ASSERT_SIZE(ec_box, 24);

/* Unused slots are 0. */
typedef struct ec_box8 {
    ec_float lo[3][8], hi[3][8];
} ec_box8;
EC_ASSERT_SIZE(ec_box8, 192);

#endif
