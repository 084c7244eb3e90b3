/* Awkward triangles and rays, for the tests of the accelerators. */
#ifndef EC_TESTS_KERNEL_TRAVERSAL_SETS_H
#define EC_TESTS_KERNEL_TRAVERSAL_SETS_H

#include "shared/path_state.h"
#include "support/test.h"

typedef struct set {
    const char *name;
    uint32_t triangles;
    float *vertices; /* 9 a triangle */
    float scene_max;
    float size;      /* the region into which rays are aimed */
} set;

static inline float random_float(double a, double b) { return (float)test_random_in(a, b); }
static inline uint32_t random_below(uint32_t n) { return (uint32_t)(test_random_u64() % n); }

static inline set set_make(const char *name, uint32_t triangles, float size)
{
    return (set){name, triangles, calloc(9 * (size_t)triangles + 9, sizeof(float)), 0.0f, size};
}

static inline set set_random(const char *name, uint32_t n, float scale, float edge)
{
    set s = set_make(name, n, scale);
    for (uint32_t i = 0; i < n; i++) {
        float at[3] = {random_float(-1, 1), random_float(-1, 1), random_float(-1, 1)};
        for (int k = 0; k < 9; k++) s.vertices[9 * i + k] = scale * (at[k % 3] + edge * random_float(-1, 1));
    }
    return s;
}

/* Aspect ratios up to 10^6, half of them along an axis. */
static inline set set_slivers(uint32_t n)
{
    set s = set_make("slivers", n, 1.0f);
    for (uint32_t i = 0; i < n; i++) {
        float *p = s.vertices + 9 * i, thin = (float)pow(10.0, test_random_in(-6, -2));
        for (int k = 0; k < 3; k++) p[k] = random_float(-1, 1);
        for (int k = 0; k < 3; k++) p[3 + k] = p[k] + (i % 2 ? random_float(-1, 1) : 0.0f);
        if (i % 2 == 0) p[3 + i / 2 % 3] += random_float(-1, 1);
        float along = random_float(0, 1);
        for (int k = 0; k < 3; k++) p[6 + k] = p[k] + along * (p[3 + k] - p[k]) + thin * random_float(-1, 1);
    }
    return s;
}

static inline set set_coplanar(uint32_t n, int axis)
{
    set s = set_random("coplanar", n, 1.0f, 0.2f);
    for (uint32_t i = 0; i < 3 * n; i++) s.vertices[3 * i + axis] = 0.25f;
    return s;
}

/* A plane that is not parallel to any axis: rays in it see every triangle edge-on, and t is only rounding. Only the clamping of t keeps
 * boxes and triangles consistent there. */
static inline set set_tilted(uint32_t n)
{
    set s = set_make("tilted plane", n, 1.0f);
    for (uint32_t i = 0; i < n; i++) {
        double at[2] = {test_random_in(-1, 1), test_random_in(-1, 1)}, size = pow(10, test_random_in(-2, 0));
        for (int corner = 0; corner < 3; corner++) {
            double a = at[0] + size * test_random_in(-1, 1), b = at[1] + size * test_random_in(-1, 1);
            s.vertices[9 * i + 3 * corner] = (float)(0.61 * a + 0.23 * b);
            s.vertices[9 * i + 3 * corner + 1] = (float)(-0.37 * a + 0.71 * b);
            s.vertices[9 * i + 3 * corner + 2] = (float)(0.53 * a + 0.29 * b);
        }
    }
    return s;
}

/* Four copies of each triangle, all at the same distance. */
static inline set set_duplicated(uint32_t n)
{
    set s = set_random("duplicated", n, 1.0f, 0.3f);
    uint32_t quarter = n / 4;
    for (uint32_t i = quarter; i < 4 * quarter; i++)
        memcpy(s.vertices + 9 * i, s.vertices + 9 * (i % quarter), 9 * sizeof(float));
    return s;
}

/* Faces of cubes with whole coordinates: all boxes flat or touching. */
static inline set set_blocks(uint32_t n)
{
    set s = set_make("axis-aligned", n, 8.0f);
    for (uint32_t i = 0; i < n; i++) {
        float *p = s.vertices + 9 * i;
        int a = (int)random_below(3), b = (a + 1) % 3, c = (a + 2) % 3;
        float at[3] = {(float)random_below(16) - 8, (float)random_below(16) - 8, (float)random_below(16) - 8};
        int far = (int)random_below(2);
        for (int corner = 0; corner < 3; corner++) {
            p[3 * corner + a] = at[a];
            p[3 * corner + b] = at[b] + (float)(corner == 1 || (far && corner == 0));
            p[3 * corner + c] = at[c] + (float)(corner == 2 || (far && corner == 0));
        }
    }
    return s;
}

/* Triangles of all sizes about one centre, and far away from it. */
static inline set set_mixed(uint32_t n)
{
    set s = set_make("all sizes", n, 1000.0f);
    for (uint32_t i = 0; i < n; i++) {
        double size = pow(10.0, test_random_in(-3, 3)), where = pow(10.0, test_random_in(-3, 3));
        float at[3];
        for (int k = 0; k < 3; k++) at[k] = (float)(where * test_random_in(-1, 1));
        for (int k = 0; k < 9; k++) s.vertices[9 * i + k] = at[k % 3] + (float)(size * test_random_in(-1, 1));
    }
    return s;
}

/* A strip of needles that share vertices: rays through shared edges and tips. */
static inline set set_fan(uint32_t n)
{
    set s = set_make("fan", n, 1.0f);
    for (uint32_t i = 0; i < n; i++) {
        float *p = s.vertices + 9 * i;
        for (int k = 0; k < 2; k++) {
            double angle = 6.283185307179586 * ((i + (uint32_t)k) % n) / n;
            p[3 + 3 * k] = (float)cos(angle);
            p[4 + 3 * k] = (float)sin(angle);
            p[5 + 3 * k] = 0.5f;
        }
        p[2] = 0.125f;
    }
    return s;
}

/* Twelve triangles from `first` on: a rotated box about `at`, with half edges along axis[0], axis[1], axis[2]. */
static inline void add_box(set *s, uint32_t first, const double at[3], const double axis[3][3])
{
    static const int corners[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                                       {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    for (int i = 0; i < 36; i++) {
        int corner = corners[i / 3][i % 3];
        for (int k = 0; k < 3; k++) {
            double x = at[k];
            for (int a = 0; a < 3; a++) x += (corner >> a & 1 ? axis[a][k] : -axis[a][k]);
            s->vertices[9 * (size_t)first + 3 * (size_t)i + (size_t)k] = (float)x;
        }
    }
}

/* Three perpendicular edges of these half lengths, the first along `along`. */
static inline void box_axes(const double along[3], const double half[3], double axis[3][3])
{
    double length = sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]), up[3] = {0, 0, 0};
    int least = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(along[k]) < fabs(along[least])) least = k;
    up[least] = 1.0;
    for (int k = 0; k < 3; k++) axis[0][k] = along[k] / length;
    for (int a = 1; a < 3; a++) {
        const double *u = axis[a - 1], *v = a == 1 ? up : axis[0];
        double w[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        double norm = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        for (int k = 0; k < 3; k++) axis[a][k] = w[k] / norm;
    }
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++) axis[a][k] *= half[a];
}

static inline void add_beam(set *s, uint32_t first, const double from[3], const double to[3], double thick)
{
    double at[3], along[3], axis[3][3], length = 0.0;
    for (int k = 0; k < 3; k++) {
        at[k] = 0.5 * (from[k] + to[k]);
        along[k] = to[k] - from[k];
        length += along[k] * along[k];
    }
    box_axes(along, (double[3]){0.5 * sqrt(length), thick, thick}, axis);
    add_box(s, first, at, axis);
}

/* Long thin boxes in all directions that cross each other: every dividing plane cuts many of them. n: twelve for each beam. */
static inline set set_beams(uint32_t n)
{
    set s = set_make("beams", n / 12 * 12, 1.0f);
    for (uint32_t i = 0; i < n / 12; i++) {
        double ends[2][3];
        for (int k = 0; k < 6; k++) ends[k / 3][k % 3] = test_random_in(-1, 1);
        add_beam(&s, 12 * i, ends[0], ends[1], pow(10.0, test_random_in(-3, -1.5)));
    }
    return s;
}

/* Rooms on three floors between slabs as large as the building, walls as large as a room, a stair rail across each room, and small objects
 * on the floor, many in some rooms and none in others. Cutting slabs and rails pays where there are many small objects. */
static inline set set_building(uint32_t n)
{
    enum { SIDE = 4, FLOORS = 3, ROOMS = SIDE * SIDE * FLOORS };
    const double slab = 0.02, width = 2.0 / SIDE, height = 2.0 / FLOORS;
    const double walls[2][3][3] = {{{0.01, 0, 0}, {0, height / 2, 0}, {0, 0, width / 2}}, {{width / 2, 0, 0}, {0, height / 2, 0}, {0, 0, 0.01}}};
    const double floor[3][3] = {{1, 0, 0}, {0, slab, 0}, {0, 0, 1}};
    set s = set_make("building", n / 12 * 12, 1.0f);
    uint32_t boxes = n / 12, box = 0, room = 0, fixed = FLOORS + 1 + 3 * ROOMS;
    for (int i = 0; i <= FLOORS; i++) add_box(&s, 12 * box++, (double[3]){0, -1 + i * height, 0}, floor);
    for (; box < fixed; room++) {
        double x = -1 + width * (room % SIDE), y = -1 + height * (room / SIDE % FLOORS), z = -1 + width * (room / SIDE / FLOORS);
        add_box(&s, 12 * box++, (double[3]){x, y + height / 2, z + width / 2}, walls[0]);
        add_box(&s, 12 * box++, (double[3]){x + width / 2, y + height / 2, z}, walls[1]);
        add_beam(&s, 12 * box++, (double[3]){x, y, z}, (double[3]){x + width, y + height, z + 0.7 * width}, 0.01);
    }
    for (; box < boxes; box++) {
        double size = 0.2 * width * pow(10.0, test_random_in(-1.5, 0)), axis[3][3], at[3];
        uint32_t where = random_below(ROOMS) * random_below(ROOMS) / ROOMS; /* the first rooms are full, the last ones empty */
        const double half[3] = {size * test_random_in(0.2, 1), size * test_random_in(0.2, 1), size * test_random_in(0.2, 1)};
        box_axes((double[3]){test_random_in(-1, 1), 0, test_random_in(0.1, 1)}, half, axis);
        at[0] = -1 + width * (where % SIDE + test_random_in(0.1, 0.9));
        at[1] = -1 + height * (where / SIDE % FLOORS) + slab + size;
        at[2] = -1 + width * (where / SIDE / FLOORS + test_random_in(0.1, 0.9));
        add_box(&s, 12 * box, at, axis);
    }
    return s;
}

static inline void set_finish(set *s)
{
    for (size_t i = 0; i < 9 * (size_t)s->triangles; i++) s->scene_max = fmaxf(s->scene_max, fabsf(s->vertices[i]));
}

/* A point where problems are likely: a vertex, on an edge, in a face, or anywhere. */
static inline void aim(const set *s, float *p)
{
    uint32_t kind = random_below(8);
    if (s->triangles && kind < 6) {
        const float *v = s->vertices + 9 * random_below(s->triangles);
        float a = random_float(0, 1), b = random_float(0, 1 - a);
        if (kind < 2) a = b = 0.0f;
        else if (kind < 4) b = 0.0f;
        for (int k = 0; k < 3; k++) p[k] = v[k] + a * (v[3 + k] - v[k]) + b * (v[6 + k] - v[k]);
    } else {
        for (int k = 0; k < 3; k++) p[k] = s->size * random_float(-1.2, 1.2);
    }
}

/* `rays` rays between such points, on surfaces and inside; parallel to axes in the planes of boxes; with components of 0, -0 and nearly 0. */
static inline void make_rays(const set *s, float *queue, uint32_t rays, uint32_t fields, uint32_t skip_field, bool normalize)
{
    uint32_t *words = (uint32_t *)queue;
    for (uint32_t i = 0; i < rays; i++) {
        float o[3], to[3], d[3];
        aim(s, o);
        aim(s, to);
        uint32_t kind = i % 8;
        if (kind < 2) for (int k = 0; k < 3; k++) o[k] = s->size * random_float(-3, 3);
        for (int k = 0; k < 3; k++) d[k] = to[k] - o[k];
        if (kind == 3 || kind == 4) { /* one or two components are 0, of either sign */
            d[i / 8 % 3] = test_random_u64() & 1 ? 0.0f : -0.0f;
            if (kind == 4) d[(i / 8 + 1) % 3] = test_random_u64() & 1 ? 0.0f : -0.0f;
            if (i / 64 % 2) for (int k = 0; k < 3; k++) o[k] = d[k] == 0.0f ? to[k] : o[k];
        }
        if (kind == 5) d[i / 8 % 3] *= (float)pow(10.0, -(double)random_below(24));
        if (kind == 6) for (int k = 0; k < 3; k++) o[k] = to[k] - 300.0f * (to[k] - o[k]); /* from afar */
        if (kind == 6) for (int k = 0; k < 3; k++) d[k] = to[k] - o[k];
        float length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (!(length > 0.0f)) d[2] = length = 1.0f;
        float scale = normalize ? 1.0f / length : (i % 3 ? 1.0f : random_float(0.5, 2.0));
        for (int k = 0; k < 3; k++) {
            queue[(uint32_t)k * rays + i] = o[k];
            queue[(3 + (uint32_t)k) * rays + i] = d[k] * scale;
        }
        words[skip_field * rays + i] = EC_NO_ID;
        if (fields > EC_PATH_FIELDS - 1 && s->triangles && i % 5 == 0) words[skip_field * rays + i] = random_below(s->triangles);
    }
}

#endif
