/* tier: quick */
/* When --light-choice auto uses the tree: if distant lamps give a part of the light that is worth its time. And the share that a tree
 * leaves to the sky. */
#include "pack/bulbs.h"
#include "gltf/model.h"
#include "support/test.h"

enum { SIDE = 8 };

/* side^2 lamps of radiance 1 above a floor, in a sky. */
static ec_scene *lamps(int side, double size, double gap, double sky)
{
    ec_error err = {0};
    ec_scene *scene;
    ec_model *m = ec_model_new();
    if (!m) exit(1);
    ec_material floor = ec_material_lambert(0.5, 0), lamp = ec_material_lambert(0, 1);
    uint32_t of_floor = ec_model_material(m, &floor), of_lamp = ec_model_material(m, &lamp);
    ec_model_quad(m, of_floor, (double[3]){-5, -5, 0}, (double[3]){10, 0, 0}, (double[3]){0, 10, 0});
    for (int i = 0; i < side * side; i++)
        ec_model_quad(m, of_lamp, (double[3]){gap * (i % side), gap * (i / side), 1}, (double[3]){0, size, 0}, (double[3]){size, 0, 0});
    ec_model_camera(m, EC_CAMERA_ORTHOGRAPHIC, (double[3]){0, 0, 3}, (double[3]){0, 0, 0}, 0.5);
    if (ec_model_scene(m, &scene, &err) != EC_OK) exit(1);
    scene->has_environment = sky > 0;
    for (int k = 0; k < 3; k++) scene->environment.constant[k] = (float)sky;
    return scene;
}

static bool wants_tree_of(int side, double size, double gap, double sky)
{
    ec_error err = {0};
    ec_scene *scene = lamps(side, size, gap, sky);
    ec_pack pack;
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    bool wants = false;
    uint32_t root[2 * SIDE * SIDE + 1];
    CHECK(pack.light_count <= sizeof root / sizeof *root);
    CHECK_OK(ec_lamp_bodies(&pack, root, &err), err);
    CHECK_OK(ec_pack_wants_light_tree(&pack, root, &wants, &err), err);
    ec_pack_free(&pack);
    ec_scene_free(scene);
    return wants;
}

static bool wants_tree(double gap, double sky) { return wants_tree_of(SIDE, 0.01, gap, sky); }

/* Half of all samples go to the sky, as by power (light_table.c); lamps' densities are conditional on the lamp that the tree chooses. */
static void the_sky_keeps_its_half(void)
{
    ec_error err = {0};
    ec_scene *scene = lamps(SIDE, 0.01, 0.5, 1e-3);
    ec_pack pack;
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    CHECK_OK(ec_pack_light_tree(&pack, &err), err);
    CHECK(pack.lights_are_halved && pack.environment_pmf == 0.5f);
    CHECK(pack.light_choices == 2 && pack.lights[0].kind == EC_KIND_ENVIRONMENT);
    CHECK(pack.light_shares[1].first == 1u << 31 && pack.light_tree_numbers == 1u << 30);
    uint32_t found = 0;
    for (uint32_t i = 0; i < pack.light_count; i++) {
        const ec_light_data *l = &pack.lights[i];
        if ((l->kind & EC_LIGHT_KIND_MASK) != EC_KIND_TRIANGLE) continue;
        CHECK(l->pmf == 1);
        CHECK_NEAR(l->pdf_a, 1 / 0.5e-4, 0.2); /* edges of 0.01; at 4, floats have a relative error of 5e-5 of that */
        CHECK(pack.prims[l->prim].light_pdf_a == l->pdf_a);
        found++;
    }
    CHECK(found == 2 * SIDE * SIDE);
    ec_pack_free(&pack);
    ec_scene_free(scene);
}

int main(void)
{
    CHECK(wants_tree(0.5, 0));
    CHECK(!wants_tree(0.02, 0)); /* a cluster */
    CHECK(wants_tree_of(2, 0.5, 2.5, 0));
    CHECK(!wants_tree_of(2, 1.5, 2.5, 0)); /* panels that almost touch */
    CHECK(!wants_tree_of(1, 2, 0, 0));
    CHECK(!wants_tree_of(SIDE, 0.25, 0.25, 0)); /* one panel of many triangles */
    CHECK(wants_tree_of(SIDE, 0.5, 0.5, 0));    /* one that is half of the scene */
    /* The lamps' power is pi 64 1e-4, the sky's 4 pi^2 r^2 with a radius r of about 7: equal at a sky of 1e-5. */
    CHECK(wants_tree(0.5, 1e-5));
    CHECK(wants_tree(0.5, 2.5e-3)); /* 0.4 % */
    CHECK(!wants_tree(0.5, 1e-2));  /* 0.1 % */
    the_sky_keeps_its_half();
    TEST_END();
}
