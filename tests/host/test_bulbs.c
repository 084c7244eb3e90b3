/* tier: quick */
/* Lamps that the light tree treats as one from afar. A box, a ball and a panel of many triangles are bulbs. Half a ball, two-sided lamps,
 * single panels and bodies of few triangles are not. A bulb's lamps are neighbours in the table, pairs included, and triangles refer to
 * their bulb. */
#include "pack/bulbs.h"

#include <math.h>

#include "pack/lamp_pairs.h"
#include "support/pack_case.h"

/* A sphere about `at` of rows x 2 rows fields; `part`: how much of its height, from below. */
static void add_ball(gltf_writer *w, int material, const double at[3], int rows, double part)
{
    static const int corners[6] = {0, 1, 3, 1, 2, 3};
    float p[9 * 200];
    int used = 0;
    for (int field = 0; field < 2 * rows * rows; field++)
        for (int c = 0; c < 6; c++) {
            const int row = field / (2 * rows), up = corners[c] > 1, right = corners[c] == 1 || corners[c] == 2;
            if (c / 3 ? part == 1 && row + 1 == rows : row == 0) continue; /* at a pole two corners are one */
            const double theta = acos(-1) * part * (row + up) / rows, phi = acos(-1) * ((field + right) % (2 * rows)) / rows;
            p[used++] = (float)(at[0] + sin(theta) * cos(phi));
            p[used++] = (float)(at[1] - cos(theta));
            p[used++] = (float)(at[2] + sin(theta) * sin(phi));
        }
    gltf_triangles(w, material, &(gltf_mesh){used / 3, p, NULL, NULL, NULL});
}

static void check_scene(void)
{
    gltf_writer *w = gltf_new();
    const int dim = gltf_lambert(w, 0, 2), both = gltf_add(&w->materials, "{\"doubleSided\":true,\"emissiveFactor\":[1,1,1]}");
    gltf_quad(w, dim, (double[3]){0, 9, 0}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
    gltf_box(w, dim, (double[3]){0, 0, 0}, (double[3]){1, 1, 1});
    gltf_box(w, both, (double[3]){0, 5, 0}, (double[3]){1, 6, 1});
    add_ball(w, dim, (double[3]){10, 0, 0}, 6, 1);
    add_ball(w, dim, (double[3]){20, 0, 0}, 6, 0.5);
    for (int i = 0; i < 16; i++) gltf_quad(w, dim, (double[3]){i % 4, 20, i / 4}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
    for (int i = 0; i < 16; i++) gltf_quad(w, dim, (double[3]){5 * (i % 4), -9, 5 * (i / 4)}, (double[3]){5, 0, 0}, (double[3]){0, 0, 5}); /* large */
    ec_pack pack = pack_of(w, "bulbs");
    ec_error err = {0};
    const uint32_t all = pack.light_count;
    uint32_t root[1024];
    CHECK(all <= 1024);
    CHECK_OK(ec_lamp_bodies(&pack, root, &err), err);
    CHECK_OK(ec_pack_bulbs(&pack, root, &err), err);
    CHECK_MSG(pack.bulb_count == 3 && pack.light_count == all, "%u bulbs", pack.bulb_count);
    uint32_t lamps = 0, firsts = 0, wrong = 0;
    for (uint32_t b = 0; b < pack.bulb_count; b++) {
        const ec_bulb *bulb = &pack.bulbs[b];
        CHECK(bulb->first + bulb->count <= all && (!b || bulb->first >= pack.bulbs[b - 1].first + pack.bulbs[b - 1].count));
        lamps += bulb->count;
        for (uint32_t i = bulb->first; i < bulb->first + bulb->count; i++) {
            if (!(pack.lights[i].kind & EC_LIGHT_PAIR_FIRST)) continue;
            firsts++;
            CHECK(i + 1 < bulb->first + bulb->count && ec_lamp_partner(pack.lights, i + 1) == i);
        }
    }
    CHECK_MSG(lamps == 12 + 120 + 32 && firsts > 60 && firsts <= 66 && pack.lamp_pair_count == firsts, "%u lamps, %u pairs", lamps, firsts);
    for (uint32_t i = 0; i < all; i++) wrong += pack.light_of_prim[pack.lights[i].prim] != i;
    CHECK(!wrong);
    ec_pack_free(&pack);
}

int main(void)
{
    check_scene();
    TEST_END();
}
