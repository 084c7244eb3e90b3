/* Moves a primitive's vertices by morph targets, then by joints: glTF 2.0, 3.7.2.2 and 3.7.3.3. */
#include <stdlib.h>
#include <string.h>

#include "gltf/deform.h"

/* One stream, and the accessors of what each target adds to it; -1: nothing. */
typedef struct moved {
    const ec_gltf_accessor *base;
    float *out;
    uint32_t components;
} moved;

/* Adds the weighted differences of the targets to the stored value. */
static void morph(const ec_gltf *g, const ec_gltf_primitive *p, const ec_pose *pose, int stream, const moved *m, uint32_t vertex, double out[4])
{
    float value[4] = {0};
    ec_gltf_accessor_floats(m->base, vertex, m->components, value);
    for (uint32_t k = 0; k < 4; k++) out[k] = (double)value[k];
    for (uint32_t t = 0; t < pose->weight_count; t++) {
        int32_t accessor = p->targets[t].of[stream];
        if (pose->weights[t] == 0 || accessor < 0) continue;
        const ec_gltf_accessor *a = &g->accessors[accessor];
        uint32_t count = a->components < m->components ? a->components : m->components; /* a tangent's sign is not morphed */
        ec_gltf_accessor_floats(a, vertex, count, value);
        for (uint32_t k = 0; k < count; k++) out[k] += (double)pose->weights[t] * (double)value[k];
    }
}

static void turn(const double m[9], double v[4])
{
    const double in[3] = {v[0], v[1], v[2]};
    for (int i = 0; i < 3; i++) v[i] = m[3 * i] * in[0] + m[3 * i + 1] * in[1] + m[3 * i + 2] * in[2];
}

static void skin(const ec_pose *pose, const ec_placement *blend, int stream, double v[4])
{
    double normal_matrix[9];
    if (stream == EC_NORMAL) ec_gltf_normal_matrix(blend->linear, normal_matrix);
    turn(stream == EC_NORMAL ? normal_matrix : blend->linear, v);
    for (int k = 0; k < 3 && stream == EC_POSITION; k++) v[k] += blend->origin[k] - pose->origin[k];
    if (pose->mirrored) v[0] = -v[0];
}

static ec_result move_vertex(const ec_gltf *g, const ec_gltf_primitive *p, const ec_pose *pose,
                             const moved streams[EC_STREAMS], uint32_t vertex, const char *where, ec_error *err)
{
    ec_placement blend;
    if (pose->joints) EC_TRY(ec_pose_blend(g, p, pose, vertex, &blend, where, err));
    for (int i = 0; i < EC_STREAMS; i++) {
        const moved *m = &streams[i];
        double value[4];
        if (!m->out) continue;
        morph(g, p, pose, i, m, vertex, value);
        if (pose->joints && i <= EC_TANGENT) skin(pose, &blend, i, value);
        for (uint32_t k = 0; k < m->components; k++) m->out[(size_t)vertex * m->components + k] = (float)value[k];
    }
    return EC_OK;
}

/* Appends an accessor that owns `values`; they are freed on failure. */
static ec_result append(ec_gltf *g, float *values, uint64_t count, uint32_t components, int32_t *accessor, ec_error *err)
{
    ec_gltf_accessor *grown = realloc(g->accessors, ((size_t)g->accessor_count + 1) * sizeof *grown);
    if (!grown) {
        free(values);
        return ec_fail(err, "%s: out of memory for deformed meshes", g->path);
    }
    g->accessors = grown;
    *accessor = (int32_t)g->accessor_count++;
    g->accessors[*accessor] = (ec_gltf_accessor){
        .view = -1, .count = count, .component_type = EC_GLTF_FLOAT, .components = components, .open = true,
        .data = (uint8_t *)(void *)values, .owned = (uint8_t *)(void *)values, .stride = components * sizeof *values};
    return EC_OK;
}

/* Tells whether this pose changes the stream. */
static bool is_moved(const ec_gltf_primitive *p, const ec_pose *pose, int stream)
{
    if (p->streams.of[stream] < 0) return false;
    if (pose->joints && stream <= EC_TANGENT) return true;
    for (uint32_t t = 0; t < pose->weight_count; t++)
        if (pose->weights[t] != 0 && p->targets[t].of[stream] >= 0) return true;
    return false;
}

ec_result ec_pose_primitive(ec_gltf *g, const ec_pose *pose, ec_gltf_primitive *p, const char *where, ec_error *err)
{
    moved streams[EC_STREAMS] = {{0}};
    uint64_t count = g->accessors[p->streams.of[EC_POSITION]].count;
    ec_result result = EC_OK;
    for (int i = 0; i < EC_STREAMS; i++) {
        if (!is_moved(p, pose, i)) continue;
        const ec_gltf_accessor *base = &g->accessors[p->streams.of[i]];
        streams[i] = (moved){base, calloc(count, base->components * sizeof(float)), base->components};
        if (!streams[i].out)
            result = ec_fail(err, "%s: %s: out of memory for %llu deformed vertices", g->path, where,
                             (unsigned long long)count);
    }
    for (uint32_t v = p->lowest; v <= p->highest && result == EC_OK; v++) result = move_vertex(g, p, pose, streams, v, where, err);
    for (int i = 0; i < EC_STREAMS; i++) {
        if (!streams[i].out) continue;
        if (result == EC_OK) result = append(g, streams[i].out, count, streams[i].components, &p->streams.of[i], err);
        else free(streams[i].out);
    }
    return result;
}
