/* Shared by the parts of deformation: deform.c chooses the meshes, deform_vertex.c moves their vertices, skin.c finds the joints. */
#ifndef EC_GLTF_DEFORM_H
#define EC_GLTF_DEFORM_H

#include "gltf/gltf_tree.h"

typedef struct ec_pose {
    const float *weights; /* of the morph targets */
    uint32_t weight_count;
    ec_placement *joints; /* for each joint, the transform from the mesh in bind pose to the world; NULL: no skin. Owned by the pose */
    uint32_t joint_count;
    double origin[3];     /* skinned vertices are kept relative to this point, so that floats are precise far from the world's origin, */
    bool mirrored;        /* and with x negated if the skeleton mirrors; their triangles are then reversed, as under a mirroring node */
} ec_pose;

/* skin.c: computes the joints' transforms. placement_of: by node, an index into the placements; -1: the scene does not show it. */
ec_result ec_pose_skin(ec_gltf *gltf, int32_t skin, const ec_placement_list *placements, const int32_t *placement_of, ec_pose *pose,
                       ec_error *err);

/* Blends the joints' transforms by a vertex' weights. Fails if the vertex refers to a joint that the skin does not have. */
ec_result ec_pose_blend(const ec_gltf *gltf, const ec_gltf_primitive *primitive, const ec_pose *pose, uint32_t vertex,
                        ec_placement *blend, const char *where, ec_error *err);

/* deform_vertex.c: replaces a primitive's streams by deformed ones, in new accessors. */
ec_result ec_pose_primitive(ec_gltf *gltf, const ec_pose *pose, ec_gltf_primitive *primitive, const char *where, ec_error *err);

#endif
