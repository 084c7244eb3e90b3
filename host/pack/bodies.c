#include "pack/bodies.h"

#include <math.h>
#include <string.h>

#include "base/freed.h"
#include "base/vec3.h"

typedef struct box {
    float low[3], high[3];
} box;

static const box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void extend(box *b, const float p[3])
{
    for (int k = 0; k < 3; k++) {
        b->low[k] = fminf(b->low[k], p[k]);
        b->high[k] = fmaxf(b->high[k], p[k]);
    }
}

static bool overlap(const box *a, const box *b)
{
    for (int k = 0; k < 3; k++)
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return false;
    return true;
}

static const float *corner(const ec_scene *scene, uint32_t triangle, int k)
{
    return scene->positions + 3 * (size_t)scene->indices[3 * (size_t)triangle + k];
}

ec_result ec_bodies_find(const ec_scene *scene, const bool *is_body, ec_bodies *bodies, ec_error *err)
{
    *bodies = (ec_bodies){0};
    EC_FREED box *boxes = malloc(scene->material_count * sizeof *boxes);
    if (!boxes) return ec_fail(err, "out of memory for %u materials", scene->material_count);
    for (uint32_t m = 0; m < scene->material_count; m++) boxes[m] = nothing;
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        for (int k = 0; k < 3 && is_body[scene->triangle_material[t]]; k++)
            extend(&boxes[scene->triangle_material[t]], corner(scene, t, k));
    bool nested = false;
    uint32_t count = 0;
    for (uint32_t m = 0; m < scene->material_count; m++) {
        if (!(boxes[m].low[0] <= boxes[m].high[0])) continue;
        for (uint32_t i = 0; i < count && i < EC_BODIES_MOST; i++) nested |= overlap(&boxes[m], &boxes[bodies->material[i]]);
        if (count < EC_BODIES_MOST) bodies->material[count] = m;
        count++;
    }
    if (count > EC_BODIES_MOST) bodies->too_many = count;
    else bodies->count = nested ? count : 0;
    return EC_OK;
}

/* A corner of a material's triangles; sorting brings those at one point together. */
typedef struct place {
    float p[3];
    uint32_t corner;
} place;

static int compare_places(const void *a, const void *b)
{
    const place *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->p[k] != q->p[k]) return p->p[k] < q->p[k] ? -1 : 1;
    return 0;
}

/* A connected part of a body: sums over its triangles. */
typedef struct part {
    double volume, area, normal[3];
} part;

/* Memory for the triangles of one material. */
typedef struct scratch {
    uint32_t *triangles, *parent; /* parent: by corner, union-find */
    place *places;
    part *parts;                  /* by their root corner */
} scratch;

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static void add_triangle(const ec_scene *scene, uint32_t triangle, part *to)
{
    const float *a = corner(scene, triangle, 0);
    double n[3];
    ec_triangle_normal(a, corner(scene, triangle, 1), corner(scene, triangle, 2), n);
    for (int k = 0; k < 3; k++) {
        to->normal[k] += n[k];
        to->volume += a[k] * n[k] / 6;
    }
    to->area += sqrt(ec_dot(n, n));
}

/* Returns the volume of the largest part, infinite if one is open (its area vectors do not add up to zero): whatever lies in water without a bottom
 * displaces it. */
static double largest_part(const ec_scene *scene, uint32_t material, scratch *d)
{
    uint32_t count = 0, corners;
    double most = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        if (scene->triangle_material[t] == material) d->triangles[count++] = t;
    corners = 3 * count;
    for (uint32_t i = 0; i < corners; i++) {
        d->parent[i] = i - i % 3;
        d->parts[i] = (part){0};
        d->places[i].corner = i;
        memcpy(d->places[i].p, corner(scene, d->triangles[i / 3], (int)(i % 3)), sizeof d->places[i].p);
    }
    qsort(d->places, corners, sizeof *d->places, compare_places);
    for (uint32_t i = 1; i < corners; i++)
        if (!compare_places(&d->places[i - 1], &d->places[i]))
            d->parent[root_of(d->parent, d->places[i].corner)] = root_of(d->parent, d->places[i - 1].corner);
    for (uint32_t i = 0; i < count; i++) add_triangle(scene, d->triangles[i], &d->parts[root_of(d->parent, 3 * i)]);
    for (uint32_t i = 0; i < corners; i++) {
        const part *p = &d->parts[i];
        double open = sqrt(ec_dot(p->normal, p->normal));
        most = fmax(most, open > 1e-3 * p->area ? INFINITY : fabs(p->volume));
    }
    return most;
}

/* Returns the largest number of triangles of one material. */
static uint32_t most_triangles(const ec_scene *scene, const ec_bodies *bodies)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < bodies->count; i++) {
        uint32_t count = 0;
        for (uint32_t t = 0; t < scene->triangle_count; t++) count += scene->triangle_material[t] == bodies->material[i];
        most = count > most ? count : most;
    }
    return most;
}

ec_result ec_bodies_rank(const ec_scene *scene, ec_bodies *bodies, ec_error *err)
{
    double volume[EC_BODIES_MOST];
    size_t n = most_triangles(scene, bodies);
    if (!bodies->count) return EC_OK;
    EC_FREED uint32_t *triangles = malloc(n * sizeof *triangles);
    EC_FREED uint32_t *parent = malloc(3 * n * sizeof *parent);
    EC_FREED place *places = malloc(3 * n * sizeof *places);
    EC_FREED part *parts = malloc(3 * n * sizeof *parts);
    if (!triangles || !parent || !places || !parts) return ec_fail(err, "out of memory for bodies of %zu triangles", n);
    scratch d = {triangles, parent, places, parts};
    for (uint32_t i = 0; i < bodies->count; i++) {
        uint32_t material = bodies->material[i], at = i;
        double size = largest_part(scene, material, &d);
        for (; at > 0 && volume[at - 1] > size; at--) { /* equal volumes stay in the order of materials */
            volume[at] = volume[at - 1];
            bodies->material[at] = bodies->material[at - 1];
        }
        volume[at] = size;
        bodies->material[at] = material;
    }
    return EC_OK;
}

/* Sums the signed solid angles of the triangles (van Oosterom and Strackee 1983), compared with half of 4 pi. */
bool ec_bodies_contain(const ec_scene *scene, uint32_t material, const float point[3])
{
    double sum = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_material[t] != material) continue;
        double v[3][3], length[3], dot[3];
        for (int k = 0; k < 3; k++) {
            for (int c = 0; c < 3; c++) v[k][c] = (double)corner(scene, t, k)[c] - point[c];
            length[k] = sqrt(ec_dot(v[k], v[k]));
        }
        for (int k = 0; k < 3; k++) dot[k] = ec_dot(v[k], v[(k + 1) % 3]);
        double volume = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) + v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                        v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
        double below = length[0] * length[1] * length[2] + dot[0] * length[2] + dot[1] * length[0] + dot[2] * length[1];
        sum += 2 * atan2(volume, below);
    }
    return sum > 2 * 3.14159265358979323846;
}
