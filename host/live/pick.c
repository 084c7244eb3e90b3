/* Finds the surface under a pixel by testing one ray against all triangles: some milliseconds per million, and no structure to keep. */
#include <math.h>
#include <stdlib.h>

#include "device/pipeline.h"
#include "live/shared.h"

typedef struct ray {
    double o[3], d[3]; /* d: unit */
} ray;

/* Returns the ray through the pixel's centre, as in kernels/stages/generate.cl. */
static ray ray_of(const ec_camera *c, const ec_render_options *o, uint32_t x, uint32_t y)
{
    ec_params p;
    ec_pipeline_set_view(c, o, &p);
    const double sx = p.screen[0] + (x + 0.5) * p.screen[2], sy = p.screen[1] + (y + 0.5) * p.screen[3];
    double length = 0;
    ray r;
    for (int k = 0; k < 3; k++) {
        double aside = sx * p.camera_right[k] + sy * p.camera_up[k];
        r.o[k] = p.camera_origin[k] + (p.orthographic ? aside : 0);
        r.d[k] = p.camera_forward[k] + (p.orthographic ? 0 : aside);
        length += r.d[k] * r.d[k];
    }
    for (int k = 0; k < 3; k++) r.d[k] /= sqrt(length);
    return r;
}

/* Returns the distance (Moeller and Trumbore 1997); infinite if the ray misses. */
static double meet(const ray *r, const float *a, const float *b, const float *c)
{
    double e[3], f[3], p[3], s[3], q[3], det = 0, u = 0, v = 0, t = 0;
    for (int k = 0; k < 3; k++) e[k] = (double)b[k] - a[k], f[k] = (double)c[k] - a[k], s[k] = r->o[k] - a[k];
    for (int k = 0; k < 3; k++) p[k] = r->d[(k + 1) % 3] * f[(k + 2) % 3] - r->d[(k + 2) % 3] * f[(k + 1) % 3];
    for (int k = 0; k < 3; k++) q[k] = s[(k + 1) % 3] * e[(k + 2) % 3] - s[(k + 2) % 3] * e[(k + 1) % 3];
    for (int k = 0; k < 3; k++) det += e[k] * p[k], u += s[k] * p[k], v += r->d[k] * q[k], t += f[k] * q[k];
    u /= det, v /= det, t /= det;
    return det != 0 && u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : INFINITY;
}

static void try_triangles(const ec_scene *s, const ray *r, uint32_t first, uint32_t count, const ec_placed *placed,
                          ec_live_hit *best)
{
    ec_live_hit hit = *best;
    for (uint32_t t = first; t < first + count; t++) {
        const float *corner[3];
        float moved[3][3];
        for (int k = 0; k < 3; k++) {
            corner[k] = s->positions + 3 * (size_t)s->indices[3 * (size_t)t + k];
            if (!placed) continue;
            ec_placed_point(placed, corner[k], moved[k]);
            corner[k] = moved[k];
        }
        double distance = meet(r, corner[0], corner[1], corner[2]);
        if (distance < hit.distance) hit = (ec_live_hit){distance, t, placed ? placed->id + t - first : t};
    }
    *best = hit;
}

typedef struct sphere {
    double center[3], radius;
} sphere;

typedef struct box {
    double low[3], high[3];
} box;
static const box empty = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/* Avoids fmin and fmax, on which GCC 12's vectorizer crashes on AArch64. */
static void grow(box *b, const float point[3])
{
    for (int k = 0; k < 3; k++) {
        if (point[k] < b->low[k]) b->low[k] = point[k];
        if (point[k] > b->high[k]) b->high[k] = point[k];
    }
}

/* Returns a sphere around the box; without a radius if it has no points. */
static sphere around(const box *b)
{
    sphere s;
    double square = 0;
    for (int k = 0; k < 3; k++) s.center[k] = 0.5 * (b->low[k] + b->high[k]), square += 0.25 * (b->high[k] - b->low[k]) * (b->high[k] - b->low[k]);
    s.radius = isfinite(square) ? sqrt(square) : 0;
    return s;
}

/* Places the sphere of an instance: no distance grows by more than the matrix' Frobenius norm. */
static sphere place(const sphere *s, const ec_placed *placed)
{
    sphere moved = {.radius = 0};
    double square = 0;
    for (int k = 0; k < 3; k++) {
        moved.center[k] = placed->place[k][3];
        for (int j = 0; j < 3; j++)
            moved.center[k] += placed->place[k][j] * s->center[j], square += placed->place[k][j] * placed->place[k][j];
    }
    moved.radius = s->radius * sqrt(square) * 1.001;
    return moved;
}

static bool passes_by(const ray *r, const sphere *s)
{
    double along = 0, square = 0;
    for (int k = 0; k < 3; k++)
        along += (s->center[k] - r->o[k]) * r->d[k], square += (s->center[k] - r->o[k]) * (s->center[k] - r->o[k]);
    return square - along * along > s->radius * s->radius;
}

static void try_instances(const ec_scene *s, const ray *r, ec_live_hit *best)
{
    sphere *spheres = malloc(s->shape_count * sizeof *spheres);
    if (!spheres) return;
    for (uint32_t i = 0; i < s->shape_count; i++) {
        box b = empty;
        for (uint32_t v = 0; v < s->shapes[i].vertex_count; v++) grow(&b, s->positions + 3 * ((size_t)s->shapes[i].first_vertex + v));
        spheres[i] = around(&b);
    }
    for (uint32_t i = 0; i < s->placed_count; i++) {
        const ec_placed *placed = &s->placed[i];
        sphere here = place(&spheres[placed->shape], placed);
        if (!passes_by(r, &here)) try_triangles(s, r, s->shapes[placed->shape].first, s->shapes[placed->shape].count, placed, best);
    }
    free(spheres);
}

ec_live_hit ec_live_pick(const ec_scene *s, const ec_camera *camera, const ec_render_options *options, uint32_t x, uint32_t y)
{
    ray r = ray_of(camera, options, x, y);
    ec_live_hit best = {INFINITY, 0, 0};
    try_triangles(s, &r, 0, ec_scene_flat_count(s), NULL, &best);
    if (s->placed_count) try_instances(s, &r, &best);
    return best;
}

static void grow_by_part(box *b, const ec_scene *s, uint32_t first, uint64_t end)
{
    for (uint32_t t = first; t < end && t < ec_scene_flat_count(s); t++)
        for (int i = 0; i < 3; i++) grow(b, s->positions + 3 * (size_t)s->indices[3 * (size_t)t + i]);
    for (uint32_t i = 0; i < s->placed_count; i++) {
        const ec_placed *placed = &s->placed[i];
        const ec_shape *shape = &s->shapes[placed->shape];
        for (uint32_t v = 0; placed->id >= first && placed->id < end && v < shape->vertex_count; v++) {
            float point[3];
            ec_placed_point(placed, s->positions + 3 * ((size_t)shape->first_vertex + v), point);
            grow(b, point);
        }
    }
}

void ec_live_node_sphere(const ec_scene *s, uint32_t node, double center[3], double *radius)
{
    box b = empty;
    for (uint32_t p = 0; p < s->part_count; p++)
        if (s->parts[p].node == node)
            grow_by_part(&b, s, s->parts[p].first, p + 1 < s->part_count ? s->parts[p + 1].first : ec_scene_met_count(s));
    const sphere around_it = around(&b);
    for (int k = 0; k < 3; k++) center[k] = around_it.center[k] + s->center[k];
    *radius = around_it.radius;
}
