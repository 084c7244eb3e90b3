#include "rare/edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/random.h"

#define BESIDE 1e-4     /* of the scene's radius, from the edge … */
#define BESIDE_EDGE 0.1 /* … but at most this share of the edge's length: a hole in a wide landscape has short edges */

/* Sets a point beside the middle of a triangle's edge, in its plane and outside of it. */
static void set_beside(const ec_prim *p, int edge, double radius, float point[3])
{
    const float *v[3] = {p->v0, p->v1, p->v2}, *a = v[edge], *b = v[(edge + 1) % 3], *c = v[(edge + 2) % 3];
    double along = 0, square = 0, length = 0, out[3];
    for (int k = 0; k < 3; k++) along += ((double)c[k] - a[k]) * ((double)b[k] - a[k]), square += ((double)b[k] - a[k]) * ((double)b[k] - a[k]);
    const double distance = fmin(BESIDE * radius, BESIDE_EDGE * sqrt(square));
    for (int k = 0; k < 3; k++) out[k] = a[k] + along / fmax(square, 1e-300) * ((double)b[k] - a[k]) - c[k], length += out[k] * out[k];
    for (int k = 0; k < 3; k++) point[k] = (float)(0.5 * ((double)a[k] + b[k]) + distance * out[k] / fmax(sqrt(length), 1e-300));
}

static double length_of(const ec_prim *p)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += pow((double)p->v1[k] - p->v0[k], 2) + pow((double)p->v2[k] - p->v0[k], 2);
    return sqrt(sum);
}

/* Returns by how much a place makes lengths larger, in the mean. */
static double scale_of(const ec_placed *at)
{
    double determinant = 0;
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        determinant += (double)at->place[0][k] * ((double)at->place[1][a] * at->place[2][b] - (double)at->place[1][b] * at->place[2][a]);
    }
    return cbrt(fabs(determinant));
}

/* Returns the triangle of a mesh at whose length a sum of lengths is reached. sums[i]: of those before its triangle i. */
static uint32_t reached(const double *sums, uint32_t count, double sum)
{
    uint32_t first = 0, last = count - 1;
    while (first < last) {
        const uint32_t middle = first + (last - first) / 2;
        if (sums[middle + 1] > sum) last = middle;
        else first = middle + 1;
    }
    return first;
}

/* Chooses `count` triangles, by id, each as often as it is long: around holes walls are cut in long ones, and what is finely meshed is mostly no wall.
 * sums: of the lengths of meshes stored once, before each of their triangles; from its first one on. */
static void choose_by_length(const ec_pack *pack, const double *sums, uint32_t count, uint64_t *random, uint32_t *chosen)
{
    const ec_scene *scene = &pack->plain.scene;
    const uint32_t flat = ec_scene_flat_count(scene);
    double all = 0, sum = 0;
    uint32_t next = 0;
    for (uint32_t i = 0; i < flat; i++) all += length_of(&pack->prims[i]);
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        const ec_shape *shape = &scene->shapes[scene->placed[i].shape];
        const double *own = sums + shape->first - flat;
        all += scale_of(&scene->placed[i]) * (own[shape->count] - own[0]);
    }
    const double first = ec_random_unit(random), step = all / count;
    for (uint32_t i = 0; i < flat; i++) {
        sum += length_of(&pack->prims[i]);
        while (next < count && step * (next + first) < sum) chosen[next++] = i;
    }
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        const ec_shape *shape = &scene->shapes[scene->placed[i].shape];
        const double scale = scale_of(&scene->placed[i]), before = sum, *own = sums + shape->first - flat;
        sum += scale * (own[shape->count] - own[0]);
        for (; next < count && step * (next + first) < sum; next++)
            chosen[next] = scene->placed[i].id + reached(own, shape->count, own[0] + (step * (next + first) - before) / scale);
    }
    for (; next < count; next++) chosen[next] = (uint32_t)(ec_scene_met_count(scene) - 1);
}

/* Sets a triangle, by id, in the world. */
static void place(const ec_pack *pack, const ec_rare_lights *all, uint32_t id, ec_prim *prim)
{
    const ec_placed *placed;
    const ec_prim *stored = &pack->prims[ec_rare_stored_of(all, id, &placed)];
    *prim = *stored;
    if (!placed) return;
    ec_placed_point(placed, stored->v0, prim->v0);
    ec_placed_point(placed, stored->v1, prim->v1);
    ec_placed_point(placed, stored->v2, prim->v2);
}

static void shuffle(float (*points)[3], uint32_t count, uint64_t *random)
{
    for (uint32_t i = count; i-- > 1;) { /* Fisher and Yates */
        const uint32_t k = (uint32_t)(ec_random_bits(random) % (i + 1ull));
        float kept[3];
        memcpy(kept, points[i], sizeof kept);
        memcpy(points[i], points[k], sizeof kept);
        memcpy(points[k], kept, sizeof kept);
    }
}

ec_result ec_rare_edges_find(const ec_pack *pack, ec_rare_lights *all, ec_error *err)
{
    const ec_scene *scene = &pack->plain.scene;
    const uint64_t edges = 3 * ec_scene_met_count(scene);
    const bool is_some = edges > EC_RARE_EDGES;
    uint64_t random = 5;
    all->edge_count = is_some ? EC_RARE_EDGES : (uint32_t)edges;
    if (!all->edge_count) return EC_OK;
    EC_FREED uint32_t *by_length = malloc(all->edge_count * sizeof *by_length);
    const uint32_t flat = ec_scene_flat_count(scene), kept_once = is_some ? scene->triangle_count - flat : 0;
    EC_FREED double *sums = malloc((kept_once + (size_t)1) * sizeof *sums);
    all->edges = malloc(all->edge_count * sizeof *all->edges);
    if (!all->edges || !by_length || !sums) return ec_fail(err, "out of memory for %u edges", all->edge_count);
    sums[0] = 0;
    for (uint32_t i = 0; i < kept_once; i++) sums[i + 1] = sums[i] + length_of(&pack->prims[flat + i]);
    if (is_some) choose_by_length(pack, sums, all->edge_count / 2, &random, by_length);
    for (uint32_t i = 0; i < all->edge_count; i++) {
        const uint64_t edge = !is_some ? i : i % 2 ? 3ull * by_length[i / 2] + ec_random_bits(&random) % 3 : ec_random_bits(&random) % edges;
        ec_prim prim;
        place(pack, all, (uint32_t)(edge / 3), &prim);
        set_beside(&prim, (int)(edge % 3), (double)all->radius, all->edges[i]);
    }
    shuffle(all->edges, all->edge_count, &random);
    return EC_OK;
}
