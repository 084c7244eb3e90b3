#include "scene/ground.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/material_fields.h"

enum { VERTICES = 4, TRIANGLES = 2 };
static const double hair = 1e-4; /* of the scene's radius: distance to what stands on the ground, so that the two do not coincide */

/* Inserts room for `more` elements after `before` of `count`, moving up the rest. */
static bool widen(void **array, size_t size, size_t count, size_t before, size_t more)
{
    if (!*array && count) return true; /* the stream does not exist */
    char *wide = realloc(*array, size * (count + more));
    if (!wide) return false;
    memmove(wide + size * (before + more), wide + size * before, size * (count - before));
    *array = wide;
    return true;
}

/* Returns the number of vertices in the world, corresponding to ec_scene_flat_count. */
static uint32_t flat_vertices(const ec_scene *s) { return s->shape_count ? s->shapes[0].first_vertex : s->vertex_count; }

static bool make_room(ec_scene *s)
{
    bool made = true;
    float **const streams[EC_STREAMS] = {&s->positions, &s->normals, &s->tangents, &s->colors, &s->uv[0], &s->uv[1]};
    for (int k = 0; k < EC_STREAMS; k++)
        made = made && widen((void **)streams[k], ec_stream_width[k] * sizeof(float), s->vertex_count, flat_vertices(s), VERTICES);
    const uint32_t flat = ec_scene_flat_count(s);
    return made && widen((void **)&s->indices, 3 * sizeof *s->indices, s->triangle_count, flat, TRIANGLES) &&
           widen((void **)&s->triangle_material, sizeof *s->triangle_material, s->triangle_count, flat, TRIANGLES) &&
           widen((void **)&s->materials, sizeof *s->materials, s->material_count, s->material_count, 1) &&
           (!s->parts || widen((void **)&s->parts, sizeof *s->parts, s->part_count, s->part_count, 2));
}

/* Adapts shapes and placed triangles; to be called once there is room. */
static void move_placed(ec_scene *s)
{
    if (!s->shape_count) return;
    for (size_t i = 3 * ((size_t)s->shapes[0].first + TRIANGLES); i < 3 * ((size_t)s->triangle_count + TRIANGLES); i++) s->indices[i] += VERTICES;
    for (uint32_t i = 0; i < s->shape_count; i++) s->shapes[i].first += TRIANGLES, s->shapes[i].first_vertex += VERTICES;
    for (uint32_t i = 0; i < s->placed_count; i++) s->placed[i].id += TRIANGLES;
}

/* Inserts a part without a node for the ground into the list of triangles' nodes. */
static void move_parts(ec_scene *s, uint32_t ground)
{
    uint32_t k = s->part_count;
    if (!s->part_count) return;
    for (; k > 0 && s->parts[k - 1].first >= ground; k--) s->parts[k] = (ec_part){s->parts[k - 1].first + TRIANGLES, s->parts[k - 1].node};
    s->parts[k] = (ec_part){ground, EC_NO_NODE};
    s->part_count++;
}

static ec_material matte(void)
{
    ec_material m = ec_material_default();
    for (int k = 0; k < 3; k++) m.base_color[k] = 0.5f;
    m.metallic = m.specular = 0;
    m.double_sided = true; /* no light comes from below, whichever side is seen */
    m.name = strdup("ground");
    return m;
}

/* Gets the box above the ground: that of the scene, or of its whole animation. Recentred. */
static void box_of(const ec_scene *s, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = s->spans ? s->span_min[k] - s->center[k] : s->bounds_min[k];
        high[k] = s->spans ? s->span_max[k] - s->center[k] : s->bounds_max[k];
    }
}

ec_result ec_scene_add_ground(ec_scene *s, ec_error *err)
{
    const uint32_t first = flat_vertices(s), flat = ec_scene_flat_count(s);
    double half = 0, low[3], high[3];
    if (!s->triangle_count) return ec_fail(err, "--ground: the scene has no surface to stand on one; leave it out");
    box_of(s, low, high);
    for (int k = 0; k < 3; k++) half = fma(0.25 * (high[k] - low[k]), high[k] - low[k], half);
    half = sqrt(half);
    if (!make_room(s)) return ec_fail(err, "out of memory for a ground");
    const float y = (float)(low[1] - hair * half), reach = (float)(EC_GROUND_REACH * half);
    const float middle[] = {0.5f * ((float)low[0] + (float)high[0]), y, 0.5f * ((float)low[2] + (float)high[2])};
    for (uint32_t v = 0; v < VERTICES; v++) {
        const float x = v & 1 ? reach : -reach, z = v & 2 ? reach : -reach;
        const float at[] = {middle[0] + x, y, middle[2] + z}, up[] = {0, 1, 0};
        memcpy(s->positions + 3 * ((size_t)first + v), at, sizeof at);
        if (s->normals) memcpy(s->normals + 3 * ((size_t)first + v), up, sizeof up);
        if (s->tangents) memset(s->tangents + 4 * ((size_t)first + v), 0, 4 * sizeof(float));
        for (size_t k = 0; s->colors && k < 4; k++) s->colors[4 * ((size_t)first + v) + k] = 1;
        for (int k = 0; k < 2; k++)
            if (s->uv[k]) memset(s->uv[k] + 2 * ((size_t)first + v), 0, 2 * sizeof(float));
    }
    const uint32_t corners[] = {first, first + 2, first + 1, first + 1, first + 2, first + 3};
    memcpy(s->indices + 3 * (size_t)flat, corners, sizeof corners);
    s->triangle_material[flat] = s->triangle_material[flat + 1] = s->material_count;
    s->materials[s->material_count++] = matte();
    move_placed(s);
    s->vertex_count += VERTICES;
    s->triangle_count += TRIANGLES;
    move_parts(s, flat);
    for (int k = 0; k < 3; k += 2) {
        s->bounds_min[k] = middle[k] - reach;
        s->bounds_max[k] = middle[k] + reach;
    }
    s->bounds_min[1] = y;
    return EC_OK;
}
