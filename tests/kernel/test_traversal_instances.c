/* tier: quick */
/* Two levels against the same triangles written out, bit by bit. One mesh is in several places: rotated, mirrored, sheared, tiny and huge,
 * among triangles of their own. The reference has no structure, and culls nothing. */
#include "kernel/traversal_run.h"
#include "scene/scene.h"

#define RAYS 12000u /* a set; not a multiple of the lanes: */
#define COUNT (RAYS - 3u)
#define PLACES 12u

/* A matrix with largest stretch of about `scale`: three random edges, different enough for an inverse. */
static void random_matrix(double scale, double shear, float m[3][4])
{
    double a[3] = {test_random_in(-1, 1), test_random_in(-1, 1), test_random_in(-1, 1)}, axis[3][3];
    box_axes(a, (double[3]){1, 1, 1}, axis);
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 3; k++)
            m[row][k] = (float)(scale * (axis[k][row] + shear * (k ? axis[k - 1][row] : 0.0) * test_random_in(-1, 1)));
}

static double determinant(float m[3][4])
{
    double d = 0;
    for (int k = 0; k < 3; k++)
        d += (double)m[0][k] * ((double)m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - (double)m[1][(k + 2) % 3] * m[2][(k + 1) % 3]);
    return d;
}

typedef struct placing {
    double scales[2];   /* 10^ */
    double shear, spread;
} placing;

/* The mesh in its places, after triangles of their own. All arrays are the scene's own. */
static ec_scene make_scene(const set *mesh, const set *alone, const placing *how)
{
    ec_scene s = {.triangle_count = mesh->triangles + alone->triangles, .shape_count = 1, .placed_count = PLACES, .whole = true};
    s.vertex_count = 3 * s.triangle_count;
    s.positions = malloc(9 * (size_t)s.triangle_count * sizeof(float));
    s.indices = malloc(3 * (size_t)s.triangle_count * sizeof *s.indices);
    s.triangle_material = calloc(s.triangle_count, sizeof *s.triangle_material);
    s.shapes = calloc(1, sizeof *s.shapes);
    s.placed = calloc(PLACES, sizeof *s.placed);
    memcpy(s.positions, alone->vertices, 9 * (size_t)alone->triangles * sizeof(float));
    memcpy(s.positions + 9 * (size_t)alone->triangles, mesh->vertices, 9 * (size_t)mesh->triangles * sizeof(float));
    for (uint32_t i = 0; i < s.vertex_count; i++) s.indices[i] = i;
    s.shapes[0] = (ec_shape){alone->triangles, mesh->triangles, 3 * alone->triangles, 3 * mesh->triangles};
    for (uint32_t i = 0; i < PLACES; i++) {
        ec_placed *p = &s.placed[i];
        p->id = alone->triangles + i * mesh->triangles;
        random_matrix(pow(10, test_random_in(how->scales[0], how->scales[1])), how->shear, p->place);
        if (i == 2) memcpy(p->place, (float[3][4]){{1}, {0, 1}, {0, 0, 1}}, sizeof p->place);
        if (i == 3) memcpy(p->place, s.placed[2].place, sizeof p->place); /* twice in one place: ties */
        for (int k = 0; k < 3; k++) p->place[k][3] = i == 3 ? s.placed[2].place[k][3] : (float)(how->spread * test_random_in(-1, 1));
        p->mirrored = determinant(p->place) < 0;
    }
    return s;
}

static void free_scene(ec_scene *s)
{
    free(s->shapes);
    free(s->placed);
    ec_scene_written_free(s);
}

/* The written-out triangles, which rays aim at. */
static set written_set(const char *name, const ec_scene *w)
{
    set s = set_make(name, w->triangle_count, 0.0f);
    for (size_t i = 0; i < 3 * (size_t)w->triangle_count; i++) memcpy(s.vertices + 3 * i, w->positions + 3 * (size_t)w->indices[i], 12);
    set_finish(&s);
    s.size = s.scene_max;
    return s;
}

static const tracer *tracer_of(const char *accel)
{
    const tracer *t = tracers;
    while (t->accel != ec_accel_find(accel)) t++;
    return t;
}

static bool build(const ec_scene *s, const char *name, ec_accel *accel)
{
    ec_error err = {0};
    ec_accel_input input = {.positions = s->positions, .indices = s->indices, .triangle_count = ec_scene_flat_count(s), .whole = true,
                            .shape_count = s->shape_count, .placed_count = s->placed_count, .shapes = s->shapes, .placed = s->placed};
    ec_result result = ec_accel_build(ec_accel_find(name), &input, accel, &err);
    CHECK_OK(result, err);
    ec_accel_input_free(&input);
    return result == EC_OK;
}

static uint32_t lost_inside; /* rays from inside closed meshes that hit nothing */

/* Rays through two points of one instance, from outside: a flat mesh is seen edge-on, where t is only rounding. */
static void aim_along(const ec_scene *s, const set *w, float *queue)
{
    for (uint32_t i = 0; i < RAYS; i++) {
        const ec_placed *p = &s->placed[i % PLACES];
        const uint32_t none = EC_NO_ID;
        float at[2][3], back = random_float(0, 3);
        for (int end = 0; end < 2; end++) {
            const float *v = w->vertices + 9 * ((size_t)p->id + random_below(s->shapes[0].count));
            float a = random_float(0, 1), b = random_float(0, 1);
            for (int k = 0; k < 3; k++) at[end][k] = (1 - a) * v[k] + a * ((1 - b) * v[3 + k] + b * v[6 + k]);
        }
        for (uint32_t k = 0; k < 3; k++) {
            queue[(EC_PATH_OX + k) * RAYS + i] = at[0][k] - back * (at[1][k] - at[0][k]);
            queue[(EC_PATH_DX + k) * RAYS + i] = at[1][k] - at[0][k];
        }
        if (!memcmp(at[0], at[1], sizeof at[0])) queue[EC_PATH_DX * RAYS + i] = 1.0f; /* (0, 0, 0) is not a direction */
        memcpy(queue + EC_PATH_PRIM * (size_t)RAYS + i, &none, sizeof none);
    }
}

/* Rays from the centre of every instance of a closed mesh to its corners, and along its edges. */
static void aim_from_inside(const ec_scene *s, const set *w, float *queue)
{
    for (uint32_t i = 0; i < RAYS; i++) {
        const ec_placed *p = &s->placed[i % PLACES];
        const float *v = w->vertices + 9 * ((size_t)p->id + random_below(s->shapes[0].count));
        uint32_t a = random_below(3), b = random_below(3), none = EC_NO_ID;
        float share = i % 3 ? random_float(0, 1) : 0.0f;
        for (uint32_t k = 0; k < 3; k++) {
            queue[(EC_PATH_OX + k) * RAYS + i] = p->place[k][3];
            queue[(EC_PATH_DX + k) * RAYS + i] = (1.0f - share) * v[3 * a + k] + share * v[3 * b + k] - p->place[k][3];
        }
        memcpy(queue + EC_PATH_PRIM * (size_t)RAYS + i, &none, sizeof none);
    }
}

static void check(const char *name, set mesh, set alone, placing how, bool closed)
{
    ec_error err = {0};
    ec_scene s = make_scene(&mesh, &alone, &how), w;
    CHECK_OK(ec_scene_write_out(&s, &w, &err), err);
    set flat = written_set(name, &w);
    ec_accel two, reference;
    float *queue = calloc(EC_PATH_FIELDS * RAYS, sizeof *queue), *expected = calloc(EC_HIT_PROBE_FIELDS * RAYS, sizeof *expected),
          *hits = calloc(EC_HIT_PROBE_FIELDS * RAYS, sizeof *hits);
    const tracer *none = tracer_of("none"), *twolevel = tracer_of("twolevel");
    if (build(&w, "none", &reference) && build(&s, "twolevel", &two)) {
        for (int kind = 0; kind < 2 + closed; kind++) {
            bool inside = kind == 2;
            if (inside) aim_from_inside(&s, &flat, queue);
            else if (kind) aim_along(&s, &flat, queue);
            else make_rays(&flat, queue, RAYS, EC_PATH_FIELDS, EC_PATH_PRIM, true);
            CHECK(intersect(&flat, none, &reference, RAYS, COUNT, queue, expected) && intersect(&flat, twolevel, &two, RAYS, COUNT, queue, hits));
            uint32_t hit = same_hits(&flat, queue, RAYS, COUNT, hits, expected, "two levels", "written out"), placed = 0;
            for (uint32_t i = 0; i < COUNT; i++) placed += ((uint32_t *)hits)[i] != EC_NO_ID && ((uint32_t *)hits)[i] >= alone.triangles;
            CHECK_MSG(placed > COUNT / 50, "%s: only %u rays hit an instance", name, placed);
            if (inside) lost_inside += COUNT - hit;
            printf("%-24s %u of %u rays hit, %u of them instances\n", name, hit, COUNT, placed);
        }
        ec_accel_free(&two);
        ec_accel_free(&reference);
    }
    free(queue);
    free(expected);
    free(hits);
    free(flat.vertices);
    free(mesh.vertices);
    free(alone.vertices);
    free_scene(&s);
    ec_scene_written_free(&w);
}

/* Triangles that an offset of 1 and more rounds into lines, each with three corners on a grid of 2^-14. They have no normal there, and must
 * never be hit. */
static set set_lines(uint32_t n)
{
    set s = set_make("lines", n, 1.0f);
    for (uint32_t i = 0; i < n; i++) {
        float step[3], *v = s.vertices + 9 * i;
        for (int k = 0; k < 3; k++) step[k] = 0x1p-14f * (float)((int)random_below(9) - 4);
        for (int k = 0; k < 3; k++) v[k] = 0x1p-14f * (float)((int)random_below(33) - 16);
        for (int c = 1; c < 3; c++)
            for (int k = 0; k < 3; k++) v[3 * c + k] = v[k] + (float)c * step[k] + (float)c * 1e-9f * random_float(-1, 1);
    }
    return s;
}

/* A ball of 8 x 4^levels triangles whose neighbours share corners to the last bit. */
static set set_ball(int levels)
{
    uint32_t n = 8u << (2 * levels), side = 1u << levels, t = 0;
    set s = set_make("ball", n, 1.0f);
    for (uint32_t octant = 0; octant < 8; octant++)
        for (uint32_t i = 0; i < side; i++)
            for (uint32_t j = 0; i + j < side; j++)
                for (uint32_t up = 0; up < (i + j + 1 < side ? 2u : 1u); up++, t++)
                    for (uint32_t c = 0; c < 3; c++) {
                        uint32_t a = up ? i + (c != 0) : i + (c == 1), b = up ? j + (c != 1) : j + (c == 2);
                        double p[3] = {a, b, (double)side - a - b}, length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
                        for (uint32_t k = 0; k < 3; k++) s.vertices[9 * t + 3 * c + k] = (float)((octant >> k & 1 ? -p[k] : p[k]) / length);
                    }
    CHECK(t == n);
    return s;
}

int main(void)
{
    int open = open_tracers(false);
    if (open) return open;
    const placing near = {{-0.5, 0.3}, 0.0, 2.0}, sizes = {{-4, 4}, 0.3, 100.0}, sheared = {{-1, 0}, 30.0, 3.0}, far = {{-1, 0}, 0.5, 1e5};
    check("random", set_random("", 300, 1.0f, 0.2f), set_random("", 100, 2.0f, 0.1f), near, false);
    check("nothing alone", set_random("", 300, 1.0f, 0.2f), set_random("", 0, 1.0f, 0.1f), near, false);
    check("one triangle", set_random("", 1, 1.0f, 1.0f), set_random("", 20, 2.0f, 0.3f), near, false);
    check("10^-4 to 10^4", set_random("", 300, 1.0f, 0.2f), set_random("", 100, 50.0f, 0.1f), sizes, false);
    check("sheared", set_random("", 300, 1.0f, 0.2f), set_random("", 100, 2.0f, 0.1f), sheared, false);
    check("far from the origin", set_random("", 300, 1.0f, 0.5f), set_random("", 100, 1e5f, 0.1f), far, false);
    check("slivers", set_slivers(400), set_random("", 100, 2.0f, 0.1f), near, false);
    check("a plane, seen edge-on", set_tilted(300), set_tilted(100), near, false);
    check("axis-aligned", set_blocks(400), set_blocks(100), (placing){{-0.5, 0.3}, 0.0, 10.0}, false);
    check("all sizes", set_mixed(300), set_random("", 100, 1000.0f, 0.1f), (placing){{-1, 1}, 0.5, 1000.0}, false);
    check("lines", set_lines(400), set_random("", 50, 20.0f, 0.1f), (placing){{2, 3}, 0.5, 30.0}, false);
    check("closed", set_ball(3), set_random("", 50, 20.0f, 0.02f), (placing){{-1, 0}, 0.5, 30.0}, true);
    CHECK_MSG(lost_inside == 0, "%u rays left a closed mesh", lost_inside);
    close_tracers();
    TEST_END();
}
