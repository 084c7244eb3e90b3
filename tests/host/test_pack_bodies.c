/* tier: quick */
/* Bodies that may overlap, which of two displaces the other, and which body a point is in. */
#include "pack/pack.h"
#include "gltf/model.h"
#include "support/test.h"

static const double origin[3] = {0, 0, 0};

static int32_t glass(ec_model *m, float ior)
{
    ec_material g = ec_material_default();
    g.metallic = g.roughness = 0;
    g.transmission = 1;
    g.volume = true;
    g.ior = ior;
    return ec_model_material(m, &g);
}
static void add_cube(ec_model *m, int32_t material, double x, double half)
{
    ec_model_box(m, material, (double[3]){x - half, -half, -half}, (double[3]){x + half, half, half}, false);
}
static ec_scene *scene_of(ec_model *m)
{
    ec_error err = {0};
    ec_scene *scene = NULL;
    CHECK_OK(ec_model_scene(m, &scene, &err), err);
    return scene;
}
static ec_pack pack_of(const ec_scene *scene)
{
    ec_error err = {0};
    ec_pack pack;
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    return pack;
}

/* Order is by volume, not by material number. A rod has less volume than a cube, though it is longer. Small bodies of a material do not
 * count. Water without a top is displaced by everything. */
static void less_displaces_more(void)
{
    ec_model *m = ec_model_new();
    int32_t outer = glass(m, 1.5f), open = glass(m, 1.33f), inner = glass(m, 1.31f), rod = glass(m, 1.6f);
    add_cube(m, outer, 0, 1);
    add_cube(m, outer, 9, 0.1);
    ec_model_quad(m, open, (double[3]){-1, 0, -1}, (double[3]){0, 0, 2}, (double[3]){2, 0, 0});
    add_cube(m, inner, 0, 0.5);
    add_cube(m, inner, 0.1, 0.1);
    ec_model_box(m, rod, (double[3]){-0.1, -3, -0.1}, (double[3]){0.1, 3, 0.1}, false);
    ec_scene *scene = scene_of(m);
    ec_pack pack = pack_of(scene);
    const int32_t order[4] = {rod, inner, outer, open};
    CHECK(pack.bodies.count == 4 && pack.bodies.too_many == 0);
    for (int i = 0; i < 4; i++) {
        CHECK_MSG(pack.bodies.material[i] == (uint32_t)order[i], "rank %d: material %u, expected %d", i, pack.bodies.material[i], order[i]);
        CHECK(pack.materials[order[i]].body == 1u << i && pack.materials[i].body_of_rank == (uint32_t)order[i] * EC_MATERIAL_WORDS);
        CHECK(pack.materials[order[i]].flags & EC_MATERIAL_NESTED);
    }
    CHECK((pack.effects.bits & EC_FEATURE_NESTED) && (pack.effects.bits & EC_FEATURE_SMOOTH));
    ec_pack_free(&pack);
    ec_scene_free(scene);
}

/* Separate bodies, bodies of one material, and surfaces that are no bodies need no effect. */
static void apart(void)
{
    for (int i = 0; i < 4; i++) {
        ec_model *m = ec_model_new();
        ec_material pane = ec_material_default();
        pane.metallic = 0;
        pane.transmission = 1;
        int32_t a = glass(m, 1.5f), b = i == 1 ? a : i == 2 ? ec_model_material(m, &pane) : glass(m, 1.33f);
        add_cube(m, a, 0, 1);
        add_cube(m, b, i ? 0 : 2.5, 0.5);
        ec_scene *scene = scene_of(m);
        ec_pack pack = pack_of(scene);
        CHECK_MSG(!(pack.effects.bits & EC_FEATURE_NESTED) == (i < 3) && !pack.bodies.count == (i < 3), "case %d", i);
        for (uint32_t k = 0; k < pack.material_count && i < 3; k++) CHECK(!(pack.materials[k].flags & EC_MATERIAL_NESTED) && !pack.materials[k].body);
        ec_pack_free(&pack);
        ec_scene_free(scene);
    }
}

static void too_many(void)
{
    for (uint32_t n = EC_BODIES_MOST; n <= EC_BODIES_MOST + 1; n++) {
        ec_model *m = ec_model_new();
        for (uint32_t i = 0; i < n; i++) add_cube(m, glass(m, 1.5f), 0, 1 + i);
        ec_scene *scene = scene_of(m);
        ec_pack pack = pack_of(scene);
        bool fits = n == EC_BODIES_MOST;
        CHECK(pack.bodies.count == (fits ? n : 0) && pack.bodies.too_many == (fits ? 0 : n));
        CHECK(!(pack.effects.bits & EC_FEATURE_NESTED) == !fits);
        ec_pack_free(&pack);
        ec_scene_free(scene);
    }
}

/* A cube inside a mirrored one, and a ball. */
static void contained(void)
{
    static const double mirrored[16] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const struct {
        float at[3];
        bool in[3];
    } points[5] = {{{0.1f, 0.2f, -0.3f}, {true, true, true}}, {{0.8f, 0.2f, 0.1f}, {true, false, true}}, {{0.9f, 0.9f, 0.9f}, {true, false, false}},
                   {{3, 0, 0}, {false, false, false}}, {{0, -1.001f, 0}, {false, false, false}}};
    ec_model *m = ec_model_new();
    int32_t outer = glass(m, 1.5f), inner = glass(m, 1.33f), ball = glass(m, 1.2f);
    ec_model_place(m, mirrored);
    add_cube(m, outer, 0, 1);
    ec_model_place(m, NULL);
    add_cube(m, inner, 0, 0.5);
    ec_model_sphere(m, ball, origin, 0.95, 2, true);
    ec_scene *scene = scene_of(m);
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 3; k++) {
            const int32_t of[3] = {outer, inner, ball};
            CHECK_MSG(ec_bodies_contain(scene, (uint32_t)of[k], points[i].at) == points[i].in[k], "point %d, body %d", i, k);
        }
    ec_scene_free(scene);
}

int main(void)
{
    less_displaces_more();
    apart();
    too_many();
    contained();
    TEST_END();
}
