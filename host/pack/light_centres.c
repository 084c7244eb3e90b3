/* Makes the lights of integrators that take them as points. Emissive triangles of one material that lie edge to edge in one plane shine as one from
 * one centre. If they form a small curved body, all of it shines as one point: on average over directions, its projected area is a quarter of its
 * surface (Cauchy). They are sorted, so that no picture depends on the order of triangles. */
#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "base/vec3.h"
#include "pack/pack.h"
#include "pack/texture_mean.h"

#define LARGEST_BODY 0.05 /* of the scene's radius: a larger body cannot count as a point */

typedef struct lamp {
    double normal[3], centre[3], emission[3], area; /* centre and emission: multiplied by the area */
    uint32_t flat, body; /* union-find of triangles in one plane, and across edges; a root refers to itself */
    uint32_t count;      /* number of triangles in the plane */
    double radius;       /* of a body, around its centre */
} lamp;

typedef struct edge {
    float ends[2][3]; /* in the same order for both triangles */
    uint32_t light;
} edge;

static int compare_lights(const void *a, const void *b)
{
    const ec_light_data *x = a, *y = b;
    const float *p = x->a, *q = y->a; /* a, b, c and emission are adjacent in memory */
    for (size_t i = 0; i < offsetof(ec_light_data, kind) / sizeof(float); i++)
        if (p[i] != q[i]) return p[i] < q[i] ? -1 : 1;
    return x->kind < y->kind ? -1 : x->kind > y->kind;
}

static int compare_edges(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    int order = memcmp(x->ends, y->ends, sizeof x->ends);
    return order ? order : x->light < y->light ? -1 : x->light > y->light;
}

static bool is_triangle(const ec_light_data *l)
{
    return (l->kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE;
}

static lamp lamp_of(const ec_scene *scene, const ec_light_data *l, uint32_t index)
{
    lamp r = {.flat = index, .body = index, .count = 1};
    if (!is_triangle(l)) return r;
    double n[3], mean[3] = {1, 1, 1};
    ec_triangle_normal(l->a, l->b, l->c, n);
    double length = sqrt(ec_dot(n, n));
    const ec_material *m = &scene->materials[scene->triangle_material[l->prim]];
    if (l->kind & EC_LIGHT_TEXTURED) ec_texture_triangle_mean(scene, &m->textures[EC_SLOT_EMISSION], l->prim, mean);
    r.area = 0.5 * length;
    for (int k = 0; k < 3; k++) {
        r.normal[k] = n[k] / length;
        r.centre[k] = r.area * ((double)l->a[k] + l->b[k] + l->c[k]) / 3;
        r.emission[k] = r.area * l->emission[k] * mean[k];
    }
    return r;
}

static void add(lamp *to, const lamp *from)
{
    to->area += from->area;
    for (int k = 0; k < 3; k++) to->centre[k] += from->centre[k], to->emission[k] += from->emission[k];
}

static uint32_t flat_root(lamp *lamps, uint32_t i)
{
    while (lamps[i].flat != i) i = lamps[i].flat = lamps[lamps[i].flat].flat;
    return i;
}
static uint32_t body_root(lamp *lamps, uint32_t i)
{
    while (lamps[i].body != i) i = lamps[i].body = lamps[lamps[i].body].body;
    return i;
}

/* Joins two triangles with a common edge. The root is the first in order. */
static void join(const ec_scene *scene, const ec_light_data *lights, lamp *lamps, uint32_t i, uint32_t j)
{
    if (scene->triangle_material[lights[i].prim] != scene->triangle_material[lights[j].prim]) return;
    uint32_t a = body_root(lamps, i), b = body_root(lamps, j);
    lamps[a < b ? b : a].body = a < b ? a : b;
    a = flat_root(lamps, i), b = flat_root(lamps, j);
    if (a == b || !(ec_dot(lamps[a].normal, lamps[b].normal) > 1 - 1e-6)) return;
    uint32_t keep = a < b ? a : b, drop = a < b ? b : a;
    lamps[drop].flat = keep;
    lamps[keep].count += lamps[drop].count;
    add(&lamps[keep], &lamps[drop]);
}

static uint32_t list_edges(const ec_light_data *lights, uint32_t count, edge *edges)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!is_triangle(&lights[i])) continue;
        const float *v[3] = {lights[i].a, lights[i].b, lights[i].c};
        for (int k = 0; k < 3; k++) {
            const float *p = v[k], *q = v[(k + 1) % 3];
            bool swap = memcmp(p, q, 12) > 0;
            memcpy(edges[n].ends[swap], p, 12);
            memcpy(edges[n].ends[!swap], q, 12);
            edges[n++].light = i;
        }
    }
    return n;
}

/* Writes an equilateral triangle with the lamp's area around its centre, whose centre the kernels use. */
static void write_flat(const lamp *l, ec_light_data *out)
{
    const double corners[3][2] = {{1, 0}, {-0.5, 0.8660254037844386}, {-0.5, -0.8660254037844386}};
    double radius = sqrt(4 * l->area / (3 * sqrt(3))), s[3], t[3], least = 2;
    int axis = 0;
    for (int k = 0; k < 3; k++)
        if (fabs(l->normal[k]) < least) least = fabs(l->normal[k]), axis = k;
    double length = sqrt(1 - least * least);
    for (int k = 0; k < 3; k++) s[k] = ((k == axis) - l->normal[axis] * l->normal[k]) / length;
    ec_cross(l->normal, s, t);
    float *v[3] = {out->a, out->b, out->c};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3 && l->count > 1; i++)
            v[i][k] = (float)(l->centre[k] / l->area + radius * (corners[i][0] * s[k] + corners[i][1] * t[k]));
        out->emission[k] = (float)(l->emission[k] / l->area);
    }
    out->kind &= ~EC_LIGHT_TEXTURED;
    out->pmf = 1.0f;
    out->pdf_a = (float)(1 / l->area);
}

/* Writes a point for a body. A clear coat over all of it, textured or not, removes 0.04 + 0.96 / 21 of the light over all angles: the cosine-weighted
 * mean of Schlick's reflectance. */
static void write_body(const ec_material *m, const lamp *l, ec_light_data *out)
{
    double share = (out->kind & EC_LIGHT_TWO_SIDED ? 0.5 : 0.25) * (1 - m->coat * (0.04 + 0.96 / 21));
    *out = (ec_light_data){.kind = EC_KIND_POINT, .prim = EC_NO_ID, .pmf = 1.0f, .b = {0, 0, 1},
                           .pdf_a = (float)(l->radius * 1.001)}; /* just outside the body, where a shadow ray may end */
    for (int k = 0; k < 3; k++) {
        out->a[k] = (float)(l->centre[k] / l->area);
        out->emission[k] = (float)(l->emission[k] * share);
    }
}

/* bodies: by root, the sums of all triangles; area 0 if there are none, if they lie in one plane, or if the body is large. */
static void sum_bodies(const ec_light_data *lights, lamp *lamps, lamp *bodies, uint32_t count, double scene_radius)
{
    for (uint32_t i = 0; i < count; i++)
        if (is_triangle(&lights[i]) && lamps[i].flat == i) add(&bodies[body_root(lamps, i)], &lamps[i]);
    for (uint32_t i = 0; i < count; i++) {
        lamp *body = &bodies[body_root(lamps, i)];
        const float *v[3] = {lights[i].a, lights[i].b, lights[i].c};
        for (int c = 0; c < 3 && body->area > 0; c++) {
            double d2 = 0;
            for (int k = 0; k < 3; k++) d2 += pow(v[c][k] - body->centre[k] / body->area, 2);
            body->radius = fmax(body->radius, sqrt(d2));
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        bool is_flat = bodies[i].area == lamps[i].area; /* all of it lies in its root's plane */
        if (is_flat || bodies[i].radius > LARGEST_BODY * scene_radius) bodies[i].area = 0;
    }
}

ec_result ec_pack_light_centres(const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    uint32_t count = pack->light_count, kept = 0;
    ec_light_data *lights = pack->lights;
    if (!count) return EC_OK;
    qsort(lights, count, sizeof *lights, compare_lights);
    EC_FREED lamp *lamps = malloc(count * sizeof *lamps);
    EC_FREED lamp *bodies = calloc(count, sizeof *bodies);
    EC_FREED edge *edges = malloc(3 * (size_t)count * sizeof *edges);
    if (!lamps || !bodies || !edges) return ec_fail(err, "out of memory for the centres of %u lights", count);
#pragma omp parallel for schedule(dynamic, 64) if (count > 256)
    for (uint32_t i = 0; i < count; i++) lamps[i] = lamp_of(scene, &lights[i], i);
    uint32_t edge_count = list_edges(lights, count, edges);
    qsort(edges, edge_count, sizeof *edges, compare_edges);
    for (uint32_t i = 1; i < edge_count; i++)
        if (memcmp(edges[i - 1].ends, edges[i].ends, sizeof edges->ends) == 0)
            join(scene, lights, lamps, edges[i - 1].light, edges[i].light);
    sum_bodies(lights, lamps, bodies, count, pack->scene_radius);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t root = body_root(lamps, i);
        bool is_body = bodies[root].area > 0;
        if ((is_body ? root : lamps[i].flat) != i || (lights[i].kind & EC_LIGHT_KIND_MASK) == EC_KIND_ENVIRONMENT) continue;
        lights[kept] = lights[i];
        const float *sent = lights[kept].emission;
        if (is_body) write_body(&scene->materials[scene->triangle_material[lights[i].prim]], &bodies[i], &lights[kept]);
        else if (is_triangle(&lights[i])) write_flat(&lamps[i], &lights[kept]);
        if (sent[0] > 0 || sent[1] > 0 || sent[2] > 0) kept++; /* no light comes from a black texture: summing over it would be wasted */
    }
    pack->light_count = kept;
    return EC_OK;
}
