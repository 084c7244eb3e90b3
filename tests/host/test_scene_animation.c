/* tier: quick */
/* Animations at a moment: every interpolation against its formula, clamping, targets of channels, defects. */
#include "test_scene_files.h"

/* One triangle at the origin, whose node is animated; accessor 1 has times, 2 values. @keys@ has both. */
#define ANIMATED(NODE, TARGET, INTERPOLATION, VALUES, ROOT)                                                                    \
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0" NODE "}],"                                        \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'targets':[{'POSITION':0},{'POSITION':0}]}]}],"                     \
    "'animations':[{'name':'move','channels':[{'sampler':0,'target':{" TARGET "}}],"                                           \
    "'samplers':[{'input':1,'output':2,'interpolation':'" INTERPOLATION "'}]}],"                                               \
    "'buffers':[{'byteLength':36,'uri':'@pos@'},{'byteLength':256,'uri':'@keys@'}],"                                           \
    "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':1,'byteLength':64},{'buffer':1,'byteOffset':64,'byteLength':192}]," \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"                                              \
    "{'bufferView':1,'componentType':5126,'count':3,'type':'SCALAR','max':[4]},{'bufferView':2," VALUES "}]" ROOT "}"

typedef struct keys {
    float times[16], values[48];
} keys;

static ec_scene *load_at(const char *json, const keys *k, double at)
{
    const blob blobs[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {"@keys@", k, sizeof *k}, {0}};
    ec_error err;
    wanted = (ec_scene_choice){.at = at, .animated = true};
    ec_scene *s = load_text(json, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    return s;
}

/* Position of one corner of the triangle; corner 1 is (1, 0, 0) in the file. */
static void expect_corner(const char *json, const keys *k, double at, uint32_t corner, const double expected[3])
{
    ec_scene *s = load_at(json, k, at);
    double found[3] = {0};
    if (s) world_corner(s, 0, corner, found);
    for (int i = 0; s && i < 3; i++) CHECK_MSG(fabs(found[i] - expected[i]) < 1e-6, "at %g s: %c = %.8g, expected %.8g", at, "xyz"[i], found[i], expected[i]);
    ec_scene_free(s);
}

#define FLOATS(COUNT, TYPE) "'componentType':5126,'count':" COUNT ",'type':'" TYPE "'"
#define NODE_0(PATH) "'node':0,'path':'" PATH "'"

static void test_translation(void)
{
    const char linear[] = ANIMATED("", NODE_0("translation"), "LINEAR", FLOATS("3", "VEC3"), "");
    const char step[] = ANIMATED("", NODE_0("translation"), "STEP", FLOATS("3", "VEC3"), "");
    const keys k = {.times = {1, 2, 4}, .values = {10, 0, 0, 20, 4, 0, 20, 0, 8}};
    const struct {
        double at, linear[3], step[3];
    } cases[] = {{0, {10, 0, 0}, {10, 0, 0}}, {1, {10, 0, 0}, {10, 0, 0}}, {1.25, {12.5, 1, 0}, {10, 0, 0}}, {2, {20, 4, 0}, {20, 4, 0}},
                 {3.5, {20, 1, 6}, {20, 4, 0}}, {4, {20, 0, 8}, {20, 0, 8}}, {99, {20, 0, 8}, {20, 0, 8}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_corner(linear, &k, cases[i].at, 0, cases[i].linear);
        expect_corner(step, &k, cases[i].at, 0, cases[i].step);
    }
}

/* Two keys 2 s apart, x from 0 with tangent 2 to 1 with tangent -1; y from 0 to 1 with none. In the middle the Hermite polynomials are
 * 1/2, 1/8, 1/2, -1/8: x = 2 * 2/8 + 1/2 + 2 * 1/8 = 1.25. */
static void test_cubic(void)
{
    const char json[] = ANIMATED("", NODE_0("translation"), "CUBICSPLINE", FLOATS("6", "VEC3"), "");
    char *two = replace(json, "'count':3,'type':'SCALAR'", "'count':2,'type':'SCALAR'");
    const keys k = {.times = {1, 3}, .values = {9, 9, 9, 0, 0, 0, 2, 0, 0, -1, 0, 0, 1, 1, 0, 9, 9, 9}};
    expect_corner(two, &k, 0, 0, (double[3]){0, 0, 0});
    expect_corner(two, &k, 2, 0, (double[3]){1.25, 0.5, 0});
    /* a quarter of the way: 27/32, 9/64, 5/32, -3/64 */
    expect_corner(two, &k, 1.5, 0, (double[3]){2 * 2 * 9 / 64.0 + 5 / 32.0 + 2 * 3 / 64.0, 5 / 32.0, 0});
    expect_corner(two, &k, 7, 0, (double[3]){1, 1, 0});
    free(two);
}

/* 170 degrees about z in 3 s, at constant speed, which linear interpolation of components does not give. The negated quaternion is the same
 * rotation. */
static void test_rotation(void)
{
    const char floats[] = ANIMATED("", NODE_0("rotation"), "LINEAR", FLOATS("3", "VEC4"), "");
    const double degree = acos(-1) / 180;
    keys k = {.times = {0, 3, 4}, .values = {0, 0, 0, 2 /* any length */, 0, 0, (float)sin(85 * degree), (float)cos(85 * degree), 0, 0, 0, 1}};
    for (int sign = 0; sign < 2; sign++) {
        expect_corner(floats, &k, 1, 1, (double[3]){cos(170 / 3.0 * degree), sin(170 / 3.0 * degree), 0});
        expect_corner(floats, &k, 3, 1, (double[3]){cos(170 * degree), sin(170 * degree), 0});
        for (int i = 4; i < 8; i++) k.values[i] = -k.values[i];
    }
    /* This rotation in normalised shorts. */
    const char shorts[] = ANIMATED("", NODE_0("rotation"), "LINEAR", "'componentType':5122,'normalized':true,'count':3,'type':'VEC4'", "");
    const int16_t turns[12] = {0, 0, 0, 32767, 0, 0, 32767, 0, 0, 0, 0, 32767};
    memcpy(k.values, turns, sizeof turns);
    expect_corner(shorts, &k, 1.5, 1, (double[3]){0, 1, 0});
    /* A cubic spline need not give a unit quaternion; the rotation is that of the normalised one. */
    const char cubic[] = ANIMATED("", NODE_0("rotation"), "CUBICSPLINE", FLOATS("9", "VEC4"), "");
    keys c = {.times = {0, 2, 4}};
    c.values[4 + 3] = 1, c.values[16 + 2] = 1, c.values[28 + 3] = 1; /* no turn, half a turn, no turn; no tangents */
    expect_corner(cubic, &c, 1, 1, (double[3]){0, 1, 0});
}

#define POINTER(AT) "'path':'pointer','extensions':{'KHR_animation_pointer':{'pointer':'" AT "'}}"

/* An animated node's matrix is replaced. Scale; and two weights of morph targets, each of which adds the triangle to itself. */
static void test_scale_and_weights(void)
{
    const char scale[] = ANIMATED(",'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,9,9,9,1]", NODE_0("scale"), "LINEAR", FLOATS("3", "VEC3"), "");
    const keys k = {.times = {0, 2, 4}, .values = {1, 1, 1, 3, 1, 1, 3, 1, 1}};
    expect_corner(scale, &k, 1, 1, (double[3]){2, 0, 0});
    const char weights[] = ANIMATED("", NODE_0("weights"), "LINEAR", FLOATS("6", "SCALAR"), "");
    const keys w = {.times = {0, 2, 4}, .values = {0, 0, 1, 3, 0, 0}};
    expect_corner(weights, &w, 1, 1, (double[3]){1 + 0.5 + 1.5, 0, 0});
    const char second[] = ANIMATED(",'weights':[0.5,9]", POINTER("/nodes/0/weights/1"), "LINEAR", FLOATS("3", "SCALAR"), "");
    const keys one = {.times = {0, 2, 4}, .values = {0, 3, 0}};
    expect_corner(second, &one, 1, 1, (double[3]){1 + 0.5 + 1.5, 0, 0});
}

#define LAMP_AND(MATERIAL)                                                                                               \
    ",'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','intensity':1}]}},"                                 \
    "'cameras':[{'type':'perspective','perspective':{'yfov':0.5}}],'materials':[{" MATERIAL "}]"
#define LAMP LAMP_AND("")
#define GLASS LAMP_AND("'extensions':{'KHR_materials_ior':{'ior':4}}")
#define LAMP_NODE ",'camera':0,'extensions':{'KHR_lights_punctual':{'light':0}}"

static void test_pointers(void)
{
    const keys k = {.times = {0, 2, 4}, .values = {1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23}};
    ec_scene *s = load_at(ANIMATED(LAMP_NODE, POINTER("/extensions/KHR_lights_punctual/lights/0/intensity"), "LINEAR", FLOATS("3", "SCALAR"), LAMP), &k, 1);
    if (s) CHECK_NEAR(s->lights[0].intensity[0], 2, 0);
    ec_scene_free(s);
    s = load_at(ANIMATED(LAMP_NODE, POINTER("/cameras/0/perspective/yfov"), "LINEAR", FLOATS("3", "SCALAR"), LAMP), &k, 0.5);
    if (s) CHECK_NEAR(s->cameras[0].yfov, 1.5, 0);
    ec_scene_free(s);
    const keys colors = {.times = {0, 2, 4}, .values = {0, 0, 0, 1, 0.5f, 0.25f, 1, 1}};
    s = load_at(ANIMATED(LAMP_NODE, POINTER("/materials/0/pbrMetallicRoughness/baseColorFactor"), "LINEAR", FLOATS("3", "VEC4"), LAMP), &colors, 1);
    if (s) CHECK_NEAR(s->materials[0].base_color[1], 0.125, 0);
    ec_scene_free(s);
    s = load_at(ANIMATED(LAMP_NODE, POINTER("/materials/0/extensions/KHR_materials_ior/ior"), "LINEAR", FLOATS("3", "SCALAR"), GLASS), &k, 1);
    if (s) CHECK_NEAR(s->materials[0].ior, 2, 0);
    ec_scene_free(s);
    s = load_at(ANIMATED(LAMP_NODE, POINTER("/nodes/0/translation"), "LINEAR", FLOATS("3", "VEC3"), LAMP), &k, 2);
    if (s) CHECK_NEAR(s->cameras[0].position[0] + s->center[0], 7, 1e-6);
    ec_scene_free(s);
    const char *elsewhere[] = {"/asset/version", "/accessors/0/count", "/nodes/7/translation", "/nodes/-1/translation", "/materials/0",
                               "/materials/0/extensions/KHR_materials_unlit/x", "", "nodes/0/scale", "/nodes/00000000000000000000/scale", "/skins/0/joints", "/nodes/0/weights/0",
                               "/materials/0/emissiveFactor/0",
                               /* Pointers to members that only a texture, a projection or an extension in the file can have; adding them
                                * would break the material. */
                               "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset",
                               "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/rotation",
                               "/materials/0/normalTexture/scale", "/cameras/0/orthographic/xmag", "/materials/0/extensions/KHR_materials_ior/ior",
                               /* Pointers to members that eclat does not know, or that are not numbers. */
                               "/materials/0/pbrMetallicRoughness/basecolorFactor", "/nodes/0/bogus", "/nodes/0/", "/nodes/0/mesh", "/cameras/0/type",
                               "/materials/0/name", "/materials/0/alphaMode"};
    for (size_t i = 0; i < sizeof elsewhere / sizeof *elsewhere; i++) {
        char *json = replace(ANIMATED(LAMP_NODE, POINTER("@at@"), "LINEAR", FLOATS("3", "SCALAR"), LAMP), "@at@", elsewhere[i]);
        s = load_at(json, &k, 0);
        if (*elsewhere[i]) CHECK_MSG(strstr(messages, "which is not supported") != NULL, "%s: %s", elsewhere[i], messages);
        ec_scene_free(s);
        free(json);
    }
    s = load_at(ANIMATED("", NODE_0("foo"), "LINEAR", FLOATS("3", "SCALAR"), ""), &k, 0);
    CHECK_MSG(strstr(messages, "animations[0].channels[0] animates /nodes/0/foo, which is not supported; it is left out") != NULL, "%s", messages);
    ec_scene_free(s);
}

/* By name, by index, all; without --at none, with a message. */
static void test_choice(void)
{
    const char one[] = ANIMATED("", NODE_0("translation"), "LINEAR", FLOATS("3", "VEC3"), "");
    const keys k = {.times = {1, 2, 4}, .values = {10, 0, 0, 20, 4, 0, 20, 0, 8}};
    const blob blobs[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {"@keys@", &k, sizeof k}, {0}};
    char *two = replace(one, "'animations':[", "'animations':[{'name':'scale','channels':[{'sampler':0,'target':{'node':0,'path':'scale'}},"
                                               "{'sampler':0,'target':{'path':'translation'}}],'samplers':[{'input':1,'output':2}]},");
    const struct {
        const char *animation;
        double at, x, y; /* of the corner (1, 0, 0) */
    } cases[] = {{"move", 2, 21, 4}, {"1", 2, 21, 4}, {NULL, 2, 20, 0}, {"0", 2, 20, 0}, {"all", 2, 40, 4}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ec_error err;
        double corner[3] = {0};
        wanted = (ec_scene_choice){.animation = cases[i].animation, .at = cases[i].at, .animated = true};
        ec_scene *s = load_text(two, blobs, &err);
        CHECK_MSG(s != NULL, "%s", err.text);
        if (s) world_corner(s, 0, 1, corner);
        CHECK_NEAR(corner[0], cases[i].x, 1e-5);
        CHECK_NEAR(corner[1], cases[i].y, 1e-5);
        if (s) CHECK(s->contents.animations.count == 2 && s->contents.seconds[1] == 4);
        ec_scene_free(s);
    }
    wanted = (ec_scene_choice){.animation = "run", .animated = true};
    expect_failure(two, blobs, "no animation \"run\"; there are: 0 \"scale\", 1 \"move\"");
    expect_failure(TRIANGLE("", "", "", ""), triangle_blobs, "the file has no animation");
    ec_error err;
    double corner[3] = {9};
    wanted = (ec_scene_choice){0};
    ec_scene *s = load_text(two, blobs, &err);
    if (s) world_corner(s, 0, 0, corner);
    CHECK_NEAR(corner[0], 0, 0);
    CHECK(strstr(messages, "N ") && strstr(messages, "2 animations: shown as stored"));
    ec_scene_free(s);
    free(two);
}

static void test_defects(void)
{
    const char json[] = ANIMATED("", NODE_0("translation"), "LINEAR", FLOATS("3", "VEC3"), "");
    static const struct {
        const char *good, *bad, *message;
    } cases[] = {
        {"'sampler':0", "'sampler':1", "animations[0].channels[0].sampler is 1 but there are 1"},
        {"'node':0", "'node':1", "animations[0].channels[0].target.node is 1"},
        {"'input':1", "'input':0", "the times of its keys must be float scalars"},
        {"'input':1", "'input':5", "animations[0].samplers[0].input is 5"},
        {"'output':2", "'output':1", "nodes[0].translation must be an array"},
        {"'type':'VEC3'}]", "'type':'VEC4'}]", "nodes[0].translation must have 3 numbers, not 4"},
        {"'count':3,'type':'VEC3'}]", "'count':4,'type':'VEC3'}]", "has 4 elements, which does not match the 3 keys"},
        {"'LINEAR'", "'CUBICSPLINE'", "has 3 elements, which does not match the 3 keys"},
        {"'count':3,'type':'SCALAR'", "'count':4,'type':'SCALAR'", "the times of its keys must increase: key 3"},
        {"'count':3,'type':'VEC3'}]", "'count':300,'type':'VEC3'}]", "needs 300 elements"},
        {"'path':'translation'", "'path':'rotation'", "a rotation takes 4 numbers, not 3"},
        {"'path':'translation'", "'path':'weights'", "has 2 morph targets for 3 weights"},
        {"'channels':[{", "'channels':[7,{", "channels[0] must be an object"},
    };
    keys k = {.times = {1, 2, 4, 4}, .values = {10, 0, 0, 20, 4, 0, 20, 0, 8}};
    const blob blobs[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {"@keys@", &k, sizeof k}, {0}};
    wanted = (ec_scene_choice){.at = 1, .animated = true};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *changed = replace(json, cases[i].good, cases[i].bad);
        CHECK_MSG(strcmp(changed, json), "nothing to replace: %s", cases[i].good);
        expect_failure(changed, blobs, cases[i].message);
        free(changed);
    }
    k.values[1] = NAN;
    expect_failure(json, blobs, "NaN or infinity at 1 s");
    k.times[1] = NAN;
    expect_failure(json, blobs, "must increase");
    /* An animation that is not chosen is only checked for its form. */
    wanted = (ec_scene_choice){0};
    ec_error err;
    ec_scene *s = load_text(json, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    ec_scene_free(s);
}

int main(void)
{
    test_translation();
    test_cubic();
    test_rotation();
    test_scale_and_weights();
    test_pointers();
    test_choice();
    test_defects();
    TEST_END();
}
