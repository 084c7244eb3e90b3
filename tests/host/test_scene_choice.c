/* tier: quick */
/* Scenes and variants by name and index. */
#include "test_scene_files.h"

/* Scene 0 shows the triangle at the origin. Scene "aside" shows it at x = 3, in red, or in green with the variant "summer". */
static const char two_scenes[] =
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]},{'name':'aside','nodes':[1]}],"
    "'nodes':[{'mesh':0},{'mesh':0,'translation':[3,0,0]}],'materials':["
    "{'pbrMetallicRoughness':{'baseColorFactor':[1,0,0,1]}},{'pbrMetallicRoughness':{'baseColorFactor':[0,1,0,1]}}],"
    "'extensions':{'KHR_materials_variants':{'variants':[{'name':'winter'},{'name':'summer'},{'name':'autumn'}]}},"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0,'extensions':{'KHR_materials_variants':{'mappings':["
    "{'variants':[0],'material':0},{'variants':[2,1],'material':1}]}}}]}],"
    "'buffers':[{'byteLength':36,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':36}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}]}";

static void expect(const char *scene, const char *variant, double x, double green)
{
    ec_error err;
    double corner[3];
    wanted = (ec_scene_choice){.scene = scene, .variant = variant};
    ec_scene *s = load_text(two_scenes, triangle_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    world_corner(s, 0, 0, corner);
    CHECK_NEAR(corner[0], x, 1e-6);
    CHECK_NEAR(s->materials[s->triangle_material[0]].base_color[1], green, 0);
    CHECK(s->contents.scenes.count == 2 && !s->contents.scenes.names[0] && !strcmp(s->contents.scenes.names[1], "aside"));
    CHECK(s->contents.scene == (uint32_t)(x == 3) && s->contents.variants.count == 3);
    ec_scene_free(s);
}

static void refuse(const char *scene, const char *variant, const char *message)
{
    wanted = (ec_scene_choice){.scene = scene, .variant = variant};
    expect_failure(two_scenes, triangle_blobs, message);
}

static void test_defects(void)
{
    static const struct {
        const char *good, *bad, *message;
    } cases[] = {
        {"'variants':[0]", "'variants':[3]", "mappings[0].variants[0] is 3 but the file has 3 variants"},
        {"'material':1}", "'material':2}", "mappings[1].material is 2 but the file has 2 materials"},
        {"{'name':'winter'}", "{}", "variants[0].name is missing"},
        {"'variants':[0],'material':0", "'material':0", "mappings[0].variants is missing"},
    };
    wanted = (ec_scene_choice){0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *json = replace(two_scenes, cases[i].good, cases[i].bad);
        expect_failure(json, triangle_blobs, cases[i].message);
        free(json);
    }
}

int main(void)
{
    expect(NULL, NULL, 0, 0);
    expect("0", "winter", 0, 0);
    expect("aside", "summer", 3, 1);
    expect("1", "2", 3, 1);
    refuse("2", NULL, "there is no scene \"2\"; there are: 0, 1 \"aside\"");
    refuse("-1", NULL, "there is no scene");
    refuse(NULL, "spring", "there is no variant \"spring\"; there are: 0 \"winter\", 1 \"summer\", 2 \"autumn\"");
    wanted = (ec_scene_choice){.variant = "summer"};
    expect_failure(TRIANGLE("", "", "", ""), triangle_blobs, "no variant \"summer\"; the file has none");
    test_defects();
    TEST_END();
}
