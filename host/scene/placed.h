/* Meshes that are kept once and stand in many places. Their triangles lie behind all others in the scene's arrays, in a space of
 * their own; what is placed is counted as if it were written out: a triangle's id is its instance's first id plus its number in
 * the mesh, so hits, ties and random decisions know one number only. */
#ifndef EC_SCENE_PLACED_H
#define EC_SCENE_PLACED_H

#include <stdbool.h>
#include <stdint.h>

/* Which meshes are kept once: where that saves much, none, or all that stand twice. */
typedef enum ec_instancing { EC_INSTANCING_AUTO, EC_INSTANCING_OFF, EC_INSTANCING_ON } ec_instancing;

typedef struct ec_shape {
    uint32_t first, count;               /* triangles */
    uint32_t first_vertex, vertex_count;
} ec_shape;

typedef struct ec_placed {
    uint32_t shape, id;  /* id: of its first triangle */
    float place[3][4];   /* rows: recentred world = place x (shape's point, 1) */
    float normal[3][3];  /* turns normals: the inverse transpose up to a positive factor */
    bool mirrored;       /* corners 1 and 2 of every triangle change places, so that fronts stay fronts */
} ec_placed;

/* The definition of where a corner is, word for word that of kernels/lib/instance.h: whoever takes a corner to the world gets the
 * same bits, so what shares a vertex has no cracks, whether it was written out here or placed while a ray was on its way. */
void ec_placed_point(const ec_placed *placed, const float point[3], float out[3]);
/* Unit length; a direction of 0 stays 0. */
void ec_placed_normal(const ec_placed *placed, const float normal[3], float out[3]);
void ec_placed_tangent(const ec_placed *placed, const float tangent[4], float out[4]);
/* Rounding may leave of a small triangle nothing that has a normal. Such a one is never hit. */
bool ec_placed_is_flat(const float a[3], const float b[3], const float c[3]);

#endif
