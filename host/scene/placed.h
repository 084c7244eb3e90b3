/* Meshes that are kept once and placed many times. Their triangles follow all others in the scene's arrays, in coordinates of their own. Placed
 * triangles are numbered as if they were written out: a triangle's id is the first id of its instance plus its number in the mesh, so that hits, ties
 * and random decisions know a single number. */
#ifndef EC_SCENE_PLACED_H
#define EC_SCENE_PLACED_H

#include <stdbool.h>
#include <stdint.h>

/* Which meshes are kept once: those where it saves much; none; all that are placed more than once. */
typedef enum ec_instancing { EC_INSTANCING_AUTO, EC_INSTANCING_OFF, EC_INSTANCING_ON } ec_instancing;

typedef struct ec_shape {
    uint32_t first, count;               /* triangles */
    uint32_t first_vertex, vertex_count;
} ec_shape;

typedef struct ec_placed {
    uint32_t shape, id;  /* id: that of its first triangle */
    float place[3][4];   /* rows: recentred world = place x (point of the shape, 1) */
    float normal[3][3];  /* for normals: the inverse transpose up to a positive factor */
    bool mirrored;       /* corners 1 and 2 of every triangle are swapped, so that fronts stay fronts */
} ec_placed;

/* Defines the position of a corner, exactly as kernels/lib/instance.h: whoever transforms a corner to the world gets the same bits, so that shared
 * vertices leave no cracks, whether written out here or placed during traversal. */
void ec_placed_point(const ec_placed *placed, const float point[3], float out[3]);
/* Return unit vectors; a direction of 0 stays 0. */
void ec_placed_normal(const ec_placed *placed, const float normal[3], float out[3]);
void ec_placed_tangent(const ec_placed *placed, const float tangent[4], float out[4]);
/* Tells whether rounding has left a triangle without a normal. Such a triangle is never hit. */
bool ec_placed_is_flat(const float a[3], const float b[3], const float c[3]);

#endif
