/* tier: quick */
/* Compressed meshes and textures: one triangle packed by the libraries' own encoders, and messages of a build without them. */
#include "gltf/codecs.h"
#include "test_scene_files.h"
#include "gltf/reader.h"

/* The corners (0, 0, 0), (1, 0, 0), (0, 1, 0): as floats, and as 12 x 2^-2 where they are 1. Normals are z, x and y. */
static const unsigned char packed_positions[67] = {160, 0, 0, 1, 60, 0, 0, 0, 255, 255, 1, 60, 0, 0, 0, 126, 125, 0, 0, 1, 12,
    0, 0, 0, 255, 1, 12, 0, 0, 0, 126, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0};
static const unsigned char packed_triangles[18] = {224, 240, 0, 118, 135, 86, 103, 120, 169, 134, 101, 137, 104, 152, 1, 105, 0,
    0};
static const unsigned char packed_indices[8] = {208, 0, 4, 4, 0, 0, 0, 0};
static const unsigned char packed_exponential[56] = {160, 1, 60, 0, 0, 0, 24, 23, 0, 0, 0, 1, 12, 0, 0, 0, 24, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 254, 0, 0, 0, 254, 0, 0, 0, 254};
static const unsigned char packed_normals[48] = {160, 1, 60, 0, 0, 0, 254, 253, 1, 12, 0, 0, 0, 254, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 127, 0};
static const unsigned char draco_triangle[95] = {68, 82, 65, 67, 79, 2, 2, 1, 0, 0, 0, 1, 3, 1, 0, 1, 2, 1, 2, 0, 9, 3, 0, 0, 4,
    2, 4, 0, 7, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 128, 63, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 128, 63, 0,
    0, 0, 0, 0, 1, 1, 0, 5, 11, 85, 21, 173, 42, 3, 4, 112, 129, 16, 141, 136, 136, 136, 8, 1, 0, 0, 0, 12, 0, 0, 0};
static const unsigned char webp_two[42] = {82, 73, 70, 70, 34, 0, 0, 0, 87, 69, 66, 80, 86, 80, 56, 76, 21, 0, 0, 0, 47, 1, 0,
    0, 16, 15, 112, 5, 173, 65, 62, 133, 199, 255, 0, 3, 15, 25, 209, 255, 0, 0};

static const blob blobs[] = {{"@pos@", packed_positions, sizeof packed_positions},
                             {"@tri@", packed_triangles, sizeof packed_triangles},
                             {"@seq@", packed_indices, sizeof packed_indices},
                             {"@exp@", packed_exponential, sizeof packed_exponential},
                             {"@oct@", packed_normals, sizeof packed_normals},
                             {0}};

#define PACKED(BUFFER, LENGTH, STRIDE, REST)                                                                                         \
    "'extensions':{'EXT_meshopt_compression':{'buffer':" BUFFER ",'byteLength':" LENGTH ",'byteStride':" STRIDE ",'count':3," REST "}}"
static const char packed[] =
    "{'asset':{'version':'2.0'},'extensionsUsed':['EXT_meshopt_compression','KHR_mesh_quantization'],"
    "'extensionsRequired':['EXT_meshopt_compression'],'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},'indices':2}]}],'buffers':["
    "{'byteLength':100,'extensions':{'EXT_meshopt_compression':{'fallback':true}}},{'byteLength':67,'uri':'@pos@'},"
    "{'byteLength':18,'uri':'@tri@'},{'byteLength':8,'uri':'@seq@'},{'byteLength':56,'uri':'@exp@'},{'byteLength':48,'uri':'@oct@'}],"
    "'bufferViews':[{'buffer':0,'byteLength':36," PACKED("1", "67", "12", "'mode':'ATTRIBUTES'") "},"
    "{'buffer':0,'byteOffset':36,'byteLength':12,'byteStride':4," PACKED("5", "48", "4", "'mode':'ATTRIBUTES','filter':'OCTAHEDRAL'") "},"
    "{'buffer':0,'byteOffset':48,'byteLength':12," PACKED("2", "18", "4", "'mode':'TRIANGLES'") "}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':1,'componentType':5120,'normalized':true,'count':3,'type':'VEC3'},"
    "{'bufferView':2,'componentType':5125,'count':3,'type':'SCALAR'}]}";

static void expect_triangle(const char *json, const blob *with, double size, const char *what)
{
    ec_error err;
    ec_scene *s = load_text(json, with, &err);
    CHECK_MSG(s && s->triangle_count == 1, "%s: %s", what, err.text);
    for (uint32_t i = 0; s && i < 9; i++) {
        double corner[3];
        world_corner(s, 0, i / 3, corner);
        CHECK_MSG(fabs(corner[i % 3] - size * (i == 3 || i == 7)) < 1e-6, "%s: %u: %g", what, i, corner[i % 3]);
    }
    /* a normal's 8 bits are an octahedron's: z, x, y */
    for (uint32_t i = 0; s && s->normals && i < 9; i++) CHECK_NEAR(s->normals[i], (i == 2 || i == 3 || i == 7), 1e-6);
    ec_scene_free(s);
}

static void expect_changed(const char *from, const char *to, const char *message)
{
    char *json = replace(packed, from, to);
    CHECK_MSG(strcmp(json, packed), "nothing to replace: %s", from);
    expect_failure(json, blobs, message);
    free(json);
}

static void test_meshopt(void)
{
    if (!ec_has_meshopt) {
        expect_failure(packed, blobs, "requires EXT_meshopt_compression, which this eclat was built without; install libmeshoptimizer-dev");
        return;
    }
    expect_triangle(packed, blobs, 1, "attributes and triangles");
    char *renamed = strdup(packed);
    for (char *at = renamed; (at = strstr(at, "EXT_meshopt")); at += 11) memcpy(at, "KHR", 3);
    expect_triangle(renamed, blobs, 1, "KHR_meshopt_compression");
    free(renamed);
    char *sequence = replace(packed, "'buffer':2,'byteLength':18,'byteStride':4,'count':3,'mode':'TRIANGLES'",
                             "'buffer':3,'byteLength':8,'byteStride':4,'count':3,'mode':'INDICES'");
    expect_triangle(sequence, blobs, 1, "indices");
    free(sequence);
    char *exponential = replace(packed, "'buffer':1,'byteLength':67,'byteStride':12,'count':3,'mode':'ATTRIBUTES'",
                                "'buffer':4,'byteLength':56,'byteStride':12,'count':3,'mode':'ATTRIBUTES','filter':'EXPONENTIAL'");
    expect_triangle(exponential, blobs, 3, "exponential");
    free(exponential);
    expect_changed("'byteLength':67,'byteStride':12", "'byteLength':60,'byteStride':12", "its data are broken");
    expect_changed("'byteLength':67,'byteStride':12", "'byteLength':68,'byteStride':12", "reaches beyond buffers[1]");
    expect_changed("'byteStride':12,'count':3", "'byteStride':12,'count':4", "do not fit");
    expect_changed("'byteStride':12,'count':3", "'byteStride':10,'count':3", "do not fit");
    expect_changed("'byteStride':12,'count':3", "'byteStride':12,'count':2", "needs 3 elements");
    expect_changed("'byteStride':12,'count':3,'mode':'ATTRIBUTES'", "'byteStride':12,'count':3,'mode':'TRIANGLES'", "do not fit");
    expect_changed("'mode':'TRIANGLES'", "'mode':'CIRCLES'", "mode is CIRCLES, not one of");
    expect_changed("'filter':'OCTAHEDRAL'", "'filter':'QUATERNION'", "do not fit");
    expect_changed("{'buffer':0,'byteLength':36,", "{'buffer':0,'byteLength':35,", "do not fit");
    expect_changed("'buffer':5,", "'buffer':6,", "EXT_meshopt_compression.buffer is 6");
}

static const char draco[] =
    "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_draco_mesh_compression'],'extensionsRequired':['KHR_draco_mesh_compression'],"
    "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1},'indices':2,"
    "'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,'attributes':{'POSITION':0,'COLOR_0':7}}}}]}],"
    "'buffers':[{'byteLength':95,'uri':'@draco@'}],'bufferViews':[{'buffer':0,'byteLength':95}],"
    "'accessors':[{'componentType':5126,'count':3,'type':'VEC3'},{'componentType':5121,'normalized':true,'count':3,'type':'VEC4'},"
    "{'componentType':5123,'count':3,'type':'SCALAR'}]}";

static void test_draco(void)
{
    const blob with[] = {{"@draco@", draco_triangle, sizeof draco_triangle}, {0}};
    static const struct {
        const char *good, *bad, *message;
    } cases[] = {
        {"'byteLength':95}]", "'byteLength':60}]", "its Draco data are broken or truncated"},
        {"'COLOR_0':7", "'COLOR_0':6", "do not hold the attributes"},
        {"'COLOR_0':7", "'COLOR_0':0", "do not hold the attributes"},
        {"'COLOR_0':7", "'COLOR_0':-7", "attributes.COLOR_0 must be a non-negative integer"},
        {"'componentType':5123,'count':3", "'componentType':5123,'count':6", "do not hold as many indices"},
        {"'componentType':5126,'count':3", "'componentType':5126,'count':4", "do not hold the attributes"},
        {"'indices':2,", "", "do not hold as many indices"},
        {"'bufferView':0,'attributes'", "'bufferView':1,'attributes'", "KHR_draco_mesh_compression.bufferView is 1"},
    };
    if (!ec_has_draco) {
        expect_failure(draco, with, "requires KHR_draco_mesh_compression, which this eclat was built without; install libdraco-dev");
        return;
    }
    expect_triangle(draco, with, 1, "draco");
    ec_error err;
    ec_scene *s = load_text(draco, with, &err);
    for (uint32_t i = 0; s && i < 12; i++) CHECK_NEAR(s->colors[i], (i + 1) / 255.0, 1e-7);
    ec_scene_free(s);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *json = replace(draco, cases[i].good, cases[i].bad);
        CHECK_MSG(strcmp(json, draco), "nothing to replace: %s", cases[i].good);
        expect_failure(json, with, cases[i].message);
        free(json);
    }
    /* Any changed byte gives a triangle, or a clear line. */
    unsigned char broken[sizeof draco_triangle];
    const blob from_broken[] = {{"@draco@", broken, sizeof broken}, {0}};
    for (size_t i = 0; i < sizeof broken; i++) {
        memcpy(broken, draco_triangle, sizeof broken);
        broken[i] ^= (unsigned char)(1u << i % 8);
        ec_scene_free(load_text(draco, from_broken, &err));
    }
}

/* Two texels: (200, 100, 50, 255) and (0, 10, 20, 128). */
static const char textured[] =
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'materials':[{@material@}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0}]}],'images':[{'uri':'@webp@'}],"
    "'textures':[{'extensions':{'EXT_texture_webp':{'source':0}}}],"
    "'buffers':[{'byteLength':36,'uri':'@tri@'}],'bufferViews':[{'buffer':0,'byteLength':36}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},{'bufferView':0,'componentType':5126,'count':3,'type':'VEC2'}]}";

/* A grey pixel. */
static const char plain_png[] = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNoaGgAAAMEAYFL09IQAAAAAElFTkSuQmCC";

static ec_scene *load_material(const char *material, size_t webp_bytes)
{
    const blob with[] = {{"@webp@", webp_two, webp_bytes}, {"@tri@", triangle_positions, sizeof triangle_positions}, {0}};
    ec_error err;
    char *json = replace(textured, "@material@", material);
    ec_scene *s = load_text(json, with, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    free(json);
    return s;
}

static void test_webp(void)
{
    ec_scene *s = load_material("'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}", sizeof webp_two);
    if (ec_has_webp) {
        static const uint8_t texels[8] = {200, 100, 50, 255, 0, 10, 20, 128};
        CHECK(s && s->image_count == 1 && s->images[0].width == 2 && s->images[0].height == 1 && !memcmp(s->images[0].rgba8, texels, 8));
    } else {
        CHECK(s && s->image_count == 0 && strstr(messages, "no image in a supported format"));
    }
    ec_scene_free(s);
    if (!ec_has_webp) return;
    static const unsigned char moving[30] = "RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\2"; /* the flag of an animation; a pixel */
    const blob with[] = {{"@webp@", moving, sizeof moving}, {"@tri@", triangle_positions, sizeof triangle_positions}, {0}};
    char *json = replace(textured, "@material@", "'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}");
    ec_error err;
    s = load_text(json, with, &err);
    CHECK_MSG(s && strstr(messages, "it is an animated WebP, which is not supported; save a single picture of it"), "%s", messages);
    ec_scene_free(s);
    free(json);
    for (size_t length = 12; length < sizeof webp_two; length += 5) {
        s = load_material("'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}", length);
        CHECK_MSG(s && (s->image_count == 1 || strstr(messages, "cannot be decoded")), "%zu bytes: %s", length, messages);
        ec_scene_free(s);
    }
}

/* A texture in a format that cannot be read: the plain image beside it is used. Without one, a warning says that the texture is left out,
 * and a file that requires the format is refused. Pictures of a wrong format are detected too. */
static void test_fallbacks(void)
{
    static const unsigned char ktx2[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
    const blob with[] = {{"@webp@", webp_two, sizeof webp_two}, {"@ktx2@", ktx2, sizeof ktx2}, {"@tri@", triangle_positions, sizeof triangle_positions}, {0}};
    static const struct {
        const char *texture, *used, *required;
        int32_t side; /* of the picture in use; 0: none */
        const char *says;
    } cases[] = {
        {"'source':1,'extensions':{'KHR_texture_basisu':{'source':2}}", "KHR_texture_basisu", NULL, 1, "not supported, so what they describe is left out: KHR_texture_basisu"},
        {"'extensions':{'KHR_texture_basisu':{'source':2}}", "KHR_texture_basisu", NULL, 0, "textures[0] has no image in a supported format; it is taken as white"},
        {"'source':1,'extensions':{'KHR_texture_basisu':{'source':2}}", "KHR_texture_basisu", "KHR_texture_basisu", 0, "the file requires KHR_texture_basisu, which this eclat was built without"},
        {"'source':2", "KHR_texture_transform", NULL, 0, "images[2] cannot be decoded: it"},
        {"'source':1,'extensions':{'EXT_texture_webp':{'source':0}}", "EXT_texture_webp", NULL, 2, NULL},
        {"'source':1,'extensions':{'EXT_texture_webp':{'source':0}}", "EXT_texture_webp", "EXT_texture_webp", 2, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (ec_has_basisu && !strcmp(cases[i].used, "KHR_texture_basisu")) continue;
        char extensions[256];
        int used = snprintf(extensions, sizeof extensions, "{'extensionsUsed':['%s'],'asset'", cases[i].used);
        if (cases[i].required) snprintf(extensions + used - 7, sizeof extensions - (size_t)used, "'extensionsRequired':['%s'],'asset'", cases[i].required);
        char *json[4] = {replace(textured, "'extensions':{'EXT_texture_webp':{'source':0}}", cases[i].texture)};
        json[1] = replace(json[0], "{'uri':'@webp@'}", "{'uri':'@webp@'},{'uri':'@png@'},{'uri':'@ktx2@'}");
        json[2] = replace(json[1], "{'asset'", extensions);
        json[3] = replace(json[2], "@material@", "'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}");
        char *json4 = replace(json[3], "@png@", plain_png);
        ec_error err;
        ec_scene *s = load_text(json4, with, &err);
        bool unbuilt = !ec_has_webp && strstr(cases[i].texture, "webp");
        const char *said = s ? messages : err.text;
        if (!unbuilt) {
            CHECK_MSG(!s == (cases[i].required && !strstr(cases[i].required, "webp")), "case %zu: %s", i, err.text);
            CHECK_MSG(!cases[i].says || strstr(said, cases[i].says), "case %zu says \"%s\"", i, said);
            CHECK_MSG(cases[i].says || !strstr(messages, "W "), "case %zu says \"%s\"", i, messages);
            if (s) CHECK_MSG(s->image_count == (cases[i].side > 0) && (!s->image_count || (int32_t)s->images[0].width == cases[i].side), "case %zu", i);
        } else if (cases[i].required) {
            CHECK_MSG(!s && strstr(err.text, "built without"), "case %zu: %s", i, err.text);
        } else {
            CHECK_MSG(s && s->image_count == 1 && s->images[0].width == 1, "case %zu: %s", i, said);
        }
        ec_scene_free(s);
        for (int k = 0; k < 4; k++) free(json[k]);
        free(json4);
    }
}

/* KHR_materials_pbrSpecularGlossiness: reflectance as given, no metal, roughness 1 - glossiness; from a texture's alpha, texel by texel. */
static void test_specular_glossiness(void)
{
    ec_scene *s = load_material("'extensions':{'KHR_materials_pbrSpecularGlossiness':{'diffuseFactor':[0.5,0.25,0.125,1],"
                                "'specularFactor':[0.1,0.2,0.3],'glossinessFactor':0.75}}", sizeof webp_two);
    const ec_material *m = s ? &s->materials[s->triangle_material[0]] : NULL;
    if (m) {
        CHECK(m->metallic == 0 && m->ior == 0 && m->specular == 1 && m->roughness == 0.25f);
        CHECK(m->base_color[1] == 0.25f && m->specular_color[2] == 0.3f);
    }
    ec_scene_free(s);
    if (!ec_has_webp) return;
    s = load_material("'extensions':{'KHR_materials_pbrSpecularGlossiness':{'glossinessFactor':0.5,'specularGlossinessTexture':{'index':0}}}",
                      sizeof webp_two);
    m = s ? &s->materials[s->triangle_material[0]] : NULL;
    if (m) {
        int32_t slot = m->textures[EC_SLOT_METALLIC_ROUGHNESS].texture;
        CHECK(slot >= 0 && m->textures[EC_SLOT_SPECULAR_COLOR].texture >= 0 && m->roughness == 1 && s->image_count == 2);
        const uint8_t *texels = s->images[s->textures[slot].image].rgba8;
        /* 255 (1 - 0.5) = 127.5, rounded up; 255 - 0.5 x 128 = 191 */
        CHECK_MSG(texels[1] == 128 && texels[5] == 191 && texels[2] == 0 && texels[6] == 0, "%d %d", texels[1], texels[5]);
    }
    ec_scene_free(s);
}

/* Khronos' models, packed and plain: as many triangles, and the same box to the usual quantisation of 11 bits. */
static void test_models(void)
{
    static const char *const names[] = {"Box", "Duck", "RiggedSimple"};
    for (size_t i = 0; ec_has_draco && i < sizeof names / sizeof *names; i++) {
        char path[2][1024];
        ec_scene *s[2] = {NULL, NULL};
        ec_error err;
        for (int k = 0; k < 2; k++)
            snprintf(path[k], sizeof path[k], "%s/assets/gltf/%s/%s/%s.gltf", ECLAT_SHARED, names[i], k ? "glTF-Draco" : "glTF", names[i]);
        if (access(path[0], R_OK) || access(path[1], R_OK)) continue;
        for (int k = 0; k < 2; k++) CHECK_OK(ec_scene_load(path[k], &s[k], NULL, &err), err);
        if (s[0] && s[1]) CHECK(s[0]->triangle_count == s[1]->triangle_count);
        for (int k = 0; s[0] && s[1] && k < 3; k++) {
            double extent = (double)s[0]->bounds_max[k] - s[0]->bounds_min[k];
            CHECK_NEAR(s[1]->bounds_max[k], s[0]->bounds_max[k], extent / 2048);
            CHECK_NEAR(s[1]->center[k], s[0]->center[k], extent / 2048);
        }
        ec_scene_free(s[0]);
        ec_scene_free(s[1]);
    }
}

int main(void)
{
    test_models();
    test_meshopt();
    test_draco();
    test_webp();
    test_fallbacks();
    test_specular_glossiness();
    TEST_END();
}
