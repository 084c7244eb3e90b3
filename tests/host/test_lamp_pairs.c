/* tier: quick */
/* Lamps that face opposite ways become pairs: two sides of a box do; those of a panel, of different emission, or two-sided ones do not.
 * Probabilities stay those of each lamp's power. */
#include "pack/lamp_pairs.h"

#include "support/pack_case.h"

static void normal_of(const ec_light_data *l, double n[3])
{
    double e1[3], e2[3];
    for (int k = 0; k < 3; k++) e1[k] = l->b[k] - (double)l->a[k], e2[k] = l->c[k] - (double)l->a[k];
    for (int k = 0; k < 3; k++) n[k] = e1[(k + 1) % 3] * e2[(k + 2) % 3] - e1[(k + 2) % 3] * e2[(k + 1) % 3];
}

static void check_pair(const ec_pack *pack, uint32_t first)
{
    const ec_light_data *a = &pack->lights[first], *b = a + 1;
    double n[3], m[3], across = 0;
    normal_of(a, n);
    normal_of(b, m);
    for (int k = 0; k < 3; k++) across += n[k] * m[k];
    CHECK(b->kind & EC_LIGHT_PAIR_SECOND && !(b->kind & EC_LIGHT_PAIR_FIRST) && ec_lamp_partner(pack->lights, first) == first + 1);
    CHECK(across < 0 && !memcmp(a->emission, b->emission, sizeof a->emission));
    CHECK(ec_lamp_partner(pack->lights, first + 1) == first);
    CHECK(pack->pair_of_prim[a->prim] == first + 1 && pack->pair_of_prim[b->prim] == first);
}

static void check_boxes(void)
{
    gltf_writer *w = gltf_new();
    const int dim = gltf_lambert(w, 0, 2), bright = gltf_lambert(w, 0, 7);
    const int both = gltf_add(&w->materials, "{\"doubleSided\":true,\"emissiveFactor\":[1,1,1]}");
    gltf_box(w, dim, (double[3]){0, 0, 0}, (double[3]){1, 1, 1});
    gltf_box(w, bright, (double[3]){5, 0, 0}, (double[3]){6, 2, 1});
    gltf_box(w, both, (double[3]){0, 5, 0}, (double[3]){1, 6, 1});
    gltf_quad(w, dim, (double[3]){0, 9, 0}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
    ec_pack pack = pack_of(w, "lamp-pairs");
    ec_error err = {0};
    CHECK(!pack.lamp_pair_count && !pack.pair_of_prim);
    for (uint32_t i = 0; i < pack.light_count; i++) CHECK(!(pack.lights[i].kind & (EC_LIGHT_PAIR_FIRST | EC_LIGHT_PAIR_SECOND)));
    CHECK_OK(ec_pack_lamp_pairs(&pack, &err), err);
    uint32_t firsts = 0, alone = 0;
    double sum = 0;
    for (uint32_t i = 0; i < pack.light_count; i++) {
        const ec_light_data *l = &pack.lights[i];
        sum += (double)l->pmf;
        firsts += (l->kind & EC_LIGHT_PAIR_FIRST) != 0;
        alone += !(l->kind & (EC_LIGHT_PAIR_FIRST | EC_LIGHT_PAIR_SECOND));
        if (l->kind & EC_LIGHT_PAIR_FIRST) check_pair(&pack, i);
        if (l->kind & EC_LIGHT_TWO_SIDED) CHECK(!(l->kind & EC_LIGHT_PAIR_FIRST) && pack.pair_of_prim[l->prim] == EC_NO_ID);
        CHECK_NEAR((double)l->pdf_a, (double)pack.prims[l->prim].light_pdf_a, 0);
        const uint32_t end = i + 1 < pack.light_count ? pack.light_shares[i + 1].first : 0;
        CHECK(pack.light_of_prim[l->prim] == i);
        CHECK_NEAR((end - pack.light_shares[i].first) * 0x1p-32, (double)l->pmf, 1e-8); /* a float */
    }
    CHECK_MSG(pack.light_count == 38 && firsts == 12 && pack.lamp_pair_count == 12 && alone == 14, "%u lights, %u pairs, %u alone", pack.light_count, firsts, alone);
    CHECK_NEAR(sum, 1, 1e-6);
    ec_pack_free(&pack);
}

static void check_panel(void)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 0, 2), (double[3]){0, 0, 0}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
    ec_pack pack = pack_of(w, "lamp-panel");
    ec_error err = {0};
    CHECK_OK(ec_pack_lamp_pairs(&pack, &err), err);
    CHECK(pack.light_count == 2 && !pack.lamp_pair_count && !pack.pair_of_prim);
    ec_pack_free(&pack);
}

int main(void)
{
    check_boxes();
    check_panel();
    TEST_END();
}
