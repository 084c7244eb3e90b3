/* Applies morph targets and skins. A mesh that they move is replaced by a copy in its final shape, so that later steps know of neither, and scenes
 * without them pay nothing. */
#include "gltf/deform.h"
#include "base/text.h"
#include "gltf/flatten.h"
#include "gltf/thicken.h"

#include <stdio.h>
#include <string.h>

#include "base/freed.h"
#include "base/memory.h"

typedef struct deformer {
    ec_gltf *g;
    ec_placement_list *placements;
    int32_t *placement_of; /* by node: index into the placements; -1: not in the scene */
    int32_t *shared;       /* by mesh: its copy deformed by its own weights, shared by all nodes without weights and skins; -1: none yet */
    uint64_t bytes;
    ec_error *err;
} deformer;

static bool any_weight(const float *weights, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (weights[i] != 0) return true;
    return false;
}

static bool has_influences(const ec_gltf_mesh *mesh)
{
    for (uint32_t k = 0; k < mesh->primitive_count; k++)
        if (mesh->primitives[k].influence_sets) return true;
    return false;
}

/* Fails if the deformed copies outgrow the memory: a few bytes may stand for many vertices, and each node that deforms a mesh has a copy of its own. */
static ec_result check_memory(deformer *d, const ec_gltf_primitive *p)
{
    uint64_t memory = ec_memory_of_machine();
    d->bytes += d->g->accessors[p->streams.of[EC_POSITION]].count * 72;
    if (d->bytes <= memory) return EC_OK;
    return ec_fail(d->err, "%s: its deformed meshes need %llu MB, but this machine has %llu MB; simplify the scene", d->g->path,
                   (unsigned long long)(d->bytes >> 20), (unsigned long long)(memory >> 20));
}

static ec_result prepare(deformer *d, const ec_pose *pose, const ec_gltf_primitive *p, const char *where)
{
    EC_TRY(check_memory(d, p));
    if (pose->weight_count > p->target_count)
        return ec_fail(d->err, "%s: %s has %u morph targets for %u weights", d->g->path, where, p->target_count,
                       pose->weight_count);
    for (uint32_t t = 0; t < pose->weight_count; t++) {
        char target[160];
        snprintf(target, sizeof target, "%.*s targets[%u]", EC_CUT(where, 100), t);
        if (pose->weights[t] != 0) EC_TRY(ec_gltf_target_prepare(d->g, p, t, target, d->err));
    }
    return pose->joints ? ec_gltf_influences_prepare(d->g, p, where, d->err) : EC_OK;
}

/* Appends a copy of a mesh, whose primitives share the streams that are not deformed. */
static ec_result copy_mesh(deformer *d, int32_t index)
{
    ec_gltf *g = d->g;
    ec_gltf_mesh *grown = realloc(g->meshes, ((size_t)g->mesh_count + 1) * sizeof *grown);
    if (grown) g->meshes = grown;
    ec_gltf_primitive *primitives = malloc((size_t)g->meshes[index].primitive_count * sizeof *primitives + 1);
    if (!grown || !primitives) {
        free(primitives);
        return ec_fail(d->err, "%s: out of memory for deformed meshes", g->path);
    }
    const ec_gltf_mesh *from = &g->meshes[index];
    for (uint32_t k = 0; k < from->primitive_count; k++) {
        primitives[k] = from->primitives[k];
        primitives[k].targets = NULL;
        primitives[k].draco = NULL;
        primitives[k].joints = primitives[k].weights = NULL;
        primitives[k].target_count = primitives[k].influence_sets = 0;
    }
    g->meshes[g->mesh_count++] = (ec_gltf_mesh){.primitives = primitives, .primitive_count = from->primitive_count};
    return EC_OK;
}

static ec_result deform_mesh(deformer *d, const ec_pose *pose, int32_t index)
{
    ec_gltf *g = d->g;
    EC_TRY(copy_mesh(d, index));
    for (uint32_t k = 0; k < g->meshes[index].primitive_count; k++) {
        ec_gltf_primitive moved = g->meshes[index].primitives[k], *out = &g->meshes[g->mesh_count - 1].primitives[k];
        char where[96];
        if (!moved.drawn && !ec_is_thin(&moved)) continue;
        snprintf(where, sizeof where, "meshes[%d].primitives[%u]", index, k);
        EC_TRY(prepare(d, pose, &moved, where));
        EC_TRY(ec_pose_primitive(g, pose, &moved, where, d->err));
        out->streams = moved.streams;
    }
    return EC_OK;
}

/* Places a skinned mesh in the world. Its node no longer moves it, but still moves a camera there and acts as a joint. */
static ec_result stand_in_world(deformer *d, uint32_t index, const ec_pose *pose)
{
    ec_placement *at = &d->placements->items[index];
    ec_placement world = {.node = at->node, .mesh = at->mesh, .linear = {pose->mirrored ? -1 : 1, 0, 0, 0, 1, 0, 0, 0, 1},
                          .reached = at->reached, .moves = at->moves, .extra = true};
    memcpy(world.origin, pose->origin, sizeof world.origin);
    at->mesh = -1;
    return ec_placement_append(d->placements, &world, d->err);
}

static ec_result deform(deformer *d, const ec_gltf_node *node, const ec_pose *pose, ec_placement *at)
{
    bool own = pose->joints || node->weight_count;
    if (!own && d->shared[at->mesh] >= 0) {
        at->mesh = d->shared[at->mesh];
        return EC_OK;
    }
    EC_TRY(deform_mesh(d, pose, at->mesh));
    int32_t copy = (int32_t)d->g->mesh_count - 1;
    if (!own) d->shared[at->mesh] = copy;
    at->mesh = copy;
    return EC_OK;
}

static ec_result visit(deformer *d, uint32_t index)
{
    ec_placement *at = &d->placements->items[index];
    const ec_gltf_node *node = &d->g->nodes[at->node];
    if (at->mesh < 0) return EC_OK;
    const ec_gltf_mesh *mesh = &d->g->meshes[at->mesh];
    ec_pose pose = {.weights = node->weight_count ? node->weights : mesh->weights,
                    .weight_count = node->weight_count ? node->weight_count : mesh->weight_count};
    bool skinned = node->skin >= 0 && has_influences(mesh);
    if (d->g->animated && (skinned || pose.weight_count)) at->reached = true, at->moves = d->g->blurs; /* its joints or weights may be animated */
    if (!any_weight(pose.weights, pose.weight_count)) pose.weight_count = 0;
    ec_result result = skinned ? ec_pose_skin(d->g, node->skin, d->placements, d->placement_of, &pose, d->err) : EC_OK;
    if (result == EC_OK && (skinned || pose.weight_count)) result = deform(d, node, &pose, at);
    if (result == EC_OK && skinned) result = stand_in_world(d, index, &pose);
    free(pose.joints);
    return result;
}

ec_result ec_gltf_deform(ec_gltf *g, ec_placement_list *placements, ec_error *err)
{
    EC_FREED int32_t *placement_of = malloc(((size_t)g->node_count + 1) * sizeof *placement_of);
    EC_FREED int32_t *shared = malloc(((size_t)g->mesh_count + 1) * sizeof *shared);
    deformer d = {g, placements, placement_of, shared, 0, err};
    if (!placement_of || !shared) return ec_fail(err, "%s: out of memory for %u nodes", g->path, g->node_count);
    for (uint32_t i = 0; i < g->node_count; i++) placement_of[i] = -1;
    for (uint32_t i = 0; i < g->mesh_count; i++) shared[i] = -1;
    for (uint32_t i = 0; i < placements->count; i++)
        if (!placements->items[i].extra) placement_of[placements->items[i].node] = (int32_t)i;
    for (uint32_t i = 0, count = placements->count; i < count; i++) EC_TRY(visit(&d, i));
    return EC_OK;
}
