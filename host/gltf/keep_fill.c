/* Writes the triangles of kept meshes, once each, and the matrices of their places. */
#include "gltf/keep.h"

#include <float.h>
#include <math.h>

#include "base/freed.h"

#define EACH_KEPT(k, m) \
    for (ec_kept_mesh *m = (k)->meshes; (k)->is_kept && m < (k)->meshes + (k)->mesh_count; m++) \
        if (m->is_kept)

/* Returns the mesh's centre. A mesh may be far from its own origin; relative to its centre, floats keep its digits. */
static void center_of(const ec_kept_mesh *m, double center[3])
{
    for (int k = 0; k < 3; k++) center[k] = 0.5 * (m->low[k] + m->high[k]);
}

ec_result ec_keep_count(const ec_keeping *k, ec_flattener *f)
{
    EACH_KEPT(k, m) EC_TRY(ec_flattener_draw(f, k->g, m->mesh, &ec_at_home, ec_at_home.origin, ec_flattener_count));
    return EC_OK;
}

typedef struct points {
    float *at; /* 3 floats per point */
    uint64_t count;
} points;

/* Collects every vertex of a finite triangle once. */
static void gather(const ec_draw *d, bool *seen, points *out)
{
    memset(seen, 0, (size_t)d->p->highest - d->p->lowest + 1);
    for (uint64_t t = 0; t < d->p->triangle_count; t++) {
        uint32_t v[3];
        double corner[3][3];
        if (!ec_draw_corners(d, t, v, corner)) continue;
        for (int c = 0; c < 3; c++) {
            if (seen[v[c] - d->p->lowest]) continue;
            seen[v[c] - d->p->lowest] = true;
            for (int k = 0; k < 3; k++) out->at[3 * out->count + (uint64_t)k] = (float)corner[c][k];
            out->count++;
        }
    }
}

static ec_result gather_mesh(const ec_gltf *g, int32_t mesh, points *out, ec_error *err)
{
    uint64_t most = 0, longest = 1;
    const ec_gltf_mesh *m = &g->meshes[mesh];
    for (uint32_t i = 0; i < m->primitive_count; i++) {
        uint64_t range = m->primitives[i].drawn ? (uint64_t)m->primitives[i].highest - m->primitives[i].lowest + 1 : 0;
        most += range;
        if (range > longest) longest = range;
    }
    EC_FREED bool *seen = malloc(longest);
    *out = (points){.at = malloc((most + 1) * 3 * sizeof(float))};
    if (!seen || !out->at) return ec_fail(err, "%s: out of memory for the vertices of meshes[%d]", g->path, mesh);
    ec_draw d = ec_draw_of(g, &ec_at_home, NULL);
    for (d.p = m->primitives; d.p < m->primitives + m->primitive_count; d.p++)
        if (d.p->drawn) gather(&d, seen, out);
    return EC_OK;
}

/* Tells whether the mesh's box reaches beyond the box that is known to be occupied. */
static bool may_grow(const ec_kept_mesh *m, const ec_placement *at, const double low[3], const double high[3])
{
    for (int row = 0; row < 3; row++) {
        double middle = at->origin[row], half = 0;
        for (int k = 0; k < 3; k++) {
            middle += at->linear[3 * row + k] * 0.5 * (m->low[k] + m->high[k]);
            half += fabs(at->linear[3 * row + k]) * 0.5 * (m->high[k] - m->low[k]);
        }
        half += 1e-12 * (fabs(middle) + half);
        if (middle - half < low[row] || middle + half > high[row]) return true;
    }
    return false;
}

/* Grows the box by the mesh's vertices at a place, with the values that written-out triangles would have, so that the centre and cameras that frame
 * the scene are the same. */
static void measure_place(const points *p, const ec_placement *at, double low[3], double high[3])
{
    const double *m = at->linear;
    for (uint64_t i = 0; i < p->count; i++) {
        const float *v = p->at + 3 * i;
        for (int row = 0; row < 3; row++) {
            double x = m[3 * row] * v[0] + m[3 * row + 1] * v[1] + m[3 * row + 2] * v[2];
            x += at->origin[row];
            low[row] = x < low[row] ? x : low[row];
            high[row] = x > high[row] ? x : high[row];
        }
    }
}

ec_result ec_keep_measure(const ec_keeping *k, ec_flattener *f)
{
    EACH_KEPT(k, m) {
        points p;
        ec_result result = gather_mesh(k->g, m->mesh, &p, f->err);
        for (uint32_t i = 0; result == EC_OK && i < k->placements->count; i++) {
            const ec_placement *at = &k->placements->items[i];
            if (!k->is_kept[i] || k->candidate[i] != m - k->meshes || !may_grow(m, at, f->low, f->high)) continue;
            measure_place(&p, at, f->low, f->high);
        }
        free(p.at);
        EC_TRY(result);
    }
    return EC_OK;
}

static ec_result fill_shape(ec_keeping *k, ec_kept_mesh *m, ec_flattener *f)
{
    ec_scene *s = f->scene;
    double center[3];
    center_of(m, center);
    ec_shape shape = {.first = s->triangle_count, .first_vertex = s->vertex_count};
    m->dropped_degenerate = s->dropped_degenerate;
    m->dropped_nonfinite = s->dropped_nonfinite;
    EC_TRY(ec_flattener_draw(f, k->g, m->mesh, &ec_at_home, center, ec_flattener_fill));
    m->dropped_degenerate = s->dropped_degenerate - m->dropped_degenerate;
    m->dropped_nonfinite = s->dropped_nonfinite - m->dropped_nonfinite;
    /* written out, they would have been dropped at every place */
    s->dropped_degenerate += m->dropped_degenerate * (m->places - 1);
    s->dropped_nonfinite += m->dropped_nonfinite * (m->places - 1);
    shape.count = s->triangle_count - shape.first;
    shape.vertex_count = s->vertex_count - shape.first_vertex;
    m->is_kept = shape.count > 0;
    m->shape = s->shape_count;
    if (m->is_kept) s->shapes[s->shape_count++] = shape;
    return EC_OK;
}

static ec_placed place(const ec_kept_mesh *m, const ec_placement *at, const double scene_center[3])
{
    ec_placed p = {.shape = m->shape, .mirrored = ec_gltf_determinant(at->linear) < 0};
    double center[3], normal[9], largest = 0;
    center_of(m, center);
    ec_gltf_normal_matrix(at->linear, normal);
    for (int i = 0; i < 9; i++) largest = fmax(largest, fabs(normal[i]));
    for (int row = 0; row < 3; row++) {
        double origin = at->origin[row] - scene_center[row];
        for (int k = 0; k < 3; k++) {
            origin += at->linear[3 * row + k] * center[k];
            p.place[row][k] = (float)at->linear[3 * row + k];
            p.normal[row][k] = (float)(normal[3 * row + k] / largest);
        }
        p.place[row][3] = (float)origin;
    }
    return p;
}

/* Returns the largest intermediate sum when a corner is placed, which bounds its rounding. */
static double reach_of(const ec_kept_mesh *m, const ec_placed *p)
{
    double most = 0;
    for (int row = 0; row < 3; row++) {
        double sum = fabs(p->place[row][3]);
        for (int k = 0; k < 3; k++) sum += fabs(p->place[row][k]) * 0.5 * (m->high[k] - m->low[k]);
        most = fmax(most, sum);
    }
    return most;
}

/* Extends the scene's bounds: placed corners in float lie outside what was measured in double by at most the rounding of the matrix, the corner and
 * three fma. */
static void bound(ec_scene *s, const ec_flattener *f, double reach)
{
    for (int k = 0; k < 3; k++) {
        double low = f->low[k] - s->center[k], high = f->high[k] - s->center[k];
        s->bounds_min[k] = fminf(s->bounds_min[k], (float)(low - 4 * FLT_EPSILON * reach));
        s->bounds_max[k] = fmaxf(s->bounds_max[k], (float)(high + 4 * FLT_EPSILON * reach));
    }
}

ec_result ec_keep_fill(ec_keeping *k, ec_flattener *f)
{
    ec_scene *s = f->scene;
    if (!k->is_kept) return EC_OK;
    uint32_t places = 0;
    EACH_KEPT(k, m) places += m->places;
    s->shapes = malloc(((size_t)k->mesh_count + 1) * sizeof *s->shapes);
    s->placed = malloc(((size_t)places + 1) * sizeof *s->placed);
    if (!s->shapes || !s->placed) return ec_fail(f->err, "%s: out of memory for %u instances", k->g->path, places);
    EACH_KEPT(k, m) EC_TRY(fill_shape(k, m, f));
    uint64_t id = ec_scene_flat_count(s);
    double reach = 0;
    for (uint32_t i = 0; i < k->placements->count; i++) {
        if (!k->is_kept[i] || !k->meshes[k->candidate[i]].is_kept) continue;
        ec_placed one = place(&k->meshes[k->candidate[i]], &k->placements->items[i], s->center);
        one.id = (uint32_t)id;
        reach = fmax(reach, reach_of(&k->meshes[k->candidate[i]], &one));
        id += s->shapes[one.shape].count;
        if (id >= UINT32_MAX)
            return ec_fail(f->err, "%s: more than %u triangles with all instances counted; simplify the scene",
                           k->g->path, UINT32_MAX - 1);
        s->placed[s->placed_count++] = one;
        ec_part_add(s, one.id, (uint32_t)k->placements->items[i].node);
    }
    s->whole = s->placed_count > 0;
    bound(s, f, reach);
    return EC_OK;
}
