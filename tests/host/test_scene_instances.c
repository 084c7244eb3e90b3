/* tier: quick */
/* EXT_mesh_gpu_instancing: the mesh is at every listed place, in the node's frame, and not at the node itself. */
#include "test_scene_files.h"

/* Two places: moved by (1, 2, 3) at the original size; at the origin, rotated by 90 degrees about z and three times as large. */
static const struct {
    float translation[6], scale[6];
    int16_t rotation[8];
} places = {{1, 2, 3, 0, 0, 0}, {1, 1, 1, 3, 3, 3}, {0, 0, 0, 32767, 0, 0, 23170, 23170}};
static const blob blobs[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {"@places@", &places, sizeof places}, {0}};

static const char instanced[] =
    "{'asset':{'version':'2.0'},'extensionsUsed':['EXT_mesh_gpu_instancing'],'extensionsRequired':['EXT_mesh_gpu_instancing'],"
    "'scenes':[{'nodes':[0]}],'cameras':[{'type':'perspective','perspective':{'yfov':1}}],'nodes':[{'mesh':0,'camera':0,'scale':[1,1,2],"
    "'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{'TRANSLATION':1,'ROTATION':2,'SCALE':3,'_ID':1}}}}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
    "'buffers':[{'byteLength':36,'uri':'@pos@'},{'byteLength':64,'uri':'@places@'}],"
    "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':1,'byteLength':64}],'accessors':["
    "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},{'bufferView':1,'componentType':5126,'count':2,'type':'VEC3'},"
    "{'bufferView':1,'byteOffset':48,'componentType':5122,'normalized':true,'count':2,'type':'VEC4'},"
    "{'bufferView':1,'byteOffset':24,'componentType':5126,'count':2,'type':'VEC3'}]}";

static void test_places(void)
{
    /* corner 1 is (1, 0, 0) in the mesh, corner 0 the origin; the node doubles z */
    static const double expected[2][2][3] = {{{1, 2, 6}, {2, 2, 6}}, {{0, 0, 0}, {0, 3, 0}}};
    ec_error err;
    ec_scene *s = load_text(instanced, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    CHECK(s->triangle_count == 2 && s->instance_count == 2 && s->camera_count == 1);
    for (uint32_t t = 0; t < 2; t++)
        for (uint32_t corner = 0; corner < 2; corner++) {
            double found[3];
            world_corner(s, t, corner, found);
            for (int k = 0; k < 3; k++) CHECK_NEAR(found[k], expected[t][corner][k], 1e-6);
        }
    ec_scene_free(s);
}

/* Zeros except for the sparse part: three places, of which the file moves the first and the last. */
static void test_sparse(void)
{
    static const struct {
        uint16_t indices[4];
        float values[6];
    } moved = {{0, 2}, {1, 2, 3, 4, 5, 6}};
    const blob sparse[] = {blobs[0], {"@places@", &moved, sizeof moved}, {0}};
    static const double expected[3][3] = {{1, 2, 6}, {0, 0, 0}, {4, 5, 12}};
    char *one = replace(instanced, "'ROTATION':2,'SCALE':3,", ""), *sized = replace(one, "'byteLength':64,'uri'", "'byteLength':32,'uri'"),
         *viewed = replace(sized, "{'buffer':1,'byteLength':64}", "{'buffer':1,'byteLength':8},{'buffer':1,'byteOffset':8,'byteLength':24}"),
         *json = replace(viewed, "{'bufferView':1,'componentType':5126,'count':2,'type':'VEC3'}",
                         "{'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':2,'indices':{'bufferView':1,'componentType':5123},"
                         "'values':{'bufferView':2}}}");
    ec_error err;
    ec_scene *s = load_text(json, sparse, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) CHECK(s->triangle_count == 3);
    for (uint32_t t = 0; s && t < 3; t++) {
        double found[3];
        world_corner(s, t, 0, found);
        for (int k = 0; k < 3; k++) CHECK_NEAR(found[k], expected[t][k], 1e-6);
    }
    ec_scene_free(s);
    free(one), free(sized), free(viewed), free(json);
}

static void test_defects(void)
{
    static const struct {
        const char *good, *bad, *message;
    } cases[] = {
        {"'TRANSLATION':1", "'TRANSLATION':4", "attributes.TRANSLATION is 4"},
        {"'TRANSLATION':1", "'TRANSLATION':0", "accessors[2] has 2 elements, but another attribute has 3"},
        {"'ROTATION':2", "'ROTATION':1", "must hold vectors of 4 floats"},
        {"'normalized':true,", "", "must hold vectors of 4 floats"},
        {"{'bufferView':1,'componentType':5126,'count':2", "{'componentType':5126,'count':9000000", "accessors[1] has no bufferView"},
        {"'byteOffset':24", "'byteOffset':48", "needs 2 elements"},
        {"{'attributes':{'TR", "{'x':{'TR", "attributes is missing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *json = replace(instanced, cases[i].good, cases[i].bad);
        CHECK_MSG(strcmp(json, instanced), "nothing to replace: %s", cases[i].good);
        expect_failure(json, blobs, cases[i].message);
        free(json);
    }
}

/* Attributes of an application's own do not define places: the mesh is at its node. */
static void test_no_places(void)
{
    char *json = replace(instanced, "'TRANSLATION':1,'ROTATION':2,'SCALE':3,", "");
    ec_error err;
    ec_scene *s = load_text(json, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) CHECK(s->triangle_count == 1 && s->instance_count == 1);
    ec_scene_free(s);
    free(json);
}

int main(void)
{
    test_places();
    test_no_places();
    test_sparse();
    test_defects();
    TEST_END();
}
