/* Chooses meshes that are kept once instead of being written out at every place. Inside host/gltf/ only. */
#ifndef EC_GLTF_KEEP_H
#define EC_GLTF_KEEP_H

#include "gltf/flatten_vertex.h"

/* A mesh that several nodes show, and the extent of its finite triangles in the file's coordinates. */
typedef struct ec_kept_mesh {
    int32_t mesh;
    uint32_t places;         /* number of places where it may be an instance */
    uint64_t triangles;
    double low[3], high[3];
    bool is_kept;
    uint32_t shape;          /* index in the scene, set once its triangles are there */
    uint32_t dropped_degenerate, dropped_nonfinite; /* of these triangles */
} ec_kept_mesh;

typedef struct ec_keeping {
    const ec_gltf *g;
    const ec_placement_list *placements;
    ec_kept_mesh *meshes;    /* candidates */
    uint32_t mesh_count;
    int32_t *candidate;      /* by placement: index into meshes; -1: none, or the mesh cannot be an instance there */
    bool *is_kept;           /* by placement; NULL: no mesh is kept once */
} ec_keeping;

extern const ec_placement ec_at_home; /* the identity: the file's own coordinates */

/* Chooses the meshes to keep once, as gltf->instancing demands. Needs the scene's materials. */
ec_result ec_keep_choose(const ec_gltf *g, const ec_placement_list *placements, const ec_scene *scene,
                         ec_keeping *keeping, ec_error *err);
void ec_keep_free(ec_keeping *keeping);

/* The steps of flattening, for meshes that are kept once. */
ec_result ec_keep_count(const ec_keeping *keeping, ec_flattener *f);
ec_result ec_keep_measure(const ec_keeping *keeping, ec_flattener *f);
ec_result ec_keep_fill(ec_keeping *keeping, ec_flattener *f); /* after all flat triangles: appends shapes and their places */

#endif
