/* tier: quick */
/* Work that threads share while a scene is read and packed: bytes and messages do not depend on their number. */
#include <omp.h>

#include "image/image.h"
#include "pack/pack.h"
#include "scene/texels.h"
#include "test_scene_files.h"

enum { SIDE = 24, TRIANGLES = 2 * SIDE * SIDE, TEXTURES = 5, MAP_WIDTH = 203, MAP_HEIGHT = 101 };

static uint32_t noise = 1;
static uint32_t draw(void) { return (noise = noise * 1664525u + 1013904223u) >> 16; }

/* A picture whose pixels deflate cannot compress. */
static uint8_t *noise_png(uint32_t side, size_t *size)
{
    uint8_t *rgb = malloc(3 * (size_t)side * side), *bytes = NULL;
    ec_error err;
    for (size_t i = 0; i < 3 * (size_t)side * side; i++) rgb[i] = (uint8_t)draw();
    CHECK_OK(ec_png_encode(side, side, rgb, &bytes, size, &err), err);
    free(rgb);
    return bytes;
}

/* A field of triangles that all emit, with the texture of the last image. */
#define FIELD                                                                                                                            \
    "{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],"                                                                                   \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0}]}],"                                             \
    "'buffers':[{'byteLength':41472,'uri':'@pos@'},{'byteLength':27648,'uri':'@uv@'}],"                                                  \
    "'bufferViews':[{'buffer':0,'byteLength':41472},{'buffer':1,'byteLength':27648}],"                                                   \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3456,'type':'VEC3'},"                                                     \
    "{'bufferView':1,'componentType':5126,'count':3456,'type':'VEC2'}],"                                                                 \
    "'images':[{'uri':'@0@'},{'uri':'@1@'},{'uri':'@2@'},{'uri':'@3@'},{'uri':'@4@','name':'glow'}],"                                    \
    "'textures':[{'source':0},{'source':1},{'source':2},{'source':3},{'source':4}],"                                                     \
    "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0},'metallicRoughnessTexture':{'index':1}},"                      \
    "'normalTexture':{'index':2},'emissiveTexture':{'index':4},'emissiveFactor':[1,0.5,0.25],"                                           \
    "'extensions':{'KHR_materials_transmission':{'transmissionFactor':0.5,'transmissionTexture':{'index':3}}}}],"                        \
    "'extensionsUsed':['KHR_materials_transmission']}"

static float positions[3 * 3 * TRIANGLES], uv[2 * 3 * TRIANGLES];

static void make_field(void)
{
    for (uint32_t t = 0; t < TRIANGLES; t++)
        for (uint32_t k = 0; k < 3; k++) {
            static const uint32_t corner[2][3] = {{0, 1, 2}, {2, 1, 3}};
            uint32_t c = corner[t % 2][k], x = t / 2 % SIDE + c % 2, y = t / 2 / SIDE + c / 2;
            float *p = positions + 3 * (3 * t + k), *q = uv + 2 * (3 * t + k);
            p[0] = (float)x, p[1] = (float)y, p[2] = (float)((x * 7 + y * 5) % 11) * 0.1f;
            q[0] = p[0] / SIDE, q[1] = p[1] / SIDE;
        }
}

static ec_scene *load_field(uint8_t *const images[TEXTURES], const size_t sizes[TEXTURES])
{
    const blob blobs[] = {{"@pos@", positions, sizeof positions}, {"@uv@", uv, sizeof uv}, {"@0@", images[0], sizes[0]},
                          {"@1@", images[1], sizes[1]}, {"@2@", images[2], sizes[2]}, {"@3@", images[3], sizes[3]},
                          {"@4@", images[4], sizes[4]}, {0}};
    ec_error err;
    ec_scene *s = load_text(FIELD, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) exit(1);
    return s;
}

/* A black row, a black column, and one texel that is far brighter than all others. */
static void light(ec_scene *s)
{
    noise = 7;
    s->environment = (ec_environment){.width = MAP_WIDTH, .height = MAP_HEIGHT, .rgb = malloc(3 * MAP_WIDTH * MAP_HEIGHT * sizeof(float))};
    for (uint32_t i = 0; i < 3 * MAP_WIDTH * MAP_HEIGHT; i++) {
        uint32_t x = i / 3 % MAP_WIDTH, y = i / 3 / MAP_WIDTH;
        s->environment.rgb[i] = y == 50 || y == 51 || y == 52 || x == 9 ? 0 : i == 3001 ? 1e6f : (float)draw() / 65536.0f;
    }
    s->has_environment = true;
}

#define SAME(a, b, count) CHECK_MSG(!memcmp(a, b, (count) * sizeof *(a)), "%s differ", #a)

static void expect_same(const ec_scene *a, const ec_pack *p, const ec_scene *b, const ec_pack *q)
{
    CHECK(a->image_count == TEXTURES && b->image_count == TEXTURES && p->texel_words == q->texel_words && p->light_count == q->light_count);
    if (test_failures) return;
    for (uint32_t i = 0; i < TEXTURES; i++) {
        const ec_image *x = &a->images[i], *y = &b->images[i];
        CHECK(x->width == y->width && !x->name == !y->name && x->has_range && y->has_range);
        SAME(x->rgba8, y->rgba8, 4 * (size_t)x->width * x->height);
        SAME(x->least, y->least, 4);
        SAME(x->most, y->most, 4);
    }
    SAME(p->texels->words, q->texels->words, p->texel_words);
    SAME(p->textures, q->textures, p->texture_count);
    SAME(p->prims, q->prims, p->prim_count);
    SAME(p->lights, q->lights, p->light_count);
    SAME(p->light_shares, q->light_shares, p->light_count);
    SAME(p->environment_texels, q->environment_texels, 4 * MAP_WIDTH * (MAP_HEIGHT + 1));
    SAME(p->environment_table, q->environment_table, (1 + MAP_WIDTH) * (MAP_HEIGHT + 1));
    SAME(p->environment_mean, q->environment_mean, 3);
}

static void same_bytes(uint8_t *const images[TEXTURES], const size_t sizes[TEXTURES])
{
    ec_scene *scenes[2];
    ec_pack packs[2];
    ec_error err;
    for (int centres = 0; centres < 2; centres++) {
        for (int i = 0; i < 2; i++) {
            omp_set_num_threads(i ? 8 : 1);
            scenes[i] = load_field(images, sizes);
            light(scenes[i]);
            CHECK_OK(ec_pack_scene(scenes[i], &packs[i], &err), err);
            CHECK_OK(ec_pack_texels(&packs[i], &err), err);
            if (centres) CHECK_OK(ec_pack_light_centres(&packs[i].plain.scene, &packs[i], &err), err);
        }
        CHECK(centres || packs[0].light_count == TRIANGLES + 1);
        expect_same(scenes[0], &packs[0], scenes[1], &packs[1]);
        for (int i = 0; i < 2; i++) {
            ec_pack_free(&packs[i]);
            ec_scene_free(scenes[i]);
        }
    }
}

/* Decoding the first takes longest, and the last fails at once: messages come in the order in which the material names the images. */
static void first_comes_first(uint8_t *const images[TEXTURES], const size_t sizes[TEXTURES])
{
    char expected[sizeof messages];
    size_t cut[TEXTURES];
    for (int i = 0; i < TEXTURES; i++) cut[i] = i == 0 ? sizes[0] - sizes[0] / 50 : i == 2 ? sizes[2] : 20u;
    for (int run = 0; run < 10; run++) {
        omp_set_num_threads(run ? 8 : 1);
        ec_scene_free(load_field(images, cut));
        if (!run) memcpy(expected, messages, sizeof expected);
        CHECK_MSG(!strcmp(messages, expected), "run %d:\n%sinstead of\n%s", run, messages, expected);
    }
    const char *first = strstr(expected, "images[0] cannot be decoded"), *second = strstr(expected, "images[1] cannot be decoded");
    CHECK_MSG(first && second && first < second && strstr(expected, "images[4] \"glow\"") && !strstr(expected, "images[2]"), "%s", expected);
}

/* In a cube map, whose faces cannot be left out, the message names the first bad face. */
static void first_face(uint8_t *const images[TEXTURES], const size_t sizes[TEXTURES])
{
    char *broken = strdup(TRIANGLE("", "", "", ",'images':[{'uri':'@0@'},{'uri':'@1@'}],'extensionsUsed':['EXT_lights_image_based'],"
                          "'extensions':{'EXT_lights_image_based':{'lights':[{'specularImages':[[0,0,1,1,1,1]],'specularImageSize':8,"
                          "'irradianceCoefficients':[[1,1,1],[1,1,1],[1,1,1],[1,1,1],[1,1,1],[1,1,1],[1,1,1],[1,1,1],[1,1,1]]}]}}"));
    const char *at = "'scenes':[{'nodes':[0]";
    char *lit = replace(broken, at, "'scenes':[{'extensions':{'EXT_lights_image_based':{'light':0}},'nodes':[0]");
    const blob blobs[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {"@0@", images[0], sizes[0] - sizes[0] / 50},
                          {"@1@", images[1], 20}, {0}};
    for (int run = 0; run < 5; run++) {
        omp_set_num_threads(run ? 8 : 1);
        expect_failure(lit, blobs, "the +x face of image-based light 0: images[0] cannot be decoded");
    }
    free(lit);
    free(broken);
}

int main(void)
{
    uint8_t *images[TEXTURES];
    size_t sizes[TEXTURES];
    make_field();
    for (int i = 0; i < TEXTURES; i++) images[i] = noise_png(i ? 64 : 512, &sizes[i]);
    same_bytes(images, sizes);
    first_comes_first(images, sizes);
    first_face(images, sizes);
    for (int i = 0; i < TEXTURES; i++) free(images[i]);
    TEST_END();
}
