/* tier: quick */
/* Broken files: one clear line each. Nothing is opened, allocated or looped over because a broken file says so. */
#include <sys/stat.h>

#include "test_scene_files.h"
#include "gltf/reader.h"

static void expect_bytes_failure(const void *bytes, size_t size, const char *needle)
{
    ec_error err;
    ec_scene *s = load_bytes(bytes, size, ".glb", &err);
    CHECK_MSG(!s, "loaded, expected \"%s\"", needle);
    CHECK_MSG(strstr(err.text, needle) != NULL, "\"%s\" does not say \"%s\"", err.text, needle);
    ec_scene_free(s);
}

static void test_uris(void)
{
    /* The targets exist, so that each failure is a refusal and not a missing file. */
    write_file(ECLAT_TEST_OUT "/../scene_secret.bin", triangle_positions, 36);
    write_file(ECLAT_TEST_OUT "/scene plain.bin", triangle_positions, 36);
    write_file(ECLAT_TEST_OUT "/scene \xe2\x99\xbb.bin", triangle_positions, 36);
    const char *refused[] = {"../scene_secret.bin", "%2e%2e/scene_secret.bin", "..%2Fscene_secret.bin",
                             "%2E%2E%2Fscene_secret.bin", "x/../../scene_secret.bin", "./../scene_secret.bin",
                             "x//..//..//scene_secret.bin", "/etc/passwd", "%2Fetc/passwd", "//host/share", "file:///etc/passwd",
                             "FILE:/etc/passwd", "file%3A///etc/passwd", "http://example.org/a.bin",
                             "https://example.org/a.bin", "ftp://example.org/a", "c:/windows/win.ini", "..\\\\scene_secret.bin",
                             "..%5Cscene_secret.bin", "\\\\\\\\host\\\\share", "a%00.bin", ""};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        char *json = replace(TRIANGLE("", "", "", ""), "@pos@", refused[i]);
        expect_failure(json, NULL, "refusing URI");
        free(json);
    }
    const char *allowed[] = {"scene%20plain.bin", "scene plain.bin", "./scene%20plain.bin", "x/../scene%20plain.bin",
                             "scene%20%E2%99%BB.bin", "scene \xe2\x99\xbb.bin"};
    mkdir(ECLAT_TEST_OUT "/x", 0777);
    for (size_t i = 0; i < sizeof allowed / sizeof *allowed; i++) {
        char *json = replace(TRIANGLE("", "", "", ""), "@pos@", allowed[i]);
        ec_error err;
        ec_scene *s = load_text(json, NULL, &err);
        CHECK_MSG(s != NULL, "%s: %s", allowed[i], err.text);
        ec_scene_free(s);
        free(json);
    }
    /* An image may not lead outside either, even one that nothing uses. */
    expect_failure(TRIANGLE("", "", "", ",'images':[{'uri':'../a.png'}]"), triangle_blobs, "images[0]: refusing URI");
    remove(ECLAT_TEST_OUT "/../scene_secret.bin");
    remove(ECLAT_TEST_OUT "/scene plain.bin");
    remove(ECLAT_TEST_OUT "/scene \xe2\x99\xbb.bin");
    rmdir(ECLAT_TEST_OUT "/x");
}

static void test_buffers(void)
{
    static const struct {
        const char *from, *to, *message;
    } cases[] = {
        {"@pos@", "no-such-file.bin", "buffers[0]"},
        {"@pos@", "no-such-file.bin", "No such file"},
        {"@pos@", ".", "not a regular file"},
        {"@pos@", "data:;base64,AAAA", "promises 36 bytes but holds 3"},
        {"@pos@", "data:;base64,AA*A", "base64 is broken"},
        {",'uri':'@pos@'", "", "neither uri nor binary chunk"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *json = replace(TRIANGLE("", "", "", ""), cases[i].from, cases[i].to);
        expect_failure(json, NULL, cases[i].message);
        free(json);
    }
}

/* Each pair: what to replace in a good file by what, and what the message must say. */
static void test_defects(void)
{
    static const struct {
        const char *good, *bad, *message;
    } cases[] = {
        {"'count':3", "'count':4", "accessors[0] needs 4 elements"},
        {"'count':3", "'count':2147483648", "claims 2147483648 vertices"},
        {"'count':3", "'count':9007199254740991", "at most 2147483647"},
        {"'count':3", "'count':18446744073709551615", "accessors[0].count is out of range"},
        {"'count':3", "'count':1e300", "accessors[0].count"},
        {"'count':3", "'count':-3", "accessors[0].count must be a non-negative integer"},
        {"'count':3", "'count':0", "accessors[0].count is out of range"},
        {"'count':3", "'count':3.5", "accessors[0].count"},
        {"'count':3", "'count':'3'", "accessors[0].count"},
        {"'count':3,", "", "accessors[0].count is missing"},
        {"'bufferView':0,'componentType':5126,'count':3", "'componentType':5126,'count':2000000000", "without a bufferView"},
        {"5126", "5125", "does not allow"},
        {"5126", "5124", "accessors[0].componentType is 5124"},
        {"5126", "5122", "does not allow"},
        {"'VEC3'", "'VEC2'", "does not allow"},
        {"'VEC3'", "'MAT3'", "type other than"},
        {"'VEC3'", "'VEC5'", "type other than"},
        {"'buffer':0,", "'buffer':1,", "bufferViews[0].buffer is 1 but the file has 1 buffers"},
        {"'buffer':0,'byteLength':36", "'buffer':0,'byteLength':37", "reaches beyond buffers[0]"},
        {"'buffer':0,'byteLength':36", "'buffer':0,'byteLength':9007199254740992,'byteOffset':9007199254740992", "reaches beyond"},
        {"'buffer':0,'byteLength':36", "'buffer':0,'byteLength':36,'byteStride':8", "byteStride 8"},
        {"'buffer':0,'byteLength':36", "'buffer':0,'byteLength':36,'byteStride':14", "multiple of 4"},
        {"'buffer':0,'byteLength':36", "'buffer':0,'byteLength':36,'byteStride':256", "byteStride is out of range"},
        {"'POSITION':0", "'POSITION':1", "meshes[0].primitives[0].attributes.POSITION is 1"},
        {"'POSITION':0", "'POSITION':-1", "must be a non-negative integer"},
        {"'POSITION':0", "'NORMAL':0", "nothing to render"},
        {"'POSITION':0}", "'POSITION':0},'indices':0", "unsigned integer scalars"},
        {"'POSITION':0}", "'POSITION':0},'indices':7", "indices is 7"},
        {"'POSITION':0}", "'POSITION':0},'material':0", "material is 0 but the file has 0 materials"},
        {"'mesh':0", "'mesh':1", "nodes[0].mesh is 1"},
        {"'mesh':0", "'camera':0", "nodes[0].camera is 0"},
        {"'mesh':0", "'mesh':0,'matrix':[1,2,3]", "must have 16 numbers"},
        {"'mesh':0", "'mesh':0,'translation':[1,2,'x']", "translation[2] must be a number"},
        {"'mesh':0", "'mesh':0,'translation':[1,2,1e39]", "too large"},
        {"'mesh':0", "'mesh':0,'children':[0]", "a cycle through nodes[0]"},
        {"'mesh':0", "'mesh':0,'children':[9]", "children[0] is 9"},
        {"'nodes':[0]", "'nodes':[1]", "scenes[0].nodes[0] is 1"},
        {"'nodes':[0]", "'nodes':[0,0]", "twice"},
        {"'nodes':[0]", "'nodes':[]", "nothing to render"},
        {"'nodes':[{", "'scene':3,'nodes':[{", "scene is 3"},
        {"'nodes':[{", "'nodes':7,'x':[{", "nodes must be an array"},
        {"'version':'2.0'", "'version':'1.0'", "glTF version 1.0 is not supported"},
        {"'version':'2.0'", "'version':'2.1','minVersion':'2.1'", "needs glTF 2.1"},
        {"'version':'2.0'", "'version':2.0", "asset.version must be a string"},
        {"'asset':{'version':'2.0'},", "", "asset is missing"},
        {"'asset'", "'extensionsRequired':['KHR_texture_procedurals','EXT_x'],'asset'", "requires EXT_x, KHR_texture_procedurals"},
        {"}]}", "}]", "not valid JSON"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *good = TRIANGLE("", "", "", "");
        CHECK_MSG(strstr(good, cases[i].good) != NULL, "nothing to replace: %s", cases[i].good);
        char *bad = replace(good, cases[i].good, cases[i].bad);
        expect_failure(bad, triangle_blobs, cases[i].message);
        free(bad);
    }
}

static void test_trees(void)
{
    ec_error err;
    expect_failure(TRIANGLE(",'children':[1]},{'children':[0]", "", "", ""), triangle_blobs, "cycle");
    expect_failure(TRIANGLE(",'children':[1,2]},{'children':[2]},{'mesh':0", "", "", ""), triangle_blobs,
                   "nodes[2] is a child of nodes[0] and of nodes[1]");
    expect_failure("{'asset':{'version':'2.0'},'nodes':[{'children':[1]},{'children':[0]}]}", NULL, "cycle");
    /* A chain of 200 000 nodes is deep, but valid. */
    enum { DEPTH = 200000 };
    char *nodes = malloc(DEPTH * 32), *at = nodes;
    for (int i = 1; i < DEPTH; i++) at += sprintf(at, "%s{'children':[%d]}", i > 1 ? "," : "", i + 1);
    sprintf(at, ",{'mesh':0}");
    char *mark = replace(TRIANGLE(",'children':[1]},@nodes@,{'name':'last'", "", "", ""), "@nodes@", nodes);
    ec_scene *s = load_text(mark, triangle_blobs, &err);
    CHECK_MSG(s && s->triangle_count == 2, "%s", err.text);
    ec_scene_free(s);
    free(mark);
    free(nodes);
}

static void test_deep_json(void)
{
    enum { DEPTH = 1000000 };
    char *text = malloc(DEPTH + 64);
    int used = sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"extras\":");
    memset(text + used, '[', DEPTH);
    expect_bytes_failure(text, (size_t)used + DEPTH, "nested more than");
    free(text);
}

static void put_word(unsigned char *at, uint32_t word)
{
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(word >> 8 * i);
}

/* A good .glb; returns its size. */
static size_t make_glb(unsigned char *out)
{
    char *with_chunk = replace(TRIANGLE("", "", "", ""), ",'uri':'@pos@'", ""), *json = from_single_quotes(with_chunk);
    size_t length = strlen(json), padded = (length + 3) & ~(size_t)3;
    memset(out + 20, ' ', padded);
    memcpy(out + 20, json, length);
    memcpy(out, "glTF", 4);
    put_word(out + 4, 2);
    put_word(out + 12, (uint32_t)padded);
    memcpy(out + 16, "JSON", 4);
    unsigned char *chunk = out + 20 + padded;
    put_word(chunk, 36);
    memcpy(chunk + 4, "BIN\0", 4);
    memcpy(chunk + 8, triangle_positions, 36);
    put_word(out + 8, (uint32_t)(20 + padded + 44));
    free(json);
    free(with_chunk);
    return 20 + padded + 44;
}

static void test_glb(void)
{
    unsigned char glb[2048], copy[2048];
    size_t size = make_glb(glb);
    ec_error err;
    ec_scene *s = load_bytes(glb, size, ".gltf", &err); /* the type comes from the content, not from the name */
    CHECK_MSG(s && s->triangle_count == 1, "%s", err.text);
    ec_scene_free(s);
    for (size_t cut = 0; cut < size; cut++) {
        s = load_bytes(glb, cut, ".glb", &err);
        CHECK_MSG(!s && err.text[0], "a .glb cut to %zu of %zu bytes loads", cut, size);
        ec_scene_free(s);
    }
    expect_bytes_failure(glb, size - 1, "truncated .glb");
    expect_bytes_failure(glb, 0, "empty");
    for (size_t at = 4; at < 20; at += 4) {
        static const uint32_t words[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffc};
        for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
            memcpy(copy, glb, size);
            put_word(copy + at, words[i]);
            s = load_bytes(copy, size, ".glb", &err);
            CHECK_MSG(!s, "header word at %zu set to %u loads", at, words[i]);
            ec_scene_free(s);
        }
    }
    memcpy(copy, glb, size);
    put_word(copy + size - 44, 0xfffffff0);
    expect_bytes_failure(copy, size, "its binary chunk promises");
}

/* Many instances of a mesh of 100 000 triangles for which the file has no bytes. */
static void test_bomb(int instances, const char *message)
{
    char *json = malloc(1 << 20), *at = json;
    at += sprintf(at, "{'asset':{'version':'2.0'},'nodes':[");
    for (int i = 0; i < instances; i++) at += sprintf(at, "%s{'mesh':0}", i ? "," : "");
    sprintf(at, "],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                "'accessors':[{'componentType':5126,'count':300000,'type':'VEC3'}]}");
    expect_failure(json, NULL, message);
    free(json);
}

static void test_bombs(void)
{
    test_bomb(30000, "more than 2147483647 triangles");
    double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (memory < 30e9) test_bomb(7000, "this machine has"); /* 36 GB */
}

int main(void)
{
    ec_error err;
    ec_scene *s;
    CHECK(ec_scene_load("/no/such/scene.glb", &s, NULL, &err) == EC_FAILED && !s && strstr(err.text, "cannot open"));
    CHECK(ec_scene_load("/dev/zero", &s, NULL, &err) == EC_FAILED && !s && strstr(err.text, "not a regular file"));
    test_uris();
    test_buffers();
    test_defects();
    test_trees();
    test_deep_json();
    test_glb();
    test_bombs();
    TEST_END();
}
