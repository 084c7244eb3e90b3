/* Walks the node tree: what is placed where in the world. Inside host/gltf/ only. */
#ifndef EC_GLTF_GLTF_TREE_H
#define EC_GLTF_GLTF_TREE_H

#include "gltf/gltf.h"

/* The transform of a node: world = linear x local + origin, in double. */
typedef struct ec_placement {
    int32_t node;
    int32_t mesh; /* the node's mesh, or a deformed copy of it; -1: none, or none that is visible */
    double linear[9]; /* row major */
    double origin[3];
    bool reached; /* a channel of the animation moves it or a node above it */
    bool moves; /* it may move within the shutter */
    bool extra; /* an additional mesh, placed independently of its node: has no camera and no light */
    bool hidden; /* by its node or one above: shows no mesh and no light */
} ec_placement;

typedef struct ec_placement_list {
    ec_placement *items;
    uint32_t count, room;
} ec_placement_list;

/* Lists every node of the shown scene, parents before children. The caller frees items, also after a failure: a node with two parents or in a cycle
 * is one. */
ec_result ec_gltf_place_nodes(const ec_gltf *gltf, ec_placement_list *placements, ec_error *err);

/* instances.c: replaces nodes with instances by one placement for each instance. */
ec_result ec_gltf_place_instances(ec_gltf *gltf, ec_placement_list *placements, const ec_log *log, ec_error *err);

/* Finds the nearest node for which `is` returns true: the node itself or one above it; -1: none. */
ec_result ec_gltf_node_above(const ec_gltf *gltf, int32_t node, bool (*is)(const ec_gltf_node *), int32_t *found,
                             ec_error *err);

/* Sets linear and origin of *out to the matrix `local` (column major, as in the file) in the frame of `parent`; NULL: of the world. */
void ec_placement_compose(const ec_placement *parent, const double local[16], ec_placement *out);

/* Appends a placement; may move items. */
ec_result ec_placement_append(ec_placement_list *placements, const ec_placement *placement, ec_error *err);

/* Computes the matrix for normals: the inverse transpose up to a positive factor, also of singular matrices. Row major. */
void ec_gltf_normal_matrix(const double linear[9], double out[9]);
double ec_gltf_determinant(const double linear[9]);

#endif
