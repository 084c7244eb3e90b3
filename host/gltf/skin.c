/* Skins: glTF 2.0, 3.7.3.3. The node of a skinned mesh does not move it; its joints do. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gltf/deform.h"

static ec_result open_bind(ec_gltf *g, int32_t skin, const ec_gltf_accessor **bind, ec_error *err)
{
    const ec_gltf_skin *s = &g->skins[skin];
    char where[64];
    *bind = NULL;
    if (s->inverse_bind < 0) return EC_OK;
    snprintf(where, sizeof where, "skins[%d] inverseBindMatrices", skin);
    EC_TRY(ec_gltf_accessor_open(g, s->inverse_bind, where, err));
    *bind = &g->accessors[s->inverse_bind];
    if ((*bind)->components != 16 || (*bind)->component_type != EC_GLTF_FLOAT)
        return ec_fail(err, "%s: %s: accessors[%d] must hold 4x4 matrices of floats", g->path, where, s->inverse_bind);
    if ((*bind)->count < s->joint_count)
        return ec_fail(err, "%s: %s: accessors[%d] has %llu matrices for %u joints", g->path, where, s->inverse_bind,
                       (unsigned long long)(*bind)->count, s->joint_count);
    return EC_OK;
}

ec_result ec_pose_skin(ec_gltf *g, int32_t skin, const ec_placement_list *placements, const int32_t *placement_of, ec_pose *pose,
                       ec_error *err)
{
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const ec_gltf_skin *s = &g->skins[skin];
    const ec_gltf_accessor *bind;
    int turned = 0;
    EC_TRY(open_bind(g, skin, &bind, err));
    pose->joints = calloc((size_t)s->joint_count + 1, sizeof *pose->joints);
    if (!pose->joints) return ec_fail(err, "%s: out of memory for skins[%d]", g->path, skin);
    for (; pose->joint_count < s->joint_count; pose->joint_count++) {
        int32_t node = s->joints[pose->joint_count], at = placement_of[node];
        ec_placement *joint = &pose->joints[pose->joint_count];
        float stored[16];
        double matrix[16];
        if (at < 0)
            return ec_fail(err, "%s: skins[%d] has nodes[%d] as a joint, but that node is not in the mesh's scene",
                           g->path, skin, node);
        if (bind) ec_gltf_accessor_floats(bind, pose->joint_count, 16, stored);
        for (int i = 0; i < 16; i++) matrix[i] = bind ? (double)stored[i] : identity[i];
        ec_placement_compose(&placements->items[at], matrix, joint);
        turned += ec_gltf_determinant(joint->linear) < 0 ? 1 : -1;
        for (int k = 0; k < 3 && pose->joint_count == 0; k++)
            pose->origin[k] = isfinite(placements->items[at].origin[k]) ? placements->items[at].origin[k] : 0;
    }
    pose->mirrored = turned > 0;
    return EC_OK;
}

static void add(ec_placement *sum, const ec_placement *joint, double weight)
{
    for (int i = 0; i < 9; i++) sum->linear[i] += weight * joint->linear[i];
    for (int i = 0; i < 3; i++) sum->origin[i] += weight * joint->origin[i];
}

ec_result ec_pose_blend(const ec_gltf *g, const ec_gltf_primitive *p, const ec_pose *pose, uint32_t vertex, ec_placement *blend,
                        const char *where, ec_error *err)
{
    double total = 0;
    *blend = (ec_placement){.node = -1};
    for (uint32_t set = 0; set < p->influence_sets; set++) {
        float joint[4], weight[4];
        ec_gltf_accessor_floats(&g->accessors[p->joints[set]], vertex, 4, joint);
        ec_gltf_accessor_floats(&g->accessors[p->weights[set]], vertex, 4, weight);
        for (int i = 0; i < 4; i++) {
            if (!(weight[i] > 0) || !isfinite(weight[i])) continue;
            if (!(joint[i] < (float)pose->joint_count))
                return ec_fail(err, "%s: %s: vertex %u uses joint %g, but its skin has %u joints", g->path, where, vertex,
                               (double)joint[i], pose->joint_count);
            add(blend, &pose->joints[(uint32_t)joint[i]], weight[i]);
            total += weight[i];
        }
    }
    if (total > 0) {
        for (int i = 0; i < 9; i++) blend->linear[i] /= total;
        for (int i = 0; i < 3; i++) blend->origin[i] /= total;
    } else if (pose->joint_count) {
        *blend = pose->joints[0]; /* vertices without influences follow the first joint */
    }
    return EC_OK;
}
