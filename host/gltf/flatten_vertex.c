/* Copies one vertex with its streams from a primitive's accessors to the scene's arrays. */
#include "gltf/flatten_vertex.h"

#include <math.h>
#include <string.h>

static void multiply(const double m[9], const float v[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}

void ec_draw_world_position(const ec_draw *d, uint32_t vertex, double out[3])
{
    float local[3];
    ec_gltf_accessor_floats(&d->g->accessors[d->p->streams.of[EC_POSITION]], vertex, 3, local);
    multiply(d->at->linear, local, out);
    for (int i = 0; i < 3; i++) out[i] += d->at->origin[i];
}

/* Stores v at unit length, or zero if that is impossible. */
static void store_direction(const double v[3], float out[3])
{
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    bool usable = largest > 0 && isfinite(largest) && isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
    double x = v[0] / largest, y = v[1] / largest, z = v[2] / largest;
    double length = sqrt(x * x + y * y + z * z);
    out[0] = usable ? (float)(x / length) : 0;
    out[1] = usable ? (float)(y / length) : 0;
    out[2] = usable ? (float)(z / length) : 0;
}

void ec_draw_frame(const ec_draw *d, uint32_t vertex, float *normal, float *tangent)
{
    float in[4];
    double turned[3];
    if (normal && d->p->streams.of[EC_NORMAL] >= 0) {
        ec_gltf_accessor_floats(&d->g->accessors[d->p->streams.of[EC_NORMAL]], vertex, 3, in);
        multiply(d->normal_matrix, in, turned);
        store_direction(turned, normal);
    }
    if (tangent && d->p->streams.of[EC_TANGENT] >= 0 && d->p->streams.of[EC_NORMAL] >= 0) { /* glTF: tangents without normals are ignored */
        ec_gltf_accessor_floats(&d->g->accessors[d->p->streams.of[EC_TANGENT]], vertex, 4, in);
        multiply(d->at->linear, in, turned);
        store_direction(turned, tangent);
        bool usable = tangent[0] != 0 || tangent[1] != 0 || tangent[2] != 0;
        /* the bitangent is mirrored with the mesh, but n x t is not */
        tangent[3] = !usable ? 0 : (in[3] < 0) != d->mirrored ? -1.0f : 1.0f;
    }
}

/* Returns the index of the mesh in the file, also for a deformed copy. */
static int32_t file_mesh(const ec_draw *d) { return d->mesh < (int32_t)d->g->stored_meshes ? d->mesh : d->g->nodes[d->at->node].mesh; }

/* Counts normals that are NaN or infinite. */
static void count_odd_normal(struct ec_odd_values *odd, const ec_draw *d, uint32_t vertex)
{
    float in[3];
    if (d->p->streams.of[EC_NORMAL] < 0) return;
    ec_gltf_accessor_floats(&d->g->accessors[d->p->streams.of[EC_NORMAL]], vertex, 3, in);
    if (isfinite(in[0]) && isfinite(in[1]) && isfinite(in[2])) return;
    if (!odd->count++) odd->mesh = file_mesh(d);
}

/* Stores values clamped to low..high; NaN becomes 0. */
static void store_values(struct ec_odd_values *odd, const ec_draw *d, int32_t accessor, uint32_t vertex, uint32_t count,
                         float low, float high, float *out)
{
    if (accessor < 0) return;
    ec_gltf_accessor_floats(&d->g->accessors[accessor], vertex, count, out);
    for (uint32_t i = 0; i < count; i++) {
        if (out[i] >= low && out[i] <= high) continue;
        out[i] = isnan(out[i]) ? 0 : out[i] < low ? low : high;
        if (!odd->count++) odd->mesh = file_mesh(d);
    }
}

uint32_t ec_flattener_append_vertex(ec_flattener *f, const ec_draw *d, uint32_t vertex, const float position[3])
{
    ec_scene *s = f->scene;
    size_t n = s->vertex_count++;
    memcpy(s->positions + 3 * n, position, 3 * sizeof(float));
    float *normal = s->normals ? s->normals + 3 * n : NULL, *tangent = s->tangents ? s->tangents + 4 * n : NULL;
    if (normal) memset(normal, 0, 3 * sizeof(float));
    if (tangent) memset(tangent, 0, 4 * sizeof(float));
    ec_draw_frame(d, vertex, normal, tangent);
    if (normal) count_odd_normal(&f->odd_normals, d, vertex);
    for (int i = 0; i < 2; i++) {
        if (!s->uv[i]) continue;
        memset(s->uv[i] + 2 * n, 0, 2 * sizeof(float));
        store_values(&f->odd_uv, d, d->p->streams.of[EC_UV + i], vertex, 2, -EC_UV_MOST, EC_UV_MOST, s->uv[i] + 2 * n);
    }
    if (s->colors) {
        for (int i = 0; i < 4; i++) s->colors[4 * n + (size_t)i] = 1;
        uint32_t components = d->p->streams.of[EC_COLOR] >= 0 ? d->g->accessors[d->p->streams.of[EC_COLOR]].components : 0;
        store_values(&f->odd_colors, d, d->p->streams.of[EC_COLOR], vertex, components, 0, 1, s->colors + 4 * n);
    }
    return (uint32_t)n;
}
