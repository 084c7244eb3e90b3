/* tier: quick */
/* Lamps that are cut by their textures: parts tile the lamp, their probabilities follow their light, a bright texel is reached, and each
 * lamp keeps its power. A uniform lamp, or one that coincides with another, stays in one piece. */
#include "support/pack_case.h"
#include "support/texel_lamp.h"

static ec_pack pack_lamp(const char *name, int dark, int bright)
{
    gltf_writer *w = gltf_new();
    texel_lamp_add(w, name, -1, dark, bright, 10);
    return pack_of(w, name);
}

typedef struct walk {
    const ec_pack *pack;
    double area, numbers, most_density, dark_area; /* most_density: share over area; dark_area: area of parts without a share */
    uint32_t parts, next;
} walk;

/* Parts are in order: their numbers are consecutive. */
static void visit(walk *all, uint32_t node, double area, uint32_t first, uint32_t end)
{
    const ec_lamp_node *n = &all->pack->lamp_nodes[node];
    uint32_t inner = n->link >> 4;
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t from = k ? n->first[k - 1] : first, to = k < 3 ? n->first[k] : end;
        CHECK(from <= to && node < all->pack->lamp_node_count);
        if (n->link >> k & 1) {
            visit(all, inner++, area / 4, from, to);
            continue;
        }
        CHECK(from == all->next);
        all->next = to;
        all->parts++;
        all->area += area / 4;
        all->numbers += (double)(to - from);
        all->most_density = fmax(all->most_density, (double)(to - from) / EC_LAMP_PARTS_NUMBERS / (area / 4));
        if (to == from) all->dark_area += area / 4;
    }
}

static walk walk_lamp(const ec_pack *pack, const ec_light_data *l)
{
    walk all = {.pack = pack};
    CHECK(l->kind >> EC_LIGHT_PARTS == pack->prims[l->prim].flags >> EC_PRIM_PARTS);
    visit(&all, l->kind >> EC_LIGHT_PARTS, 1, 0, EC_LAMP_PARTS_NUMBERS);
    CHECK(all.next == EC_LAMP_PARTS_NUMBERS);
    CHECK_NEAR(all.area, 1, 1e-12);
    CHECK_NEAR(all.numbers, EC_LAMP_PARTS_NUMBERS, 0);
    return all;
}

/* Texel (40, 9) is in the lamp's first triangle, right of the diagonal, and its light reaches one texel around it. Parts are triangles of
 * half a square texel; 8 of them contain all of the light, of 2 x 2 texels if parts are a quarter of a texel apart from it. */
static void reaches_the_texel(void)
{
    ec_pack pack = pack_lamp("parts-texel", 0, 255);
    CHECK(pack.light_count == 2 && pack.lamp_node_count > 1);
    for (uint32_t i = 0; i < pack.light_count; i++) {
        const ec_light_data *l = &pack.lights[i];
        if (!(l->kind >> EC_LIGHT_PARTS)) {
            CHECK_MSG(l->pmf < 0.1f, "the lamp without the texel has %g of the light", (double)l->pmf);
            continue;
        }
        CHECK(l->pmf > 0.9f);
        const walk all = walk_lamp(&pack, l);
        const double texels = TEXEL_SIDE * TEXEL_SIDE / 2.0; /* of a triangle */
        printf("one texel: %u parts, the densest %.0f times as dense as an even one\n", all.parts, all.most_density);
        CHECK_MSG(all.most_density > texels / 4, "the densest part is %g times as dense as an even lamp", all.most_density);
        CHECK_MSG(all.dark_area > 1 - 16 / texels, "%g of the lamp is never chosen for its light", all.dark_area);
    }
    ec_pack_free(&pack);
}

/* 1 / 12.92 / 255 and 1, linear: the texel and its filter have 1 of 1.24 + of the light. */
static void keeps_the_rest(void)
{
    ec_pack pack = pack_lamp("parts-rest", 1, 255);
    for (uint32_t i = 0; i < pack.light_count; i++) {
        const double rest = TEXEL_SIDE * TEXEL_SIDE / 2.0 / 12.92 / 255, all = 2 * rest + 1;
        const bool has_texel = pack.lights[i].kind >> EC_LIGHT_PARTS;
        CHECK_NEAR(pack.lights[i].pmf, (rest + has_texel) / all, 0.05);
        if (has_texel) CHECK(walk_lamp(&pack, &pack.lights[i]).dark_area == 0);
    }
    CHECK(pack.light_count == 2 && pack.lamp_node_count > 1);
    ec_pack_free(&pack);
}

static void leaves_whole(void)
{
    ec_pack even = pack_lamp("parts-even", 200, 255);
    CHECK(even.light_count == 2 && !even.lamp_nodes && !even.lamp_node_count);
    for (uint32_t i = 0; i < even.light_count; i++) CHECK(!(even.lights[i].kind >> EC_LIGHT_PARTS));
    ec_pack_free(&even);
    gltf_writer *w = gltf_new();
    texel_lamp_add(w, "parts-twice", -1, 0, 255, 10);
    texel_lamp_add(w, "parts-twice", -1, 0, 255, 10);
    ec_pack twice = pack_of(w, "parts-twice");
    CHECK(twice.light_count == 2 && !twice.lamp_node_count);
    ec_pack_free(&twice);
}

int main(void)
{
    reaches_the_texel();
    keeps_the_rest();
    leaves_whole();
    TEST_END();
}
