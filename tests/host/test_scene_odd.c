/* tier: quick */
/* Mistakes in a file that still allow a picture give one warning each, which names the place. */
#include <float.h>

#include "test_scene_files.h"

/* Loads the file; its only warning must contain `needle`; "": no warning. */
static ec_scene *expect_warning(const char *quoted, const blob *blobs, const char *needle)
{
    ec_error err;
    ec_scene *s = load_text(quoted, blobs, &err);
    const char *first = strstr(messages, "W "), *second = first ? strstr(first + 2, "\nW ") : NULL;
    CHECK_MSG(s != NULL, "\"%s\": %s", needle, err.text);
    CHECK_MSG(*needle ? first && !second && strstr(first, needle) : !first, "warns \"%s\", not \"%s\"", messages, needle);
    return s;
}

static void test_left_over(void)
{
    static const float four[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const blob blobs[] = {{"@pos@", four, sizeof four}, {0}};
    static const struct {
        const char *mode, *count, *says;
        uint32_t triangles;
    } cases[] = {{"4", "3", "", 1}, {"4", "4", "1 primitives have leftover vertices, too few for a triangle; these are left out", 1}, {"5", "4", "", 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char mode[32], count[32];
        snprintf(mode, sizeof mode, ",'mode':%s", cases[i].mode);
        snprintf(count, sizeof count, "'count':%s", cases[i].count);
        char *json = replace(TRIANGLE("", "", "@mode@", ""), "@mode@", mode), *with = replace(json, "'count':3", count);
        char *longer = replace(with, "'byteLength':36", "'byteLength':48"), *views = replace(longer, "'byteLength':36", "'byteLength':48");
        ec_scene *s = expect_warning(views, blobs, cases[i].says);
        CHECK_MSG(!s || s->triangle_count == cases[i].triangles, "case %zu", i);
        ec_scene_free(s);
        free(json), free(with), free(longer), free(views);
    }
}

static void test_normals(void)
{
    static const char json[] = "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'meshes':[{'name':'odd','primitives':[{'attributes':{"
                               "'POSITION':0,'NORMAL':1}}]}],'buffers':[{'byteLength':36,'uri':'@pos@'},{'byteLength':36,'uri':'@normal@'}],"
                               "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':1,'byteLength':36}],'accessors':["
                               "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},{'bufferView':1,'componentType':5126,'count':3,'type':'VEC3'}]}";
    float normals[9] = {NAN, 0, 1, 0, 0, INFINITY, 0, 0, 0}; /* zero is allowed: it means none */
    const blob blobs[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {"@normal@", normals, sizeof normals}, {0}};
    ec_scene_free(expect_warning(json, blobs, "2 normals are NaN or infinite, the first in meshes[0] \"odd\"; the triangles' own normals are used instead"));
    for (int i = 0; i < 9; i++) normals[i] = i % 3 == 2;
    ec_scene_free(expect_warning(json, blobs, ""));
}

static void test_far_positions(void)
{
    static const float far[9] = {0, 0, 0, 1e38f, 0, 0, 0, 1, 0};
    const blob blobs[] = {{"@pos@", far, sizeof far}, {0}};
    expect_failure(TRIANGLE("", "", "", ""), blobs, "of 1 triangles, 0 have no area and 1 have positions that are NaN, infinite or beyond 1e18");
}

static void test_matrices(void)
{
    static const char node[] = ",'name':'warped','matrix':[1,0,0,@,0,1,0,0,0,0,1,0,0,0,0,1]";
    char *json = replace(TRIANGLE("#", "", "", ""), "#", node), *plain = replace(json, "@", "0"), *warped;
    /* the first mark is in the node; "@pos@" is the mark of the positions */
    ec_scene_free(expect_warning(plain, triangle_blobs, ""));
    warped = replace(json, "@", "0.5");
    ec_scene_free(expect_warning(warped, triangle_blobs, "nodes[0] \"warped\" has a projective matrix, which glTF does not allow; its last row is taken as 0 0 0 1"));
    free(json), free(plain), free(warped);
}

static void test_aspects(void)
{
    static const struct {
        const char *ratio, *says;
        float aspect;
    } cases[] = {{"2", "", 2},
                 {"0", "cameras[0]: aspectRatio 0 is out of range; it is ignored", 0},
                 {"1e30", "cameras[0]: aspectRatio 1e+30 is out of range; it is ignored", 0},
                 {"1e-30", "cameras[0]: aspectRatio 1e-30 is out of range; it is ignored", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *json = replace(TRIANGLE(",'camera':0", "", "", ",'cameras':[{'type':'perspective','perspective':{'yfov':1,'aspectRatio':@ratio@}}]"), "@ratio@",
                             cases[i].ratio);
        ec_scene *s = expect_warning(json, triangle_blobs, cases[i].says);
        CHECK_MSG(!s || s->cameras[0].aspect == cases[i].aspect, "case %zu", i);
        ec_scene_free(s);
        free(json);
    }
}

int main(void)
{
    test_left_over();
    test_normals();
    test_far_positions();
    test_matrices();
    test_aspects();
    TEST_END();
}
