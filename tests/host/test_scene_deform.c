/* tier: quick */
/* Morph targets and skins against glTF's formulas, calculated by hand. */
#include "test_scene_files.h"

#define MESH(ATTRIBUTES, TARGETS, MEMBERS) "'meshes':[{'primitives':[{'attributes':{'POSITION':0" ATTRIBUTES "}" TARGETS "}]" MEMBERS "}]"

static void expect_corners(ec_scene *s, const double expected[9], const char *what)
{
    for (uint32_t i = 0; s && i < 9; i++) {
        double corner[3];
        world_corner(s, 0, i / 3, corner);
        CHECK_MSG(fabs(corner[i % 3] - expected[i]) < 1e-6, "%s: corner %u has %c = %g, expected %g", what, i / 3, "xyz"[i % 3], corner[i % 3],
                  expected[i]);
    }
}

/* Morphing ----------------------------------------------------------------------------------------------------------- */

static const struct morph_data {
    float position[9], normal[9], tangent[12], color[9], uv[6];
    float by[2][9], normal_by[9], tangent_by[9], color_by[9], uv_by[6];
} morph_data = {
    .position = {0, 0, 0, 1, 0, 0, 0, 1, 0}, .normal = {0, 0, 1, 0, 0, 1, 0, 0, 1}, .tangent = {1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1},
    .by = {{0, 0, 0, 2, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0, 0, 0, 4}}, .normal_by = {0, 2, 0, 0, 2, 0, 0, 2, 0},
    .tangent_by = {0, 0, 2, 0, 0, 2, 0, 0, 2}, .color_by = {1, 0.5f, 0, 1, 0.5f, 0, 1, 0.5f, 0}, .uv_by = {0.5f, 1, 0.5f, 1, 0.5f, 1}};
static const blob morph_blobs[] = {{"@pos@", &morph_data, sizeof morph_data}, {0}};

static const char morphing[] =
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"
    MESH(",'NORMAL':1,'TANGENT':2,'COLOR_0':3,'TEXCOORD_0':4",
         ",'targets':[{'POSITION':5,'NORMAL':7,'TANGENT':8,'COLOR_0':9,'TEXCOORD_0':10},{'POSITION':6}]", ",'weights':[0.5,0]")
    ",'buffers':[{'byteLength':384,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':384}],'accessors':["
    "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':72,'componentType':5126,'count':3,'type':'VEC4'},"
    "{'bufferView':0,'byteOffset':120,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':156,'componentType':5126,'count':3,'type':'VEC2'},"
    "{'bufferView':0,'byteOffset':180,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':216,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':252,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':288,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':324,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':360,'componentType':5126,'count':3,'type':'VEC2'}]}";

static ec_scene *load_changed(const char *json, const char *from, const char *to, const blob *blobs)
{
    ec_error err;
    char *changed = replace(json, from, to);
    CHECK_MSG(!*from || strcmp(changed, json), "nothing to replace: %s", from);
    ec_scene *s = load_text(changed, blobs, &err);
    CHECK_MSG(s != NULL, "%s: %s", to, err.text);
    free(changed);
    return s;
}

static void test_morph(void)
{
    /* The mesh's weights: half of the first target. */
    ec_scene *s = load_changed(morphing, "", "", morph_blobs);
    expect_corners(s, (double[9]){0, 0, 0, 2, 0, 0, 0, 1, 0}, "weights of the mesh");
    if (s) {
        /* (0, 1, 1) and (1, 0, 1) normalised; the tangent's sign is not morphed */
        const double half = sqrt(0.5), normal[3] = {0, half, half}, tangent[4] = {half, 0, half, -1};
        for (int k = 0; k < 3; k++) CHECK_NEAR(s->normals[k], normal[k], 1e-7);
        for (int k = 0; k < 4; k++) CHECK_NEAR(s->tangents[k], tangent[k], 1e-7);
        CHECK_NEAR(s->colors[0], 0.5, 0);
        CHECK_NEAR(s->colors[1], 0.25, 0);
        CHECK_NEAR(s->uv[0][0], 0.25, 0);
        CHECK_NEAR(s->uv[0][1], 0.5, 0);
    }
    ec_scene_free(s);
    /* The node's weights replace them, and the node's own transform still applies. */
    s = load_changed(morphing, "{'mesh':0}", "{'mesh':0,'weights':[1,0.25],'translation':[10,0,0]}", morph_blobs);
    expect_corners(s, (double[9]){10, 0, 0, 13, 0, 0, 10, 1, 1}, "weights of the node");
    ec_scene_free(s);
    s = load_changed(morphing, "{'mesh':0}", "{'mesh':0,'weights':[0,0]}", morph_blobs);
    expect_corners(s, (double[9]){0, 0, 0, 1, 0, 0, 0, 1, 0}, "no weight");
    ec_scene_free(s);
}

/* Two nodes show the mesh in its default pose: it is deformed once, and both places are right. */
static void test_morph_instances(void)
{
    ec_scene *s = load_changed(morphing, "[0]}],'nodes':[{'mesh':0}", "[0,1,2]}],'nodes':[{'mesh':0},{'mesh':0,'translation':[0,0,7]},{'mesh':0,'weights':[0,1]}",
                               morph_blobs);
    CHECK(s && s->triangle_count == 3);
    for (uint32_t t = 0; s && t < 3; t++) {
        double corner[3];
        world_corner(s, t, 1, corner);
        CHECK_NEAR(corner[0], t == 2 ? 1 : 2, 1e-6);
        CHECK_NEAR(corner[2], t == 1 ? 7 : 0, 1e-6);
    }
    ec_scene_free(s);
}

/* Skinning ----------------------------------------------------------------------------------------------------------- */

/* Joint 0 is at the origin. Joint 1 is at (0, 1, 0), rotated by 90 degrees about z, and was bound there without rotation. Corner 0 belongs
 * to joint 0, corner 1 to joint 1, corner 2 to both by halves. */
static const struct skin_data {
    float position[9], bind[32];
    uint8_t joints[12], weights[12], joints_1[12], weights_1[12];
    float normal[9];
} skin_data = {.position = {1, 0, 0, 0, 2, 0, 1, 2, 0},
               .bind = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
               .joints = {0, 9, 9, 9, 1, 0, 0, 0, 0, 1, 0, 0}, .weights = {255, 0, 0, 0, 255, 0, 0, 0, 51, 51, 0, 0},
               .joints_1 = {9, 1}, .weights_1 = {0, 255}, .normal = {1, 1, 0, 0, 1, 1, 1, 0, 0}};

static const char skinned[] =
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0,'skin':0,'translation':[5,6,7]},{'children':[2]},"
    "{'translation':[0,1,0],'rotation':[0,0,0.7071067811865476,0.7071067811865476]}],'skins':[{'joints':[1,2],'inverseBindMatrices':1}],"
    MESH(",'JOINTS_0':2,'WEIGHTS_0':3", "", "")
    ",'buffers':[{'byteLength':248,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':248}],'accessors':["
    "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':2,'type':'MAT4'},"
    "{'bufferView':0,'byteOffset':164,'componentType':5121,'count':3,'type':'VEC4'},"
    "{'bufferView':0,'byteOffset':176,'componentType':5121,'normalized':true,'count':3,'type':'VEC4'},"
    "{'bufferView':0,'byteOffset':188,'componentType':5121,'count':3,'type':'VEC4'},"
    "{'bufferView':0,'byteOffset':200,'componentType':5121,'normalized':true,'count':3,'type':'VEC4'},"
    "{'bufferView':0,'byteOffset':212,'componentType':5126,'count':3,'type':'VEC3'}]}";

static void test_skin(void)
{
    const blob blobs[] = {{"@pos@", &skin_data, sizeof skin_data}, {0}};
    /* (0, 2, 0) is 1 above joint 1 and so, after rotation, 1 to the left of it. (1, 2, 0) moves halfway to (-1, 2, 0). The mesh's node
     * moves nothing, and weights need not add up to 1. */
    ec_scene *s = load_changed(skinned, "", "", blobs);
    expect_corners(s, (double[9]){1, 0, 0, -1, 1, 0, 0, 2, 0}, "skin");
    ec_scene_free(s);
    /* A second set binds corner 0 to joint 1 as well, which moves (1, 0, 0) to (1, 2, 0). */
    s = load_changed(skinned, "'WEIGHTS_0':3", "'WEIGHTS_0':3,'JOINTS_1':4,'WEIGHTS_1':5", blobs);
    expect_corners(s, (double[9]){1, 1, 0, -1, 1, 0, 0, 2, 0}, "two sets");
    ec_scene_free(s);
    /* Normals are transformed by the inverse transpose: with twice the width, (1, 1, 0) becomes (1, 2, 0). */
    char *normals = replace(skinned, "'WEIGHTS_0':3", "'WEIGHTS_0':3,'NORMAL':6");
    s = load_changed(normals, "{'children':[2]}", "{'children':[2],'scale':[2,1,1]}", blobs);
    for (int k = 0; s && k < 3; k++) CHECK_NEAR(s->normals[k], ((double[3]){sqrt(0.2), sqrt(0.8), 0})[k], 1e-6);
    ec_scene_free(s);
    free(normals);
    /* Without inverse bind matrices these are identities: (0, 2, 0) is rotated to (-2, 0, 0) and raised. */
    s = load_changed(skinned, ",'inverseBindMatrices':1", "", blobs);
    expect_corners(s, (double[9]){1, 0, 0, -2, 1, 0, -0.5, 2, 0}, "no inverse bind matrices");
    ec_scene_free(s);
    /* Far from the origin positions keep their digits: 1e7 has a spacing of 1 as a float. */
    s = load_changed(skinned, "{'children':[2]}", "{'children':[2],'translation':[10000000,0,0]}", blobs);
    expect_corners(s, (double[9]){1e7 + 1, 0, 0, 1e7 - 1, 1, 0, 1e7, 2, 0}, "far away");
    ec_scene_free(s);
    /* A camera at the mesh's node stays there, once. */
    char *with_camera = replace(skinned, "'skin':0,", "'skin':0,'camera':0,");
    s = load_changed(with_camera, "'skins':", "'cameras':[{'type':'perspective','perspective':{'yfov':1}}],'skins':", blobs);
    CHECK(s && s->camera_count == 1);
    for (int k = 0; s && k < 3; k++) CHECK_NEAR(s->cameras[0].position[k] + s->center[k], 5 + k, 1e-6);
    ec_scene_free(s);
    free(with_camera);
}

/* A skeleton that mirrors: the front stays the front, as with a mirroring node. */
static void test_mirrored_skin(void)
{
    const blob blobs[] = {{"@pos@", &skin_data, sizeof skin_data}, {0}};
    double before[3], after[3];
    ec_scene *s = load_changed(skinned, "", "", blobs), *m = load_changed(skinned, "{'children':[2]}", "{'children':[2],'scale':[-1,1,1]}", blobs);
    if (s && m) {
        face_normal(s, 0, before);
        face_normal(m, 0, after);
        CHECK_NEAR(after[2], before[2], 1e-6); /* as large, and on the same side */
        CHECK(before[2] != 0);
    }
    ec_scene_free(s);
    ec_scene_free(m);
}

typedef struct defect {
    const char *good, *bad, *message;
} defect;

static void expect_defects(const char *json, const defect *cases, size_t count, const blob *blobs)
{
    for (size_t i = 0; i < count; i++) {
        char *changed = replace(json, cases[i].good, cases[i].bad);
        CHECK_MSG(strcmp(changed, json), "nothing to replace: %s", cases[i].good);
        expect_failure(changed, blobs, cases[i].message);
        free(changed);
    }
}

static void test_defects(void)
{
    static const defect morphs[] = {
        {"'weights':[0.5,0]", "'weights':[0,0,1]", "has 2 morph targets for 3 weights"},
        {"'weights':[0.5,0]", "'weights':['a']", "weights[0] must be a number"},
        {"{'POSITION':6}", "{'POSITION':11}", "targets[1].POSITION is 11 but the file has 11 accessors"},
        {"{'POSITION':5", "{'POSITION':4", "targets[0] POSITION: accessors[4] has 2 components"},
        {"{'POSITION':5", "{'POSITION':2", "targets[0] POSITION: accessors[2] has 4 components"},
        {"'byteOffset':180,'componentType':5126,'count':3", "'byteOffset':180,'componentType':5126,'count':2", "has 2 elements but POSITION has 3"},
        {"'byteOffset':180", "'byteOffset':380", "accessors[5] needs 3 elements"},
    };
    static const defect skins[] = {
        {"'skin':0", "'skin':1", "nodes[0].skin is 1 but the file has 1 skins"},
        {"'joints':[1,2]", "'joints':[1]", "vertex 1 uses joint 1, but its skin has 1 joints"},
        {"'joints':[1,2]", "'joints':[1,3]", "skins[0].joints[1] is 3"},
        {"'joints':[1,2],", "", "skins[0].joints is missing"},
        {"'scenes':[{'nodes':[0,1]}]", "'scenes':[{'nodes':[0]}]", "but that node is not in the mesh's scene"},
        {"'componentType':5126,'count':2,'type':'MAT4'", "'componentType':5126,'count':1,'type':'MAT4'", "has 1 matrices for 2 joints"},
        {"'type':'MAT4'", "'type':'VEC4'", "must hold 4x4 matrices"},
        {"'JOINTS_0':2", "'JOINTS_0':3", "JOINTS: accessors[3] has 4 normalized components"},
        {"'WEIGHTS_0':3", "'WEIGHTS_0':2", "WEIGHTS: accessors[2] has 4 components"},
    };
    const blob blobs[] = {{"@pos@", &skin_data, sizeof skin_data}, {0}};
    expect_defects(morphing, morphs, sizeof morphs / sizeof *morphs, morph_blobs);
    expect_defects(skinned, skins, sizeof skins / sizeof *skins, blobs);
    /* A target with weight 0 is not read. */
    ec_scene *s = load_changed(morphing, "{'POSITION':6}", "{'POSITION':4}", morph_blobs);
    ec_scene_free(s);
}

/* Weights that are not finite count as 0: the vertex belongs to the remaining joints, or to the first one. */
static void test_odd_weights(void)
{
    struct {
        float position[9], weights[12];
        uint8_t joints[12];
    } data = {.position = {1, 0, 0, 0, 2, 0, 1, 2, 0}, .weights = {NAN, INFINITY, -1, 1, 0, 0, 0, 0, 0, 0, 0, 0}, .joints = {0, 0, 0, 1}};
    const blob blobs[] = {{"@pos@", &data, sizeof data}, {0}};
    ec_error err;
    ec_scene *s = load_text("{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,1,2]}],'nodes':[{'mesh':0,'skin':0},{'translation':[0,3,0]},{'translation':[0,9,0]}],"
                            "'skins':[{'joints':[1,2]}]," MESH(",'JOINTS_0':2,'WEIGHTS_0':1", "", "")
                            ",'buffers':[{'byteLength':96,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':96}],'accessors':["
                            "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                            "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':3,'type':'VEC4'},"
                            "{'bufferView':0,'byteOffset':84,'componentType':5121,'count':3,'type':'VEC4'}]}", blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    expect_corners(s, (double[9]){1, 9, 0, 0, 5, 0, 1, 5, 0}, "odd weights");
    ec_scene_free(s);
}

int main(void)
{
    test_morph();
    test_morph_instances();
    test_skin();
    test_mirrored_skin();
    test_odd_weights();
    test_defects();
    TEST_END();
}
