/* tier: quick */
/* Lamps that coincide exactly are one light; all their triangles have the light's density. Expected counts by hand. */
#include "pack/pack.h"
#include "support/gltf_writer.h"
#include "support/test.h"
#include "gltf/reader.h"

static const float corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

typedef struct one {
    int corners[3], material; /* 0, 1: single-sided lamps; 2: two-sided; 3: dark */
} one;

static ec_pack pack_of(const one *triangles, int count)
{
    gltf_writer *w = gltf_new();
    gltf_lambert(w, 0, 1);
    gltf_lambert(w, 0, 2);
    gltf_add(&w->materials, "{\"emissiveFactor\":[1,1,1],\"doubleSided\":true}");
    gltf_lambert(w, 0.5, 0);
    for (int i = 0; i < count; i++) {
        float p[9];
        for (int k = 0; k < 9; k++) p[k] = corner[triangles[i].corners[k / 3]][k % 3];
        gltf_triangles(w, triangles[i].material, &(gltf_mesh){3, p, NULL, NULL, NULL});
    }
    ec_scene *scene;
    ec_pack pack;
    ec_error err;
    CHECK_OK(ec_scene_load(gltf_write(w, "coincident"), &scene, NULL, &err), err);
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    double sum = 0;
    for (uint32_t i = 0; i < pack.light_count; i++) sum += pack.lights[i].pmf;
    CHECK_NEAR(sum, 1, 1e-6);
    ec_scene_free(scene);
    free(w);
    return pack;
}

static void twice_the_same(const one *triangles, const char *name)
{
    ec_pack pack = pack_of(triangles, 2);
    CHECK_MSG(pack.light_count == 1 && pack.lights[0].prim == 0, "%s: %u lights", name, pack.light_count);
    CHECK_MSG(pack.prims[0].light_pdf_a == 2, "%s: %g for a lamp of half a square metre", name, pack.prims[0].light_pdf_a);
    CHECK_MSG(pack.prims[1].light_pdf_a == 2, "%s: %g for the second", name, pack.prims[1].light_pdf_a);
    ec_pack_free(&pack);
}

static void not_the_same(const one *triangles, const char *name, uint32_t lights)
{
    ec_pack pack = pack_of(triangles, 2);
    CHECK_MSG(pack.light_count == lights, "%s: %u lights", name, pack.light_count);
    ec_pack_free(&pack);
}

/* For every order of the corners that keeps the front; an odd permutation is another lamp. Also two-sided lamps: a ray meets the one that
 * faces it. */
static void every_order(void)
{
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            for (int material = 0; material <= 2; material += 2) {
                one two[2] = {{.material = material}, {.material = material}};
                memcpy(two[0].corners, orders[i], sizeof orders[i]);
                memcpy(two[1].corners, orders[j], sizeof orders[j]);
                if (i / 3 == j / 3) twice_the_same(two, "orders");
                else not_the_same(two, "front and back", 2);
            }
}

int main(void)
{
    every_order();
    twice_the_same((const one[]){{{0, 1, 2}, 0}, {{0, 1, 2}, 1}}, "two radiances: rays meet the first");
    not_the_same((const one[]){{{0, 1, 2}, 0}, {{0, 1, 3}, 0}}, "an edge in common", 2);
    not_the_same((const one[]){{{0, 1, 2}, 0}, {{0, 1, 2}, 2}}, "one side and both", 2);
    not_the_same((const one[]){{{0, 1, 2}, 0}, {{0, 1, 2}, 3}}, "a lamp and a wall", 1);
    TEST_END();
}
