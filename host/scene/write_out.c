/* Writes out an instanced scene as triangles, corner for corner as rays meet it. */
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static void write_vertices(const ec_scene *s, const ec_placed *p, ec_scene *w)
{
    const ec_shape *shape = &s->shapes[p->shape];
    const size_t from = shape->first_vertex, to = w->vertex_count, n = shape->vertex_count;
    for (size_t i = 0; i < n; i++) {
        ec_placed_point(p, s->positions + 3 * (from + i), w->positions + 3 * (to + i));
        if (s->normals) ec_placed_normal(p, s->normals + 3 * (from + i), w->normals + 3 * (to + i));
        if (s->tangents) ec_placed_tangent(p, s->tangents + 4 * (from + i), w->tangents + 4 * (to + i));
    }
    for (int k = EC_COLOR; k < EC_STREAMS; k++) {
        const size_t width = ec_stream_width[k];
        if (ec_scene_stream(s, k)) memcpy(ec_scene_stream(w, k) + width * to, ec_scene_stream(s, k) + width * from, width * n * sizeof(float));
    }
}

static void write_triangles(const ec_scene *s, const ec_placed *p, ec_scene *w)
{
    const ec_shape *shape = &s->shapes[p->shape];
    for (uint32_t t = 0; t < shape->count; t++) {
        const uint32_t *from = s->indices + 3 * ((size_t)shape->first + t);
        uint32_t *to = w->indices + 3 * ((size_t)w->triangle_count + t);
        for (int k = 0; k < 3; k++) to[k] = from[p->mirrored && k ? 3 - k : k] - shape->first_vertex + w->vertex_count;
        const float *a = w->positions + 3 * (size_t)to[0], *b = w->positions + 3 * (size_t)to[1],
                    *c = w->positions + 3 * (size_t)to[2];
        if (ec_placed_is_flat(a, b, c)) to[1] = to[2] = to[0]; /* a single point: no ray meets it */
        w->triangle_material[w->triangle_count + t] = s->triangle_material[shape->first + t];
    }
}

static bool allocate(const ec_scene *s, size_t vertices, size_t triangles, ec_scene *w)
{
    unsigned streams = 0;
    for (int k = 0; k < EC_STREAMS; k++) streams |= (unsigned)(ec_scene_stream(s, k) != NULL) << k;
    return ec_scene_allocate(w, streams, vertices, triangles);
}

static void copy_flat(const ec_scene *s, uint32_t triangles, uint32_t vertices, ec_scene *w)
{
    memcpy(w->indices, s->indices, (size_t)triangles * 12);
    memcpy(w->triangle_material, s->triangle_material, (size_t)triangles * 4);
    for (int k = 0; k < EC_STREAMS; k++)
        if (ec_scene_stream(s, k)) memcpy(ec_scene_stream(w, k), ec_scene_stream(s, k), (size_t)vertices * ec_stream_width[k] * sizeof(float));
    w->triangle_count = triangles;
    w->vertex_count = vertices;
}

ec_result ec_scene_write_out(const ec_scene *s, ec_scene *w, ec_error *err)
{
    uint32_t flat_vertices = s->shape_count ? s->shapes[0].first_vertex : s->vertex_count;
    uint64_t triangles = ec_scene_met_count(s), vertices = flat_vertices;
    for (uint32_t i = 0; i < s->placed_count; i++) vertices += s->shapes[s->placed[i].shape].vertex_count;
    *w = *s;
    w->shapes = NULL;
    w->placed = NULL;
    w->shape_count = w->placed_count = 0;
    /* 200 bytes per triangle is a low estimate, as an accelerator takes more than the triangles themselves. */
    uint64_t memory = ec_memory_of_machine(), needed = triangles * 200;
    bool fits = triangles <= INT32_MAX && vertices <= INT32_MAX && needed <= memory;
    if (!allocate(s, fits ? vertices + 1 : 0, fits ? triangles + 1 : 0, w) || !fits) {
        ec_scene_written_free(w);
        return ec_fail(err, "%llu triangles of %u expanded instances need %llu MB, but this machine has %llu MB; leave --accel out or use "
                       "twolevel, which keeps each mesh once", (unsigned long long)triangles, s->placed_count,
                       (unsigned long long)(needed >> 20), (unsigned long long)(memory >> 20));
    }
    copy_flat(s, ec_scene_flat_count(s), flat_vertices, w);
    for (uint32_t i = 0; i < s->placed_count; i++) {
        write_vertices(s, &s->placed[i], w);
        write_triangles(s, &s->placed[i], w);
        w->vertex_count += s->shapes[s->placed[i].shape].vertex_count;
        w->triangle_count += s->shapes[s->placed[i].shape].count;
    }
    return EC_OK;
}

void ec_scene_written_free(ec_scene *w)
{
    ec_scene_free_geometry(w);
    *w = (ec_scene){0};
}
