/* Shared by the parts of deformation: deform.c chooses the meshes, deform_vertex.c moves their vertices, skin.c finds the joints. */
#ifndef EC_GLTF_DEFORM_H
#define EC_GLTF_DEFORM_H

#include "gltf/gltf_tree.h"

typedef struct ec_pose {
    const float *weights; /* of morph targets */
    uint32_t weight_count;
    ec_placement *joints; /* from the mesh as it is bound to the world, by way of each. NULL: no skin. Owned by the pose */
    uint32_t joint_count;
    double origin[3];     /* skinned vertices are kept relative to this, so that floats hold them far from the world's origin, */
    bool mirrored;        /* and with x turned where the skeleton mirrors: triangles are then turned as for a mirroring node */
} ec_pose;

/* skin.c: where the joints are. placement_of: by node, -1 for those that the scene does not show. */
ec_result ec_pose_skin(ec_gltf *gltf, int32_t skin, const ec_placement_list *placements, const int32_t *placement_of, ec_pose *pose,
                       ec_error *err);

/* Blends the joints by a vertex' weights. Fails where a joint is not in the skin. */
ec_result ec_pose_blend(const ec_gltf *gltf, const ec_gltf_primitive *primitive, const ec_pose *pose, uint32_t vertex,
                        ec_placement *blend, const char *where, ec_error *err);

/* deform_vertex.c: new streams for a primitive, as new accessors. */
ec_result ec_pose_primitive(ec_gltf *gltf, const ec_pose *pose, ec_gltf_primitive *primitive, const char *where, ec_error *err);

#endif
