/* Turns points and lines into surfaces. Inside host/gltf/ only. */
#ifndef EC_GLTF_THICKEN_H
#define EC_GLTF_THICKEN_H

#include "gltf/gltf_tree.h"

/* Most sides, and rings per half, of a ball: as fine as points of many pixels need. */
#define EC_BALL_SIDES_MOST 16
#define EC_BALL_RINGS_MOST 4

/* A growing mesh of balls, and of tubes with half a ball at each end, with a radius for each end. */
typedef struct ec_thick_mesh {
    const ec_gltf *g;
    const ec_gltf_primitive *from; /* the primitive whose colours and texture coordinates the vertices get */
    float *streams[EC_STREAMS];    /* NULL: not present */
    uint32_t *indices;
    uint64_t vertex_count, index_count; /* used so far */
    int sides, rings;
    double swell[2];               /* factors by which a ball, and a tube, of flat faces is widened to appear with the same area as a round one */
} ec_thick_mesh;

/* thicken_ball.c: chooses how fine balls are for a width in pixels. */
void ec_ball_choose(ec_thick_mesh *mesh, double pixels);
uint64_t ec_ball_vertices(const ec_thick_mesh *mesh);
uint64_t ec_ball_indices(const ec_thick_mesh *mesh);
/* Appends a ball or a tube. ends: equal for a point; vertices: those of the primitive at the ends. */
void ec_ball_append(ec_thick_mesh *mesh, const double ends[2][3], const double radii[2], const uint32_t vertices[2]);

/* Tells whether a primitive is points or lines. */
static inline bool ec_is_thin(const ec_gltf_primitive *p) { return p->mode < EC_GLTF_TRIANGLES && p->streams.of[EC_POSITION] >= 0; }

/* thicken.c: adds a mesh of triangles for each placement that has points or lines. They are as wide as gltf->point_size pixels at their place, in a
 * picture 512 pixels high by the scene's first camera. To be called after morph targets and skins. moving: only for placements that move within the
 * shutter; those added for others stay empty. */
ec_result ec_gltf_thicken(ec_gltf *gltf, ec_placement_list *placements, bool moving, ec_error *err);

#endif
