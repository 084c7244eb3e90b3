/* Arrays of vertices and triangles, which grow with a scene. */
#include "scene/scene.h"

#include <stdlib.h>

static float **stream_at(ec_scene *s, int stream)
{
    float **const all[EC_STREAMS] = {&s->positions, &s->normals, &s->tangents, &s->colors, &s->uv[0], &s->uv[1]};
    return all[stream];
}

bool ec_scene_allocate(ec_scene *s, unsigned streams, size_t vertices, size_t triangles)
{
    s->indices = malloc(triangles * 3 * sizeof *s->indices);
    s->triangle_material = malloc(triangles * sizeof *s->triangle_material);
    bool ok = s->indices && s->triangle_material;
    for (int i = 0; i < EC_STREAMS; i++) {
        bool wanted = streams >> i & 1;
        float *stream = wanted ? malloc(vertices * ec_stream_width[i] * sizeof *stream) : NULL;
        *stream_at(s, i) = stream;
        ok = ok && (stream || !wanted);
    }
    return ok;
}

static void *shrink(void *block, size_t size)
{
    void *smaller = block ? realloc(block, size) : NULL;
    return smaller ? smaller : block;
}

void ec_scene_trim(ec_scene *s)
{
    for (int i = 0; i < EC_STREAMS; i++)
        *stream_at(s, i) = shrink(*stream_at(s, i), (size_t)s->vertex_count * ec_stream_width[i] * sizeof(float));
    s->indices = shrink(s->indices, (size_t)s->triangle_count * 3 * sizeof *s->indices);
    s->triangle_material = shrink(s->triangle_material, (size_t)s->triangle_count * sizeof *s->triangle_material);
}

void ec_scene_free_geometry(ec_scene *s)
{
    for (int i = 0; i < EC_STREAMS; i++) {
        free(*stream_at(s, i));
        *stream_at(s, i) = NULL;
    }
    free(s->indices);
    free(s->triangle_material);
    s->indices = s->triangle_material = NULL;
}
