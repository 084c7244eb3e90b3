/* tier: quick */
/* Scenes made in memory are processed as those from files: matrices in double, the centre subtracted, triangles without area dropped. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/model.h"
#include "support/test.h"

static ec_scene *end(ec_model *m)
{
    ec_error err = {0};
    ec_scene *scene;
    CHECK_OK(ec_model_scene(m, &scene, &err), err);
    return scene;
}

static void quads_stand_where_they_are_put(void)
{
    ec_model *m = ec_model_new();
    ec_material grey = ec_material_lambert(0.5, 2);
    int32_t material = ec_model_material(m, &grey);
    double place[16] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1e6, 0, 0, 1};
    ec_model_place(m, place);
    ec_model_quad(m, material, (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
    ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0, 3, 0}, (double[3]){0, 0, 0}, 0.5);
    ec_scene *s = end(m);
    CHECK(s && s->triangle_count == 2 && s->material_count == 1 && s->camera_count == 1);
    if (!s) return;
    CHECK(s->center[0] == 1e6 && s->center[1] == 0 && s->center[2] == 0);
    CHECK(s->bounds_min[0] == -2 && s->bounds_max[0] == 2 && s->bounds_min[1] == 0 && s->bounds_max[2] == 2);
    CHECK(s->cameras[0].position[1] == 6 && s->cameras[0].forward[1] == -1);
    CHECK(s->materials[0].base_color[1] == 0.5f && s->materials[0].emission[2] == 2 && s->materials[0].specular == 0);
    /* the front is the side of u x v: up */
    const uint32_t *i = s->indices;
    const float *a = s->positions + 3 * i[0], *b = s->positions + 3 * i[1], *c = s->positions + 3 * i[2];
    CHECK((b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]) > 0);
    ec_scene_free(s);
}

static void bad_triangles_are_dropped_and_counted(void)
{
    static const float positions[27] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 0, 0, 0, NAN, 0, 0, 0, 1, 0};
    ec_model *m = ec_model_new();
    ec_material white = ec_material_default();
    ec_model_add(m, ec_model_material(m, &white), &(ec_model_mesh){.vertex_count = 9, .positions = positions});
    ec_scene *s = end(m);
    CHECK(s && s->triangle_count == 1 && s->dropped_degenerate == 1 && s->dropped_nonfinite == 1);
    ec_scene_free(s);
}

static uint64_t edge_key(const ec_scene *s, uint32_t a, uint32_t b)
{
    uint64_t key[2] = {0, 0};
    const uint32_t v[2] = {a, b};
    for (int e = 0; e < 2; e++) {
        uint32_t bits[3];
        memcpy(bits, s->positions + 3 * v[e], sizeof bits);
        for (int k = 0; k < 3; k++) key[e] = (key[e] ^ (bits[k] == 0x80000000u ? 0 : bits[k])) * 0x9e3779b97f4a7c15u;
    }
    return key[0] * 31 + key[1]; /* key of a directed edge */
}

static int by_value(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Closed and facing outwards: each directed edge occurs once, and so does its opposite. */
static void spheres_are_closed(void)
{
    for (int levels = 0; levels < 5; levels++) {
        ec_model *m = ec_model_new();
        ec_material white = ec_material_default();
        ec_model_sphere(m, ec_model_material(m, &white), (double[3]){0, 0, 0}, 3, levels, true);
        ec_scene *s = end(m);
        CHECK(s && s->triangle_count == 8u << (2 * levels));
        if (!s) return;
        uint32_t edges = 3 * s->triangle_count, inwards = 0;
        uint64_t *there = malloc(edges * sizeof *there), *back = malloc(edges * sizeof *back);
        for (uint32_t t = 0; t < s->triangle_count; t++)
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t a = s->indices[3 * t + k], b = s->indices[3 * t + (k + 1) % 3];
                there[3 * t + k] = edge_key(s, a, b);
                back[3 * t + k] = edge_key(s, b, a);
                const float *p = s->positions + 3 * a, *n = s->normals + 3 * a;
                inwards += !(p[0] * n[0] + p[1] * n[1] + p[2] * n[2] > 2.99f);
            }
        qsort(there, edges, sizeof *there, by_value);
        qsort(back, edges, sizeof *back, by_value);
        CHECK(memcmp(there, back, edges * sizeof *there) == 0);
        for (uint32_t i = 1; i < edges; i++) CHECK(there[i] != there[i - 1]);
        CHECK(inwards == 0);
        free(there);
        free(back);
        ec_scene_free(s);
    }
}

static void nothing_is_an_error(void)
{
    ec_error err = {0};
    ec_scene *scene;
    CHECK(ec_model_scene(ec_model_new(), &scene, &err) == EC_FAILED && !scene && *err.text);
    CHECK(ec_model_scene(NULL, &scene, &err) == EC_FAILED && strstr(err.text, "memory"));
}

int main(void)
{
    quads_stand_where_they_are_put();
    bad_triangles_are_dropped_and_counted();
    spheres_are_closed();
    nothing_is_an_error();
    TEST_END();
}
