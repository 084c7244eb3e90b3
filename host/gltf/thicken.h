/* Points and lines as surfaces. Inside host/gltf/ only. */
#ifndef EC_GLTF_THICKEN_H
#define EC_GLTF_THICKEN_H

#include "gltf/gltf_tree.h"

/* Rings and sides of half a ball: as fine as points of that many pixels need. */
#define EC_BALL_SIDES_MOST 16
#define EC_BALL_RINGS_MOST 4

/* A ball, or half a ball at each end of a tube, of radii as seen at its ends; triangles go to a growing mesh. */
typedef struct ec_thick_mesh {
    const ec_gltf *g;
    const ec_gltf_primitive *from; /* whose colours and texture coordinates its vertices have */
    float *streams[EC_STREAMS];    /* NULL: none */
    uint32_t *indices;
    uint64_t vertex_count, index_count; /* filled */
    int sides, rings;
    double swell[2];               /* by what a ball, and what a tube, of flat faces is wider than round ones of as much area as seen */
} ec_thick_mesh;

/* thicken_ball.c: how fine, for so many pixels. */
void ec_ball_choose(ec_thick_mesh *mesh, double pixels);
uint64_t ec_ball_vertices(const ec_thick_mesh *mesh);
uint64_t ec_ball_indices(const ec_thick_mesh *mesh);
/* ends: the same for a point; vertices: of the primitive, at the ends. */
void ec_ball_append(ec_thick_mesh *mesh, const double ends[2][3], const double radii[2], const uint32_t vertices[2]);

/* Is it points or lines? */
static inline bool ec_is_thin(const ec_gltf_primitive *p) { return p->mode < EC_GLTF_TRIANGLES && p->streams.of[EC_POSITION] >= 0; }

/* thicken.c: puts a mesh of triangles at the place of each that has points or lines, as wide as gltf->point_size pixels of a picture 512 high
 * are where they stand, for the scene's first camera. Comes after morph targets and skins. moving: for those alone that move within the
 * shutter; the others' places stay empty. */
ec_result ec_gltf_thicken(ec_gltf *gltf, ec_placement_list *placements, bool moving, ec_error *err);

#endif
