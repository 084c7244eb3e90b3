/* tier: quick */
/* Finds faces that overlap in one plane: by hand for a few, by all pairs for many; and others that do not count. */
#include "gltf/reader.h"
#include "pack/near_pairs.h"
#include "pack/pack.h"
#include "support/gltf_writer.h"
#include "support/random.h"
#include "support/test.h"

static const double right[3] = {1, 0, 0}, up[3] = {0, 1, 0};

typedef struct quad {
    double at[3];
    bool back; /* faces down */
} quad;

/* The material emits in cases where it matters which face is met. */
static ec_pack pack_of(const quad *quads, int count, double emission)
{
    gltf_writer *w = gltf_new();
    int material = gltf_lambert(w, 0.5, emission);
    for (int i = 0; i < count; i++) gltf_quad(w, material, quads[i].at, quads[i].back ? up : right, quads[i].back ? right : up);
    ec_scene *scene;
    ec_pack pack;
    ec_error err;
    CHECK_OK(ec_scene_load(gltf_write(w, "coplanar"), &scene, NULL, &err), err);
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    ec_scene_free(scene);
    free(w);
    return pack;
}

/* Entries in a triangle's list: faces that face the other way, and faces that face as it does. */
static void check_list(const ec_pack *pack, uint32_t prim, uint32_t opposite, uint32_t alike)
{
    uint32_t at = pack->coplanar ? pack->coplanar[prim] : 0, has[2] = {at ? pack->coplanar[at] : 0, at ? pack->coplanar[at + 1] : 0};
    CHECK_MSG(has[0] == opposite && has[1] == alike, "triangle %u has %u and %u rivals", prim, has[0], has[1]);
}

static void by_hand(void)
{
    ec_pack pack = pack_of((quad[]){{{0, 0, 0}}, {{0.5, 0, 0}}, {{0.5, 0, 0}, .back = true}}, 3, 1);
    CHECK(pack.effects.bits & EC_FEATURE_COPLANAR);
    check_list(&pack, 0, 2, 0); /* below the first one's diagonal; both halves of the moved one reach there */
    check_list(&pack, 2, 1, 1); /* its own half reversed, and the half of the first quad that reaches below its diagonal */
    ec_pack_free(&pack);
}

/* Both faces look the same, so it does not matter which is met. */
static void plain(void)
{
    ec_pack pack = pack_of((quad[]){{{0, 0, 0}}, {{0.5, 0, 0}}}, 2, 0);
    CHECK(!pack.coplanar);
    ec_pack_free(&pack);
}

static void none(const quad *quads, int count, const char *name)
{
    ec_pack pack = pack_of(quads, count, 1);
    CHECK_MSG(!pack.coplanar && !(pack.effects.bits & EC_FEATURE_COPLANAR), "%s: %llu words", name, (unsigned long long)pack.coplanar_words);
    ec_pack_free(&pack);
}

typedef struct tally {
    uint64_t count, sum;
} tally;

static bool count_pair(void *user, uint32_t a, uint32_t b)
{
    tally *t = user;
#pragma omp critical(pairs)
    {
        t->count++;
        t->sum += (uint64_t)a * b;
    }
    return true;
}

/* Overlapping boxes, against every pair of 6 000 triangles. */
static void every_pair(void)
{
    enum { COUNT = 6000 };
    static ec_prim prims[COUNT];
    static float lo[COUNT][3], hi[COUNT][3];
    uint64_t random = 3;
    tally all = {0}, found = {0};
    ec_error err;
    for (int i = 0; i < COUNT; i++) {
        double size = i % 50 ? 0.03 : 0.5, at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = ec_random_between(&random, -1, 1);
            prims[i].v0[k] = (float)at[k];
            prims[i].v1[k] = (float)(at[k] + ec_random_between(&random, -size, size));
            prims[i].v2[k] = (float)(at[k] + ec_random_between(&random, -size, size));
            lo[i][k] = fminf(prims[i].v0[k], fminf(prims[i].v1[k], prims[i].v2[k]));
            hi[i][k] = fmaxf(prims[i].v0[k], fmaxf(prims[i].v1[k], prims[i].v2[k]));
        }
        for (int j = 0; j < i; j++) {
            bool apart = false;
            for (int k = 0; k < 3; k++) apart |= lo[i][k] > hi[j][k] || lo[j][k] > hi[i][k];
            if (!apart) count_pair(&all, (uint32_t)j, (uint32_t)i);
        }
    }
    CHECK_OK(ec_near_pairs(prims, COUNT, 0, count_pair, &found, &err), err);
    CHECK_MSG(found.count == all.count && found.sum == all.sum, "%llu pairs of %llu", (unsigned long long)found.count, (unsigned long long)all.count);
}

int main(void)
{
    by_hand();
    plain();
    none((quad[]){{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 1, 0}}}, 4, "tiles");
    none((quad[]){{{0, 0, 0}}, {{0.5, 0, 64 * 0x1p-23}}}, 2, "64 ulps apart");
    none((quad[]){{{0, 0, 0}}, {{0, 0, 0}}, {{0, 0, 0}}}, 3, "copies, of which rays meet the first");
    static quad many[300];
    for (int i = 0; i < 300; i++) many[i].at[0] = 1e-3 * i;
    none(many, 300, "too many to tell");
    every_pair();
    TEST_END();
}
