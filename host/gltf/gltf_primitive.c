/* Checks a primitive's types, counts and indices once; it can then be read as plain triangles. */
#include "gltf/codecs.h"

#include <stdio.h>

enum { FLOAT = 1, SIGNED_NORM = 2, UNSIGNED_NORM = 4, SIGNED = 8, UNSIGNED = 16 };

static unsigned kind_of(const ec_gltf_accessor *a)
{
    switch (a->component_type) {
    case EC_GLTF_FLOAT: return FLOAT;
    case EC_GLTF_BYTE:
    case EC_GLTF_SHORT: return a->normalized ? SIGNED_NORM : SIGNED;
    case EC_GLTF_UBYTE:
    case EC_GLTF_USHORT: return a->normalized ? UNSIGNED_NORM : UNSIGNED;
    default: return 0;
    }
}

typedef struct stream_rule {
    const char *name;
    unsigned components[2]; /* allowed numbers */
    unsigned core, quantized; /* kinds allowed by glTF, and those that KHR_mesh_quantization adds */
} stream_rule;

static const stream_rule rules[EC_STREAMS] = {
    {"POSITION", {3, 3}, FLOAT, SIGNED | UNSIGNED | SIGNED_NORM | UNSIGNED_NORM},
    {"NORMAL", {3, 3}, FLOAT, SIGNED_NORM},
    {"TANGENT", {4, 4}, FLOAT, SIGNED_NORM},
    {"COLOR_0", {3, 4}, FLOAT | UNSIGNED_NORM, 0},
    {"TEXCOORD_0", {2, 2}, FLOAT | UNSIGNED_NORM, SIGNED | UNSIGNED | SIGNED_NORM},
    {"TEXCOORD_1", {2, 2}, FLOAT | UNSIGNED_NORM, SIGNED | UNSIGNED | SIGNED_NORM},
};

/* Morph targets hold differences of these attributes. */
static const stream_rule target_rules[EC_STREAMS] = {
    {"POSITION", {3, 3}, FLOAT, SIGNED | SIGNED_NORM},
    {"NORMAL", {3, 3}, FLOAT, SIGNED_NORM},
    {"TANGENT", {3, 3}, FLOAT, SIGNED_NORM},
    {"COLOR_0", {3, 4}, FLOAT | SIGNED_NORM | UNSIGNED_NORM, 0},
    {"TEXCOORD_0", {2, 2}, FLOAT | SIGNED_NORM | UNSIGNED_NORM, SIGNED},
    {"TEXCOORD_1", {2, 2}, FLOAT | SIGNED_NORM | UNSIGNED_NORM, SIGNED},
};
static const stream_rule joints_rule = {"JOINTS", {4, 4}, UNSIGNED, 0},
                         weights_rule = {"WEIGHTS", {4, 4}, FLOAT | UNSIGNED_NORM, 0};

static ec_result open_stream(ec_gltf *g, int32_t accessor, const stream_rule *rule, uint64_t vertex_count,
                             const char *where, ec_error *err)
{
    if (accessor < 0) return EC_OK;
    char what[256];
    snprintf(what, sizeof what, "%s %s", where, rule->name);
    EC_TRY(ec_gltf_accessor_open(g, accessor, what, err));
    const ec_gltf_accessor *a = &g->accessors[accessor];
    unsigned allowed = rule->core | (g->quantized ? rule->quantized : 0);
    if ((a->components != rule->components[0] && a->components != rule->components[1]) || !(kind_of(a) & allowed))
        return ec_fail(err, "%s: %s: accessors[%d] has %u %scomponents of type %u, which glTF does not allow there",
                       g->path, what, accessor, a->components, a->normalized ? "normalized " : "", a->component_type);
    if (a->count != vertex_count)
        return ec_fail(err, "%s: %s: accessors[%d] has %llu elements but POSITION has %llu; export the mesh again",
                       g->path, what, accessor, (unsigned long long)a->count, (unsigned long long)vertex_count);
    return EC_OK;
}

static ec_result open_streams(ec_gltf *g, const ec_gltf_streams *s, const stream_rule rule[EC_STREAMS], uint64_t vertex_count,
                              const char *where, ec_error *err)
{
    for (int i = 0; i < EC_STREAMS; i++) EC_TRY(open_stream(g, s->of[i], &rule[i], vertex_count, where, err));
    return EC_OK;
}

static ec_result open_indices(ec_gltf *g, const ec_gltf_primitive *p, const char *where, ec_error *err)
{
    char what[256];
    snprintf(what, sizeof what, "%s indices", where);
    EC_TRY(ec_gltf_accessor_open(g, p->indices, what, err));
    const ec_gltf_accessor *a = &g->accessors[p->indices];
    bool integer = a->component_type == EC_GLTF_UBYTE || a->component_type == EC_GLTF_USHORT ||
                   a->component_type == EC_GLTF_UINT;
    if (a->components != 1 || !integer)
        return ec_fail(err, "%s: %s: accessors[%d] must hold unsigned integer scalars", g->path, what, p->indices);
    return EC_OK;
}

/* Finds the range of the indices; one beyond the vertices is an error. */
static ec_result scan_indices(const ec_gltf *g, ec_gltf_primitive *p, uint64_t count, const char *where, ec_error *err)
{
    uint64_t vertices = g->accessors[p->streams.of[EC_POSITION]].count;
    p->lowest = 0;
    p->highest = (uint32_t)(vertices - 1);
    if (p->indices < 0) return EC_OK;
    const ec_gltf_accessor *a = &g->accessors[p->indices];
    p->lowest = UINT32_MAX;
    p->highest = 0;
    for (uint64_t i = 0; i < count; i++) {
        uint32_t index = ec_gltf_accessor_index(a, i);
        if (index >= vertices)
            return ec_fail(err, "%s: %s: index %u (entry %llu of accessors[%d]) is out of range, there are %llu vertices",
                           g->path, where, index, (unsigned long long)i, p->indices, (unsigned long long)vertices);
        if (index < p->lowest) p->lowest = index;
        if (index > p->highest) p->highest = index;
    }
    return EC_OK;
}

static ec_result unpack(ec_gltf *g, ec_gltf_primitive *p, const char *where, ec_error *err)
{
    const ec_gltf_view *v = &g->views[p->draco_view];
    const ec_gltf_buffer *b = &g->buffers[v->buffer];
    if (!b->data) return ec_fail(err, "%s: %s reads buffers[%d], which has no data", g->path, where, v->buffer);
    return ec_draco_decode(g, p, b->data + v->offset, v->length, where, err);
}

ec_result ec_gltf_primitive_prepare(ec_gltf *g, ec_gltf_primitive *p, const char *where, ec_error *err)
{
    if (p->prepared) return EC_OK;
    p->prepared = true;
    if (p->streams.of[EC_POSITION] < 0) return EC_OK;
    if (p->draco_view >= 0 && ec_has_draco) EC_TRY(unpack(g, p, where, err));
    uint64_t vertices = g->accessors[p->streams.of[EC_POSITION]].count;
    if (vertices > INT32_MAX)
        return ec_fail(err, "%s: %s claims %llu vertices; at most %d are supported", g->path, where,
                       (unsigned long long)vertices, INT32_MAX);
    EC_TRY(open_streams(g, &p->streams, rules, vertices, where, err));
    if (p->indices >= 0) EC_TRY(open_indices(g, p, where, err));
    uint64_t corners = p->indices >= 0 ? g->accessors[p->indices].count : vertices;
    EC_TRY(scan_indices(g, p, corners, where, err));
    if (p->mode < EC_GLTF_TRIANGLES) return EC_OK; /* thicken.c makes triangles of it */
    if (p->mode == EC_GLTF_TRIANGLES) p->triangle_count = corners / 3;
    else p->triangle_count = corners < 3 ? 0 : corners - 2;
    p->left_over = p->mode == EC_GLTF_TRIANGLES ? corners % 3 != 0 : corners < 3;
    p->drawn = p->triangle_count > 0;
    return EC_OK;
}

ec_result ec_gltf_target_prepare(ec_gltf *g, const ec_gltf_primitive *p, uint32_t target, const char *where, ec_error *err)
{
    return open_streams(g, &p->targets[target], target_rules, g->accessors[p->streams.of[EC_POSITION]].count, where, err);
}

ec_result ec_gltf_influences_prepare(ec_gltf *g, const ec_gltf_primitive *p, const char *where, ec_error *err)
{
    uint64_t vertices = g->accessors[p->streams.of[EC_POSITION]].count;
    for (uint32_t i = 0; i < p->influence_sets; i++) {
        EC_TRY(open_stream(g, p->joints[i], &joints_rule, vertices, where, err));
        EC_TRY(open_stream(g, p->weights[i], &weights_rule, vertices, where, err));
    }
    return EC_OK;
}

void ec_gltf_primitive_triangle(const ec_gltf *g, const ec_gltf_primitive *p, uint64_t t, uint32_t v[3])
{
    uint64_t corner[3] = {3 * t, 3 * t + 1, 3 * t + 2};
    if (p->mode == EC_GLTF_STRIP) { /* every second triangle is reversed, so that all face the same way */
        corner[0] = t;
        corner[1] = t + 1 + t % 2;
        corner[2] = t + 2 - t % 2;
    } else if (p->mode == EC_GLTF_FAN) {
        corner[0] = t + 1;
        corner[1] = t + 2;
        corner[2] = 0;
    }
    for (int i = 0; i < 3; i++)
        v[i] = p->indices >= 0 ? ec_gltf_accessor_index(&g->accessors[p->indices], corner[i]) : (uint32_t)corner[i];
}
