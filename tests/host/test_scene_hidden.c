/* tier: quick */
/* Invisible parts are left out: nodes by KHR_node_visibility with everything below them, surfaces whose alpha is 0 everywhere. */
#include "support/light.h"
#include "test_scene_files.h"

/* Node 0 above node 1, each with the triangle and a lamp; node 2 beside them; below node 0 a camera, which is never hidden. */
static const char nodes[] =
    "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_node_visibility','KHR_lights_punctual','KHR_animation_pointer'],"
    "'extensionsRequired':['KHR_node_visibility'],"
    "'scenes':[{'nodes':[0,2]}],'cameras':[{'type':'perspective','perspective':{'yfov':1}}],'nodes':["
    "{'mesh':0,'children':[1,3],'extensions':{'KHR_lights_punctual':{'light':0},'KHR_node_visibility':{'visible':true}}},"
    "{'mesh':0,'translation':[3,0,0],'extensions':{'KHR_lights_punctual':{'light':0},'KHR_node_visibility':{}}},"
    "{'mesh':0,'translation':[6,0,0]},{'camera':0}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
    "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point'}]}},"
    "'animations':[{'channels':[{'sampler':0,'target':{'path':'pointer','extensions':{'KHR_animation_pointer':"
    "{'pointer':'/nodes/0/extensions/KHR_node_visibility/visible'}}}}],'samplers':[{'input':1,'output':2,'interpolation':'STEP'}]}],"
    "'buffers':[{'byteLength':36,'uri':'@pos@'},{'byteLength':12,'uri':'@keys@'}],"
    "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':1,'byteLength':8},{'buffer':1,'byteOffset':8,'byteLength':2}],'accessors':["
    "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':1,'componentType':5126,'count':2,'type':'SCALAR','min':[1],'max':[2]},"
    "{'bufferView':2,'componentType':5121,'count':2,'type':'SCALAR'}]}";
static const struct {
    float times[2];
    uint8_t visible[4];
} keys = {{1, 2}, {1, 0}};
static const blob blobs[] = {{"@pos@", triangle_positions, sizeof triangle_positions}, {"@keys@", &keys, sizeof keys}, {0}};

static void expect(const char *json, uint32_t triangles, uint32_t lights)
{
    ec_error err;
    ec_scene *s = load_text(json, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    CHECK_MSG(s->triangle_count == triangles && s->light_count == lights, "%u triangles, %u lights", s->triangle_count, s->light_count);
    CHECK(s->camera_count == 1 && s->contents.ignored.count == 0);
    ec_scene_free(s);
}

static void test_nodes(void)
{
    wanted = (ec_scene_choice){0};
    expect(nodes, 3, 2);
    char *below = replace(nodes, "'KHR_node_visibility':{}", "'KHR_node_visibility':{'visible':false}");
    expect(below, 2, 1);
    free(below);
    char *above = replace(nodes, "'visible':true", "'visible':false");
    expect(above, 1, 0);
    char *odd = replace(above, "'visible':false", "'visible':0");
    expect_failure(odd, blobs, "extensions.KHR_node_visibility.visible");
    free(odd);
    free(above);
    wanted = (ec_scene_choice){.animated = true, .at = 1.5};
    expect(nodes, 3, 2);
    wanted.at = 2;
    expect(nodes, 1, 0);
    wanted = (ec_scene_choice){0};
}

static void expect_empty(const char *json, const char *why)
{
    ec_error err;
    ec_scene *s = load_text(json, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) CHECK_MSG(s->triangle_count == 0 && s->bounds_min[0] == 0 && s->bounds_max[0] == 0 && isfinite(s->cameras[0].position[0]), "%s", why);
    CHECK_MSG(strstr(messages, "W ") && strstr(messages, why), "said: %s", messages);
    ec_scene_free(s);
}

/* Before an object appears the picture is empty. A still of a file without surfaces is an error. */
static void test_nothing_shows(void)
{
    char *alone = replace(nodes, "'nodes':[0,2]", "'nodes':[0]"), *above = replace(alone, "'visible':true", "'visible':false");
    expect_empty(above, "no surface shows: hidden by nodes[0]\n");
    wanted = (ec_scene_choice){.animated = true, .at = 2};
    expect_empty(alone, "no surface shows: hidden by nodes[0]\n");
    wanted = (ec_scene_choice){.animated = true, .shutter = true, .opens = 2, .closes = 3};
    expect_empty(alone, "no surface shows: hidden by nodes[0]\n");
    free(above);
    char *flat = replace(alone, "'extensions':{'KHR_lights_punctual':{'light':0},'KHR_node_visibility':{}}}",
                         "'extensions':{'KHR_node_visibility':{'visible':false}}}"),
         *named = replace(flat, "{'mesh':0,", "{'mesh':0,'name':'ball','scale':[1,0,0],"), *still = replace(named, "'visible':false", "'visible':true");
    wanted = (ec_scene_choice){.animated = true, .at = 1};
    expect_empty(named, "no surface shows: hidden by nodes[1], scaled to nothing by nodes[0] \"ball\"\n");
    expect_empty(still, "no surface shows: scaled to nothing by nodes[0] \"ball\"\n");
    wanted = (ec_scene_choice){.animated = true, .shutter = true, .opens = 0, .closes = 1};
    expect_empty(still, "no surface shows while the shutter is open: none has an area\n");
    wanted = (ec_scene_choice){0};
    expect_failure(still, blobs, "nothing to render: of 2 triangles, 2 have no area");
    free(alone), free(flat), free(named), free(still);
}

/* Two triangles, the second of `material`; pictures of white with alpha 0, and of black with alpha 0.2. */
static const char surfaces[] =
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'materials':[{},{@material@}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0}},{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':1}]}],"
    "'images':[{'uri':'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGP4//8/AwAI/AL+p5qgoAAAAABJRU5ErkJggg=='},{'uri':'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGNgYGAwBgAAOAA0Knr9CgAAAABJRU5ErkJggg=='}],'textures':[{'source':0},{'source':1}],"
    "'buffers':[{'byteLength':36,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':36}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC2'}]}";

static void show(const char *material, uint32_t triangles)
{
    ec_error err;
    char *json = replace(surfaces, "@material@", material);
    ec_scene *s = load_text(json, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) CHECK_MSG(s->triangle_count == triangles, "%u triangles of %s", s->triangle_count, material);
    if (s && triangles == 1) CHECK_MSG(strstr(messages, "N ") && strstr(messages, "1 triangles that alpha hides"), "said: %s", messages);
    ec_scene_free(s);
    free(json);
}

static void test_surfaces(void)
{
    show("'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0]}", 1);
    show("'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,1e-6]}", 2);
    show("'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0]}", 2); /* opaque */
    show("'alphaMode':'MASK','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.4]}", 1);
    show("'alphaMode':'MASK','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.5]}", 2);
    show("'alphaMode':'MASK','alphaCutoff':0,'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0]}", 2);
    show("'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorTexture':{'index':0}}", 1);
    show("'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorTexture':{'index':1}}", 2);
    show("'alphaMode':'MASK','pbrMetallicRoughness':{'baseColorTexture':{'index':1}}", 1);
    show("'alphaMode':'MASK','alphaCutoff':0.2,'pbrMetallicRoughness':{'baseColorTexture':{'index':1}}", 2);
}

/* If everything is hidden, the picture shows the environment. */
static void test_all_hidden(void)
{
    ec_error err;
    char *json = replace(surfaces, "[{},{@material@}]", "[{},{'alphaMode':'MASK','alphaCutoff':2}]"),
         *only = replace(json, "{'attributes':{'POSITION':0}},", "");
    ec_scene *s = load_text(only, blobs, &err);
    CHECK_MSG(s != NULL && s->triangle_count == 1, "%s", err.text);
    ec_scene_free(s);
    free(json);
    free(only);
}

/* With a black emissive texture, a lamp is not a lamp. */
static void test_dark_lamps(void)
{
    static const struct {
        const char *material;
        bool lit;
    } cases[] = {{"'emissiveFactor':[1,0,0]", true},
                 {"'emissiveFactor':[1,1,1],'emissiveTexture':{'index':0}", true},
                 {"'emissiveFactor':[1,1,1],'emissiveTexture':{'index':1}", false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ec_error err;
        char *json = replace(surfaces, "@material@", cases[i].material);
        ec_scene *s = load_text(json, blobs, &err);
        CHECK_MSG(s != NULL, "%s", err.text);
        if (s) CHECK_MSG(has_light(s) == cases[i].lit, "%s", cases[i].material);
        ec_scene_free(s);
        free(json);
    }
}

int main(void)
{
    test_nodes();
    test_nothing_shows();
    test_surfaces();
    test_all_hidden();
    test_dark_lamps();
    TEST_END();
}
