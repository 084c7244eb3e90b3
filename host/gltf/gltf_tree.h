/* The node tree, walked: what stands where in the world. Inside host/gltf/ only. */
#ifndef EC_GLTF_GLTF_TREE_H
#define EC_GLTF_GLTF_TREE_H

#include "gltf/gltf.h"

/* A node's place: world = linear x local + origin, in double. */
typedef struct ec_placement {
    int32_t node;
    int32_t mesh; /* what stands there: the node's, or a deformed copy; -1: none, or none that is seen */
    double linear[9]; /* row major */
    double origin[3];
    bool reached; /* by a channel of the animation, or a node above it is */
    bool moves; /* or may, within the shutter */
    bool extra; /* a mesh that stands elsewhere than its node: no camera, no light */
    bool hidden; /* by its node or one above: no mesh, no light */
} ec_placement;

typedef struct ec_placement_list {
    ec_placement *items;
    uint32_t count, room;
} ec_placement_list;

/* Every node of the default scene, parents before children; items are the caller's, also after a failure: a node with two parents or
 * inside a cycle is one. */
ec_result ec_gltf_place_nodes(const ec_gltf *gltf, ec_placement_list *placements, ec_error *err);

/* instances.c: where a node has instances, they stand in its place. */
ec_result ec_gltf_place_instances(ec_gltf *gltf, ec_placement_list *placements, const ec_log *log, ec_error *err);

/* The nearest node that is so, this one or one it stands below; -1: none. */
ec_result ec_gltf_node_above(const ec_gltf *gltf, int32_t node, bool (*is)(const ec_gltf_node *), int32_t *found,
                             ec_error *err);

/* Sets linear and origin of *out to `local` (column major, as in the file) in the frame of `parent`; NULL: in the world. */
void ec_placement_compose(const ec_placement *parent, const double local[16], ec_placement *out);

/* One more at the end. Items may move. */
ec_result ec_placement_append(ec_placement_list *placements, const ec_placement *placement, ec_error *err);

/* The inverse transpose up to a positive factor, also for singular matrices: turns normals. Row major. */
void ec_gltf_normal_matrix(const double linear[9], double out[9]);
double ec_gltf_determinant(const double linear[9]);

#endif
