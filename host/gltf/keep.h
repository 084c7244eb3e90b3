/* Meshes that are kept once instead of being written out at every place. Inside host/gltf/ only. */
#ifndef EC_GLTF_KEEP_H
#define EC_GLTF_KEEP_H

#include "gltf/flatten_vertex.h"

/* A mesh that several nodes show, and what its finite triangles span in the file's coordinates. */
typedef struct ec_kept_mesh {
    int32_t mesh;
    uint32_t places;         /* where it may stand as an instance */
    uint64_t triangles;
    double low[3], high[3];
    bool is_kept;
    uint32_t shape;          /* in the scene; set once its triangles are there */
    uint32_t dropped_degenerate, dropped_nonfinite; /* of these triangles */
} ec_kept_mesh;

typedef struct ec_keeping {
    const ec_gltf *g;
    const ec_placement_list *placements;
    ec_kept_mesh *meshes;    /* candidates */
    uint32_t mesh_count;
    int32_t *candidate;      /* by placement: index into meshes; -1: none, or not fit to be an instance there */
    bool *is_kept;           /* by placement; NULL: no mesh is kept */
} ec_keeping;

extern const ec_placement ec_at_home; /* in the file's coordinates */

/* gltf->instancing says what is wished. Needs the materials. */
ec_result ec_keep_choose(const ec_gltf *g, const ec_placement_list *placements, const ec_scene *scene,
                         ec_keeping *keeping, ec_error *err);
void ec_keep_free(ec_keeping *keeping);

/* The steps of flattening, for the kept meshes. */
ec_result ec_keep_count(const ec_keeping *keeping, ec_flattener *f);
ec_result ec_keep_measure(const ec_keeping *keeping, ec_flattener *f);
ec_result ec_keep_fill(ec_keeping *keeping, ec_flattener *f); /* after all that is flat: shapes, and where they are placed */

#endif
