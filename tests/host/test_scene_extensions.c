/* tier: quick */
/* Extensions: those that change no picture are accepted, even where they are required; others are read, or refused by name. */
#include <sys/resource.h>

#include "gltf/codecs.h"
#include "test_scene_files.h"

/* (10, 200, 30, 255), (40, 50, 60, 128), as libavif's encoder packs it without loss. */
static const unsigned char avif_two[512] = {
    0, 0, 0, 32, 102, 116, 121, 112, 97, 118, 105, 102, 0, 0, 0, 0, 97, 118, 105, 102, 109, 105, 102, 49, 109, 105, 97, 102, 77, 65,
    49, 65, 0, 0, 1, 141, 109, 101, 116, 97, 0, 0, 0, 0, 0, 0, 0, 40, 104, 100, 108, 114, 0, 0, 0, 0, 0, 0, 0, 0, 112, 105, 99, 116,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 108, 105, 98, 97, 118, 105, 102, 0, 0, 0, 0, 14, 112, 105, 116, 109, 0, 0, 0, 0, 0, 1, 0, 0,
    0, 44, 105, 108, 111, 99, 0, 0, 0, 0, 68, 0, 0, 2, 0, 1, 0, 0, 0, 1, 0, 0, 1, 205, 0, 0, 0, 51, 0, 2, 0, 0, 0, 1, 0, 0, 1, 181,
    0, 0, 0, 24, 0, 0, 0, 66, 105, 105, 110, 102, 0, 0, 0, 0, 0, 2, 0, 0, 0, 26, 105, 110, 102, 101, 2, 0, 0, 0, 0, 1, 0, 0, 97,
    118, 48, 49, 67, 111, 108, 111, 114, 0, 0, 0, 0, 26, 105, 110, 102, 101, 2, 0, 0, 0, 0, 2, 0, 0, 97, 118, 48, 49, 65, 108, 112,
    104, 97, 0, 0, 0, 0, 26, 105, 114, 101, 102, 0, 0, 0, 0, 0, 0, 0, 14, 97, 117, 120, 108, 0, 2, 0, 1, 0, 1, 0, 0, 0, 195, 105,
    112, 114, 112, 0, 0, 0, 157, 105, 112, 99, 111, 0, 0, 0, 20, 105, 115, 112, 101, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0,
    16, 112, 105, 120, 105, 0, 0, 0, 0, 3, 8, 8, 8, 0, 0, 0, 12, 97, 118, 49, 67, 129, 32, 0, 0, 0, 0, 0, 19, 99, 111, 108, 114,
    110, 99, 108, 120, 0, 2, 0, 2, 0, 0, 128, 0, 0, 0, 14, 112, 105, 120, 105, 0, 0, 0, 0, 1, 8, 0, 0, 0, 12, 97, 118, 49, 67, 129,
    0, 28, 0, 0, 0, 0, 56, 97, 117, 120, 67, 0, 0, 0, 0, 117, 114, 110, 58, 109, 112, 101, 103, 58, 109, 112, 101, 103, 66, 58, 99,
    105, 99, 112, 58, 115, 121, 115, 116, 101, 109, 115, 58, 97, 117, 120, 105, 108, 105, 97, 114, 121, 58, 97, 108, 112, 104, 97,
    0, 0, 0, 0, 30, 105, 112, 109, 97, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 4, 1, 2, 131, 4, 0, 2, 4, 1, 5, 134, 7, 0, 0, 0, 83, 109, 100,
    97, 116, 18, 0, 10, 4, 24, 0, 38, 21, 50, 14, 16, 0, 134, 210, 137, 41, 29, 31, 115, 221, 207, 119, 62, 216, 18, 0, 10, 7, 56,
    0, 38, 16, 32, 32, 9, 50, 38, 16, 0, 0, 139, 187, 21, 149, 176, 122, 96, 233, 220, 137, 220, 138, 92, 0, 22, 255, 213, 125, 242,
    229, 127, 189, 239, 149, 147, 37, 151, 177, 245, 29, 222, 125, 239, 124, 54};

/* 4x4, about (200, 100, 50) everywhere, as Basis Universal packs it: ETC1S with BasisLZ, and UASTC with Zstandard. */
static const unsigned char ktx2_etc1s[316] = {
    171, 75, 84, 88, 32, 50, 48, 187, 13, 10, 26, 10, 0, 0, 0, 0, 1, 0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0,
    0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 104, 0, 0, 0, 44, 0, 0, 0, 148, 0, 0, 0, 36, 0, 0, 0, 184, 0, 0, 0, 0, 0, 0, 0, 131, 0, 0, 0, 0,
    0, 0, 0, 59, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 44, 0, 0, 0, 0, 0, 0, 0, 2, 0, 40, 0, 163, 1,
    2, 0, 3, 3, 0, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 63, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 31, 0, 0, 0, 75, 84, 88, 119,
    114, 105, 116, 101, 114, 0, 66, 97, 115, 105, 115, 32, 85, 110, 105, 118, 101, 114, 115, 97, 108, 32, 50, 46, 49, 48, 0, 0, 1,
    0, 1, 0, 43, 0, 0, 0, 5, 0, 0, 0, 43, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 192,
    4, 0, 0, 0, 0, 0, 0, 162, 3, 152, 18, 0, 0, 0, 0, 0, 130, 170, 11, 76, 4, 0, 19, 0, 0, 0, 0, 0, 0, 136, 0, 96, 2, 0, 0, 0, 0, 0,
    0, 65, 6, 84, 85, 85, 85, 5, 0, 193, 68, 0, 0, 0, 0, 0, 0, 242, 95, 45, 0, 152, 0, 0, 0, 0, 0, 0, 64, 8, 0, 19, 0, 2, 0, 0, 0,
    0, 136, 1, 192, 4, 0, 0, 0, 0, 0, 0, 2, 8, 0, 0};
static const unsigned char ktx2_uastc[209] = {
    171, 75, 84, 88, 32, 50, 48, 187, 13, 10, 26, 10, 0, 0, 0, 0, 1, 0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0,
    0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 104, 0, 0, 0, 44, 0, 0, 0, 148, 0, 0, 0, 36, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 184, 0, 0, 0, 0, 0, 0, 0, 25, 0, 0, 0, 0, 0, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 44, 0, 0, 0, 0, 0, 0, 0, 2, 0, 40, 0, 166, 1, 2,
    0, 3, 3, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 127, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 31, 0, 0, 0, 75, 84, 88, 119,
    114, 105, 116, 101, 114, 0, 66, 97, 115, 105, 115, 32, 85, 110, 105, 118, 101, 114, 115, 97, 108, 32, 50, 46, 49, 48, 0, 0, 40,
    181, 47, 253, 32, 16, 129, 0, 0, 23, 153, 76, 230, 63, 181, 138, 0, 0, 0, 0, 0, 0, 0, 0, 0};

static const char required[] = TRIANGLE("", "", "", ",'extensionsUsed':['@ext@'],'extensionsRequired':['@ext@']");

static char *named(const char *json, const char *extension)
{
    char *once = replace(json, "@ext@", extension), *twice = replace(once, "@ext@", extension);
    free(once);
    return twice;
}

static void test_silent(void)
{
    static const char *const names[] = {"KHR_xmp_json_ld", "KHR_interactivity", "KHR_audio_emitter", "KHR_physics_rigid_bodies", "KHR_implicit_shapes",
                                        "FB_ngon_encoding", "EXT_structural_metadata", "EXT_mesh_features", "KHR_node_selectability"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        ec_error err;
        char *json = named(required, names[i]);
        ec_scene *s = load_text(json, triangle_blobs, &err);
        CHECK_MSG(s && !strstr(messages, "W "), "%s: %s%s", names[i], err.text, messages);
        CHECK_MSG(!s || (s->contents.extensions.count == 1 && s->contents.ignored.count == 0), "%s", names[i]);
        ec_scene_free(s);
        free(json);
    }
}

static void test_refused(void)
{
    char *json = named(required, "KHR_texture_procedurals");
    expect_failure(json, triangle_blobs, "requires KHR_texture_procedurals, which eclat does not support; export it without");
    free(json);
}

/* Coarser nodes that another node lists are not shown, wherever they are, nor is anything below them. */
static void test_lod(void)
{
    static const char *const scenes[] = {",'scenes':[{'nodes':[0]}]", ",'scenes':[{'nodes':[0,1,2]}]", ""};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        ec_error err;
        char *json = replace("{'asset':{'version':'2.0'},'extensionsUsed':['MSFT_lod'],'extensionsRequired':['MSFT_lod']@scenes@,'nodes':["
                             "{'mesh':0,'extensions':{'MSFT_lod':{'ids':[1,2]}}},{'mesh':0},{'children':[3]},{'mesh':0}],"
                             "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                             "'buffers':[{'byteLength':36,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':36}],"
                             "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}]}", "@scenes@", scenes[i]);
        ec_scene *s = load_text(json, triangle_blobs, &err);
        CHECK_MSG(s && s->triangle_count == 1 && !strstr(messages, "W "), "%s: %s%s", scenes[i], err.text, messages);
        ec_scene_free(s);
        free(json);
    }
    expect_failure(TRIANGLE(",'extensions':{'MSFT_lod':{'ids':[7]}}", "", "", ""), triangle_blobs, "MSFT_lod.ids[0] is 7 but the file has 1 nodes");
}

static const char textured[] = TRIANGLE("", ",'TEXCOORD_0':1", ",'material':0",
                                        ",'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}],'images':[{'uri':'@avif@'}],"
                                        "'textures':[@texture@],'extensionsUsed':['EXT_texture_avif']@needed@");

static ec_scene *load_avif(const char *texture, const char *needed, size_t bytes, ec_error *err)
{
    const blob with[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {"@avif@", avif_two, bytes}, {0}};
    char *uv = replace(textured, "'type':'VEC3'}]", "'type':'VEC3'},{'bufferView':0,'componentType':5126,'count':3,'type':'VEC2'}]");
    char *one = replace(uv, "@texture@", texture), *json = replace(one, "@needed@", needed);
    ec_scene *s = load_text(json, with, err);
    free(uv);
    free(one);
    free(json);
    return s;
}

static void test_avif(void)
{
    static const uint8_t texels[8] = {10, 200, 30, 255, 40, 50, 60, 128};
    static const char texture[] = "{'extensions':{'EXT_texture_avif':{'source':0}}}", needed[] = ",'extensionsRequired':['EXT_texture_avif']";
    ec_error err;
    ec_scene *s = load_avif(texture, needed, sizeof avif_two, &err);
    if (!ec_has_avif) {
        CHECK_MSG(!s && strstr(err.text, "requires EXT_texture_avif, which this eclat was built without; install libavif-dev"), "%s", err.text);
        s = load_avif("{'source':0}", "", sizeof avif_two, &err);
        CHECK_MSG(s && strstr(messages, "it is AVIF, which this eclat was built without (libavif-dev)"), "%s", messages);
        ec_scene_free(s);
        return;
    }
    CHECK_MSG(s && s->image_count == 1 && s->images[0].width == 2 && s->images[0].height == 1 && !memcmp(s->images[0].rgba8, texels, 8), "%s%s", err.text,
              messages);
    ec_scene_free(s);
    for (size_t length = 12; length < sizeof avif_two; length += 37) { /* also where nothing states the format */
        s = load_avif("{'source':0}", "", length, &err);
        CHECK_MSG(s && (s->image_count == 1 || strstr(messages, "cannot be decoded")), "%zu bytes: %s", length, messages);
        ec_scene_free(s);
    }
}

static void expect_ktx2(const unsigned char *bytes, size_t size, double tolerance)
{
    static const int expected[4] = {200, 100, 50, 255};
    ec_image image = {0};
    ec_decode_error err = {""};
    CHECK_MSG(ec_image_decode(bytes, size, &image, &err), "%s", err.text);
    CHECK(image.width == 4 && image.height == 4);
    for (int i = 0; image.rgba8 && i < 64; i++) CHECK_NEAR(image.rgba8[i], expected[i % 4], tolerance);
    ec_image_free(&image);
    for (size_t cut = 12; cut < size; cut += 7) {
        err.text[0] = 0;
        image = (ec_image){0};
        const bool ok = ec_image_decode(bytes, cut, &image, &err);
        CHECK_MSG(ok == (image.rgba8 != NULL) && (ok || err.text[0]), "%zu bytes", cut);
        ec_image_free(&image);
    }
}

/* A level that claims 2 GiB: the transcoder would clear as much memory before checking. */
static void expect_claim_refused(void)
{
    unsigned char bytes[sizeof ktx2_uastc];
    ec_image image = {0};
    ec_decode_error err = {""};
    struct rusage before, after;
    memcpy(bytes, ktx2_uastc, sizeof bytes);
    memcpy(bytes + 96, (const unsigned char[4]){0, 0, 255, 127}, 4);
    getrusage(RUSAGE_SELF, &before);
    CHECK(!ec_image_decode(bytes, sizeof bytes, &image, &err));
    getrusage(RUSAGE_SELF, &after);
    CHECK_MSG(strstr(err.text, "broken or truncated"), "%s", err.text);
    CHECK_MSG(after.ru_maxrss - before.ru_maxrss < 1 << 20, "%ld KiB more", after.ru_maxrss - before.ru_maxrss);
}

static void test_ktx2(void)
{
    char *json = named(required, "KHR_texture_basisu");
    if (!ec_has_basisu) {
        ec_image image = {0};
        ec_decode_error err = {""};
        expect_failure(json, triangle_blobs, "requires KHR_texture_basisu, which this eclat was built without; install Basis Universal's source");
        CHECK(!ec_image_decode(ktx2_uastc, sizeof ktx2_uastc, &image, &err));
        CHECK_MSG(strstr(err.text, "it is KTX2, which this eclat was built without"), "%s", err.text);
    } else {
        ec_error err;
        ec_scene *s = load_text(json, triangle_blobs, &err);
        CHECK_MSG(s != NULL, "%s", err.text);
        ec_scene_free(s);
        expect_ktx2(ktx2_etc1s, sizeof ktx2_etc1s, 8);
        expect_ktx2(ktx2_uastc, sizeof ktx2_uastc, 2);
        expect_claim_refused();
    }
    free(json);
}

/* The filter COLOR of KHR_meshopt_compression, on elements as its specification's encoder leaves them. */
static void test_meshopt_color(void)
{
    /* Attributes of version 0 with deltas of 0: twice the element that is at the end. */
    static const struct {
        uint8_t stride, element[8], expected[8];
    } cases[] = {
        /* K = 8: Y 100, Co 20, Cg -30, alpha 127 of 7 bits and the bit above: scale 255 */
        {4, {100, 20, 226, 255}, {150, 70, 110, 255}},
        /* K = 3: Y 3, Co 1, Cg -2, alpha 1: scale 7; 6, 1, 4 and 3 of 7 */
        {4, {3, 1, 254, 5}, {219, 36, 146, 109}},
        /* the first again, in 16 bits: 150, 70, 110 and 255 of 255 */
        {8, {100, 0, 20, 0, 226, 255, 255, 0}, {150, 150, 70, 70, 110, 110, 255, 255}},
    };
    for (size_t i = 0; ec_has_meshopt && i < sizeof cases / sizeof *cases; i++) {
        uint8_t packed[1 + 8 + 32] = {0xa0}, out[16 * 8 + 256] = {0};
        const uint32_t stride = cases[i].stride, tail = stride < 32 ? 32 : stride, length = 1 + stride + tail;
        memcpy(packed + 1 + tail, cases[i].element, stride);
        const ec_gltf_meshopt p = {.mode = EC_MESHOPT_ATTRIBUTES, .filter = EC_MESHOPT_COLOR, .count = 2, .stride = stride, .length = length};
        CHECK_MSG(ec_meshopt_decode(&p, packed, out), "case %zu", i);
        for (uint32_t k = 0; k < 2 * stride; k++)
            CHECK_MSG(out[k] == cases[i].expected[k % stride], "case %zu: byte %u is %u, not %u", i, k, out[k], cases[i].expected[k % stride]);
    }
}

/* A missing image is an error only for a texture that a material uses. */
static void test_dangling_source(void)
{
    ec_error err;
    const char *unused = TRIANGLE("", "", "", ",'textures':[{'source':7}]");
    ec_scene *s = load_text(unused, triangle_blobs, &err);
    CHECK_MSG(s && strstr(messages, "W ") && strstr(messages, "textures[0].source is 7 but the file has 0 images; no material uses it"), "%s%s", err.text,
              messages);
    ec_scene_free(s);
    expect_failure(TRIANGLE("", "", "", ",'textures':[{'source':7}],'materials':[{'extensions':{'KHR_materials_sheen':{'sheenColorTexture':{'index':0}}}}]"),
                   triangle_blobs, "textures[0].source is 7 but the file has 0 images");
}

int main(void)
{
    test_silent();
    test_refused();
    test_lod();
    test_avif();
    test_ktx2();
    test_meshopt_color();
    test_dangling_source();
    TEST_END();
}
