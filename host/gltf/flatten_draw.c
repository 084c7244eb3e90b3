/* Draws one primitive at one place: counts how much geometry it can have at most, and appends its triangles that have an area. */
#include "gltf/flatten_vertex.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/vec3.h"

#define NO_VERTEX UINT32_MAX

ec_draw ec_draw_of(const ec_gltf *g, const ec_placement *at, const double *center)
{
    ec_draw d = {.g = g, .at = at, .center = center};
    ec_gltf_normal_matrix(at->linear, d.normal_matrix);
    d.mirrored = ec_gltf_determinant(at->linear) < 0;
    return d;
}

ec_result ec_flattener_draw(ec_flattener *f, const ec_gltf *g, int32_t mesh, const ec_placement *at, const double *center,
                            ec_draw_function function)
{
    ec_draw d = ec_draw_of(g, at, center);
    d.mesh = mesh;
    for (uint32_t k = 0; k < g->meshes[mesh].primitive_count; k++) {
        d.p = &g->meshes[mesh].primitives[k];
        if (d.p->drawn) EC_TRY(function(f, &d));
    }
    return EC_OK;
}

bool ec_is_placeable(const double world[3][3])
{
    for (int i = 0; i < 9; i++)
        if (!(fabs(world[i / 3][i % 3]) < EC_MAX_COORDINATE)) return false;
    return true;
}

bool ec_draw_corners(const ec_draw *d, uint64_t triangle, uint32_t vertices[3], double world[3][3])
{
    ec_gltf_primitive_triangle(d->g, d->p, triangle, vertices);
    for (int i = 0; i < 3; i++) ec_draw_world_position(d, vertices[i], world[i]);
    return ec_is_placeable((const double(*)[3])world);
}

ec_result ec_flattener_count(ec_flattener *f, const ec_draw *d)
{
    uint64_t range = (uint64_t)d->p->highest - d->p->lowest + 1, corners = 3 * d->p->triangle_count;
    f->triangle_bound += d->p->triangle_count;
    f->vertex_bound += range < corners ? range : corners;
    if (f->triangle_bound > INT32_MAX || f->vertex_bound > INT32_MAX)
        return ec_fail(f->err, "%s: more than %d triangles or vertices with all instances counted; simplify the scene",
                       d->g->path, INT32_MAX);
    if (range > f->remap_size) f->remap_size = range;
    for (int i = 0; i < EC_STREAMS; i++) /* glTF: tangents without normals are ignored */
        f->streams |= (unsigned)(d->p->streams.of[i] >= 0 && (i != EC_TANGENT || d->p->streams.of[EC_NORMAL] >= 0)) << i;
    return EC_OK;
}

void ec_draw_span(const ec_draw *d, double low[3], double high[3])
{
    for (uint64_t t = 0; t < d->p->triangle_count; t++) {
        uint32_t v[3];
        double world[3][3];
        if (!ec_draw_corners(d, t, v, world)) continue;
        for (int i = 0; i < 9; i++) {
            low[i % 3] = fmin(low[i % 3], world[i / 3][i % 3]);
            high[i % 3] = fmax(high[i % 3], world[i / 3][i % 3]);
        }
    }
}

static double largest_component(const double v[3])
{
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

/* Tells whether the corners are collinear as stored in the file: rounding after the transform could give such a triangle a meaningless area. */
static bool is_flat_in_file(const ec_draw *d, const uint32_t v[3])
{
    float local[3][3];
    double normal[3];
    for (int i = 0; i < 3; i++) ec_gltf_accessor_floats(&d->g->accessors[d->p->streams.of[EC_POSITION]], v[i], 3, local[i]);
    ec_triangle_normal(local[0], local[1], local[2], normal);
    return largest_component(normal) == 0;
}

/* Tells whether a triangle has an area that floats can express; if not, it is counted and will be left out. */
static bool is_drawable(ec_flattener *f, const ec_draw *d, const uint32_t v[3], float position[3][3])
{
    double normal[3];
    ec_triangle_normal(position[0], position[1], position[2], normal);
    double size = largest_component(normal);
    bool finite = isfinite((float)size);
    for (int i = 0; i < 9; i++) finite = finite && fabs((double)position[i / 3][i % 3]) < EC_MAX_COORDINATE;
    if (!finite) {
        f->scene->dropped_nonfinite++;
        return false;
    }
    if (d->at->moves) return true; /* it may have an area at another moment: motion.c looks at all of them */
    if (size < FLT_MIN || is_flat_in_file(d, v)) {
        f->scene->dropped_degenerate++;
        return false;
    }
    return true;
}

ec_result ec_flattener_fill(ec_flattener *f, const ec_draw *d)
{
    ec_scene *s = f->scene;
    if (f->node >= 0) ec_part_add(s, s->triangle_count, (uint32_t)f->node);
    memset(f->remap, 0xff, ((uint64_t)d->p->highest - d->p->lowest + 1) * sizeof *f->remap);
    for (uint64_t t = 0; t < d->p->triangle_count; t++) {
        uint32_t v[3];
        float position[3][3];
        double world[3][3];
        ec_draw_corners(d, t, v, world); /* corners that are not numbers are counted by is_drawable */
        for (int i = 0; i < 9; i++) position[i / 3][i % 3] = (float)(world[i / 3][i % 3] - d->center[i % 3]);
        if (!is_drawable(f, d, v, position)) continue;
        size_t n = s->triangle_count++;
        for (int i = 0; i < 3; i++) {
            uint32_t *known = &f->remap[v[i] - d->p->lowest];
            if (*known == NO_VERTEX) {
                if (f->sources)
                    f->sources[s->vertex_count] =
                        (ec_source){f->placement, (uint32_t)(d->p - d->g->meshes[d->at->mesh].primitives), v[i]};
                *known = ec_flattener_append_vertex(f, d, v[i], position[i]);
            }
            /* triangles of a mirrored mesh are reversed, so that its front stays its front */
            s->indices[3 * n + (size_t)(d->mirrored && i ? 3 - i : i)] = *known;
        }
        s->triangle_material[n] = d->p->scene_material;
    }
    return EC_OK;
}
