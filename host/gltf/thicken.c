/* Gives width to glTF's points and lines, which have none, since paths can only hit surfaces. */
#include "gltf/thicken.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/vec3.h"

#define PICTURE_HEIGHT 512

/* The size of a pixel in the world: fixed + per_depth x depth. */
typedef struct eye {
    double position[3], forward[3];
    double per_depth, fixed;
} eye;

/* Counts the points, or the segments of lines. */
static uint64_t count_parts(const ec_gltf *g, const ec_gltf_primitive *p)
{
    const uint64_t corners = p->indices >= 0 ? g->accessors[p->indices].count : g->accessors[p->streams.of[EC_POSITION]].count;
    if (p->mode == EC_GLTF_POINTS) return corners;
    if (p->mode == EC_GLTF_LINES) return corners / 2;
    return corners < 2 ? 0 : p->mode == EC_GLTF_LINE_LOOP ? corners : corners - 1;
}

static void get_ends(const ec_gltf *g, const ec_gltf_primitive *p, uint64_t part, uint64_t parts, uint32_t vertices[2])
{
    uint64_t corner[2] = {part, part + 1};
    if (p->mode == EC_GLTF_POINTS) corner[1] = part;
    if (p->mode == EC_GLTF_LINES) corner[0] = 2 * part, corner[1] = 2 * part + 1;
    if (p->mode == EC_GLTF_LINE_LOOP) corner[1] %= parts;
    for (int i = 0; i < 2; i++) vertices[i] = p->indices >= 0 ? ec_gltf_accessor_index(&g->accessors[p->indices], corner[i]) : (uint32_t)corner[i];
}

static void to_world(const ec_gltf *g, const ec_gltf_primitive *p, const ec_placement *at, uint32_t vertex, double world[3])
{
    float local[3];
    ec_gltf_accessor_floats(&g->accessors[p->streams.of[EC_POSITION]], vertex, 3, local);
    for (int k = 0; k < 3; k++)
        world[k] = at->linear[3 * k] * local[0] + at->linear[3 * k + 1] * local[1] + at->linear[3 * k + 2] * local[2] + at->origin[k];
}

static bool look_through(const ec_gltf *g, const ec_placement_list *list, eye *e)
{
    for (uint32_t i = 0; i < list->count; i++) {
        const ec_placement *at = &list->items[i];
        const int32_t index = g->nodes[at->node].camera;
        if (index < 0 || at->extra) continue;
        const ec_camera *c = &g->cameras[index];
        if (c->type == EC_CAMERA_ORTHOGRAPHIC) e->fixed = 2 * (double)c->ymag / PICTURE_HEIGHT;
        else e->per_depth = 2 * tan(0.5 * (double)c->yfov) / PICTURE_HEIGHT;
        for (int k = 0; k < 3; k++) {
            e->position[k] = at->origin[k];
            e->forward[k] = -at->linear[3 * k + 2];
        }
        return ec_normalize(e->forward);
    }
    return false;
}

/* Approximates the camera that frames a scene without one: it stands 1 / sin 22.5 degrees times the scene's radius away, and sees 45 degrees. */
static void frame_all(const ec_gltf *g, const ec_placement_list *list, eye *e)
{
    double low[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, high[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX}, radius = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const int32_t mesh = list->items[i].mesh;
        for (uint32_t k = 0; mesh >= 0 && k < g->meshes[mesh].primitive_count; k++) {
            const ec_gltf_primitive *p = &g->meshes[mesh].primitives[k];
            if (!ec_is_thin(p) && !p->drawn) continue;
            for (uint64_t v = p->lowest; v <= p->highest; v++) {
                double world[3];
                to_world(g, p, &list->items[i], (uint32_t)v, world);
                for (int axis = 0; axis < 3; axis++) low[axis] = fmin(low[axis], world[axis]), high[axis] = fmax(high[axis], world[axis]);
            }
        }
    }
    for (int axis = 0; axis < 3; axis++) radius += 0.25 * (high[axis] - low[axis]) * (high[axis] - low[axis]);
    const double half_angle = 0.39269908169872414;
    e->fixed = (radius > 0 ? sqrt(radius) : 1) / sin(half_angle) * 2 * tan(half_angle) / PICTURE_HEIGHT;
}

static double radius_at(const ec_gltf *g, const eye *e, const double world[3])
{
    double depth = 0;
    for (int k = 0; k < 3; k++) depth += (world[k] - e->position[k]) * e->forward[k];
    return 0.5 * g->point_size * (e->fixed + e->per_depth * fabs(depth));
}

static ec_result out_of_memory(const ec_gltf *g, ec_error *err) { return ec_fail(err, "%s: out of memory for points and lines", g->path); }

static ec_result allocate(ec_thick_mesh *m, uint64_t parts, ec_error *err)
{
    const uint64_t vertices = parts * ec_ball_vertices(m), indices = parts * ec_ball_indices(m);
    if (vertices > INT32_MAX || indices * 4 + vertices * 64 > ec_memory_of_machine())
        return ec_fail(err, "%s: %llu points or lines are too many to be made into surfaces", m->g->path, (unsigned long long)parts);
    bool ok = (m->indices = malloc((size_t)indices * sizeof *m->indices)) != NULL;
    for (int i = 0; i < EC_STREAMS; i++) {
        if (i == EC_TANGENT || (i > EC_NORMAL && m->from->streams.of[i] < 0)) continue;
        ok = (m->streams[i] = malloc((size_t)vertices * ec_stream_width[i] * sizeof(float))) != NULL && ok;
    }
    return ok ? EC_OK : out_of_memory(m->g, err);
}

static void free_mesh(ec_thick_mesh *m)
{
    free(m->indices);
    for (int i = 0; i < EC_STREAMS; i++) free(m->streams[i]);
}

/* Appends an accessor that owns the values; there must be room for it. */
static int32_t put_accessor(ec_gltf *g, void *values, uint64_t count, uint32_t type, uint32_t components)
{
    g->accessors[g->accessor_count] = (ec_gltf_accessor){.view = -1, .count = count, .component_type = type, .components = components, .open = true,
                                                         .data = values, .owned = values, .stride = 4 * components};
    return (int32_t)g->accessor_count++;
}

static ec_result finish(ec_gltf *g, ec_thick_mesh *m, ec_gltf_primitive *out, ec_error *err)
{
    ec_gltf_accessor *grown = realloc(g->accessors, ((size_t)g->accessor_count + EC_STREAMS + 1) * sizeof *grown);
    if (!grown) return out_of_memory(g, err);
    g->accessors = grown;
    *out = (ec_gltf_primitive){.mode = EC_GLTF_TRIANGLES, .material = m->from->material, .draco_view = -1, .prepared = true, .drawn = true,
                               .triangle_count = m->index_count / 3, .highest = (uint32_t)(m->vertex_count - 1)};
    out->indices = put_accessor(g, m->indices, m->index_count, EC_GLTF_UINT, 1);
    m->indices = NULL;
    for (int i = 0; i < EC_STREAMS; i++) {
        out->streams.of[i] = m->streams[i] ? put_accessor(g, m->streams[i], m->vertex_count, EC_GLTF_FLOAT, ec_stream_width[i]) : -1;
        m->streams[i] = NULL;
    }
    return EC_OK;
}

static ec_result thicken(ec_gltf *g, const ec_gltf_primitive *p, const ec_placement *at, const eye *e, ec_gltf_primitive *out, ec_error *err)
{
    const uint64_t parts = count_parts(g, p);
    ec_thick_mesh m = {.g = g, .from = p};
    ec_ball_choose(&m, g->point_size);
    ec_result result = allocate(&m, parts, err);
    for (uint64_t i = 0; result == EC_OK && i < parts; i++) {
        uint32_t vertices[2];
        double ends[2][3], radii[2];
        get_ends(g, p, i, parts, vertices);
        for (int end = 0; end < 2; end++) {
            to_world(g, p, at, vertices[end], ends[end]);
            radii[end] = radius_at(g, e, ends[end]);
            for (int k = 0; k < 3; k++) ends[end][k] -= at->origin[k]; /* relative, so that floats are precise far from the world's origin */
        }
        ec_ball_append(&m, (const double(*)[3])ends, radii, vertices);
    }
    if (result == EC_OK) result = finish(g, &m, out, err);
    free_mesh(&m);
    return result;
}

static bool has_thin(const ec_gltf *g, int32_t mesh)
{
    for (uint32_t k = 0; mesh >= 0 && k < g->meshes[mesh].primitive_count; k++)
        if (ec_is_thin(&g->meshes[mesh].primitives[k]) && count_parts(g, &g->meshes[mesh].primitives[k])) return true;
    return false;
}

/* Adds a mesh beside the one that is placed, with axes of the world: balls stay round whatever the node's matrix. */
static ec_result visit(ec_gltf *g, ec_placement_list *list, uint32_t index, const eye *e, bool moving, ec_error *err)
{
    const ec_placement at = list->items[index];
    if (moving && !at.moves) return ec_placement_append(list, &(ec_placement){.node = at.node, .mesh = -1, .extra = true}, err);
    ec_gltf_mesh *grown = realloc(g->meshes, ((size_t)g->mesh_count + 1) * sizeof *grown);
    if (grown) g->meshes = grown;
    const ec_gltf_mesh *from = &g->meshes[at.mesh];
    ec_gltf_primitive *primitives = malloc(from->primitive_count * sizeof *primitives + 1);
    if (!grown || !primitives) {
        free(primitives);
        return out_of_memory(g, err);
    }
    ec_gltf_mesh *mesh = &g->meshes[g->mesh_count];
    *mesh = (ec_gltf_mesh){.primitives = primitives};
    ec_placement here = {.node = at.node, .mesh = (int32_t)g->mesh_count++, .linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .reached = g->animated != NULL,
                         .moves = at.moves, .extra = true};
    for (int k = 0; k < 3; k++) here.origin[k] = at.origin[k];
    for (uint32_t k = 0; k < from->primitive_count; k++)
        if (ec_is_thin(&from->primitives[k]) && count_parts(g, &from->primitives[k])) {
            EC_TRY(thicken(g, &from->primitives[k], &at, e, &primitives[mesh->primitive_count], err));
            mesh->primitive_count++;
        }
    return ec_placement_append(list, &here, err);
}

ec_result ec_gltf_thicken(ec_gltf *g, ec_placement_list *list, bool moving, ec_error *err)
{
    eye e = {.fixed = 0};
    bool any = false;
    for (uint32_t i = 0; i < list->count; i++) any = any || has_thin(g, list->items[i].mesh);
    if (!any) return EC_OK;
    if (!look_through(g, list, &e)) frame_all(g, list, &e);
    for (uint32_t i = 0, count = list->count; i < count; i++)
        if (has_thin(g, list->items[i].mesh)) EC_TRY(visit(g, list, i, &e, moving, err));
    return EC_OK;
}
