/* tier: quick */
/* Materials, textures, images and extensions. */
#include "support/light.h"
#include "textured_triangle.h"

static int count_of(const char *text, const char *words)
{
    int count = 0;
    while ((text = strstr(text, words))) count++, text += strlen(words);
    return count;
}

static void test_defaults(void)
{
    ec_error err;
    ec_scene *s = load_text(TRIANGLE("", "", "", ""), triangle_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    const ec_material *m = s->materials;
    CHECK(s->material_count == 1 && m->base_color[3] == 1 && m->metallic == 1 && m->roughness == 1);
    CHECK(m->specular == 1 && m->specular_color[2] == 1 && m->normal_scale == 1 && m->alpha_cutoff == 0.5f);
    CHECK(m->alpha_mode == EC_ALPHA_OPAQUE && !m->double_sided && !m->unlit && m->textures[EC_SLOT_BASE_COLOR].texture == -1);
    CHECK(!has_light(s));
    ec_scene_free(s);
    s = load(TEXTURED("", ""));
    m = s->materials;
    CHECK(s->material_count == 1 && m->base_color[3] == 1 && m->metallic == 1 && m->roughness == 1);
    CHECK(m->specular == 1 && m->specular_color[2] == 1 && m->normal_scale == 1 && m->alpha_cutoff == 0.5f);
    CHECK(m->ior == 1.5f && m->transmission == 0 && !m->volume && m->absorption[0] == 0 && m->textures[EC_SLOT_TRANSMISSION].texture == -1);
    CHECK(s->image_count == 0 && s->texture_count == 0); /* unused images are not opened: no warning */
    CHECK_MSG(!strstr(messages, "W "), "%s", messages);
    ec_scene_free(s);
}

static void test_factors(void)
{
    ec_scene *s = load(TEXTURED(
        ",'pbrMetallicRoughness':{'baseColorFactor':[0.1,0.2,0.3,0.4],'metallicFactor':0,'roughnessFactor':0.25},"
        "'emissiveFactor':[1,0.5,0],'alphaMode':'MASK','alphaCutoff':0.75,'doubleSided':true,"
        "'normalTexture':{'index':0,'scale':2},"
        "'extensions':{'KHR_materials_emissive_strength':{'emissiveStrength':8000000000},"
        "'KHR_materials_specular':{'specularFactor':0,'specularColorFactor':[2,1,0.5],'specularTexture':{'index':1}},"
        "'KHR_materials_unknown':{'a':[{}]}}",
        ",'extensionsUsed':['KHR_materials_unknown','KHR_materials_specular']"));
    const ec_material *m = s->materials;
    CHECK_NEAR(m->base_color[3], 0.4, 1e-7);
    CHECK(m->metallic == 0 && m->roughness == 0.25f && m->alpha_cutoff == 0.75f && m->double_sided);
    CHECK(m->alpha_mode == EC_ALPHA_MASK && m->normal_scale == 2);
    CHECK_NEAR(m->emission[0], 8e9, 1e3);
    CHECK_NEAR(m->emission[1], 4e9, 1e3);
    CHECK(m->specular == 0 && m->specular_color[0] == 2 && m->specular_color[2] == 0.5f);
    CHECK(m->textures[EC_SLOT_SPECULAR].texture >= 0 && m->textures[EC_SLOT_NORMAL].texture >= 0);
    CHECK(!has_light(s)); /* 0.4 is below the cutoff */
    CHECK(s->contents.extensions.count == 2 && s->contents.ignored.count == 1);
    CHECK(!strcmp(s->contents.ignored.names[0], "KHR_materials_unknown"));
    CHECK_MSG(strstr(messages, "KHR_materials_unknown") != NULL, "%s", messages);
    ec_scene_free(s);
    s = load(TEXTURED(",'extensions':{'KHR_materials_unlit':{}},'alphaMode':'BLEND'", ""));
    CHECK(s->materials->unlit && s->materials->alpha_mode == EC_ALPHA_BLEND && has_light(s));
    ec_scene_free(s);
    s = load(TEXTURED(",'pbrMetallicRoughness':{'metallicFactor':7,'roughnessFactor':-1},'alphaMode':'ODD'", ""));
    CHECK(s->materials->metallic == 1 && s->materials->roughness == 0 && s->materials->alpha_mode == EC_ALPHA_OPAQUE);
    CHECK_MSG(strstr(messages, "clamped") && strstr(messages, "alphaMode is ODD"), "%s", messages);
    ec_scene_free(s);
}

/* KHR_materials_ior, _transmission and _volume: converts MATERIAL's extensions to the renderer's values. */
#define GLASS(IOR, TRANSMISSION, VOLUME)                                                                               \
    TEXTURED(",'extensions':{'KHR_materials_ior':{" IOR "},'KHR_materials_transmission':{" TRANSMISSION "},"           \
             "'KHR_materials_volume':{" VOLUME "}}", ",'extensionsRequired':['KHR_materials_ior','KHR_materials_transmission','KHR_materials_volume']")

static void test_glass(void)
{
    ec_scene *s = load(GLASS("", "", ""));
    const ec_material *m = s->materials;
    CHECK(m->ior == 1.5f && m->transmission == 0 && !m->volume && !ec_refracts(m) && m->textures[EC_SLOT_TRANSMISSION].texture == -1);
    CHECK_MSG(!strstr(messages, "W "), "%s", messages);
    ec_scene_free(s);

    /* After 0.25 m, half of red is left, a quarter of green, and all of blue: absorption is ln 2 / 0.25 m, ln 4 / 0.25 m and none. */
    s = load(GLASS("'ior':1.33", "'transmissionFactor':0.75,'transmissionTexture':{'index':1}",
                   "'thicknessFactor':2,'attenuationDistance':0.25,'attenuationColor':[0.5,0.25,1],'thicknessTexture':{'index':0}"));
    m = s->materials;
    CHECK(m->ior == 1.33f && m->transmission == 0.75f && m->volume && ec_refracts(m));
    CHECK_NEAR(m->absorption[0], log(2) / 0.25, 1e-6);
    CHECK_NEAR(m->absorption[1], log(4) / 0.25, 1e-6);
    CHECK(m->absorption[2] == 0 && m->textures[EC_SLOT_TRANSMISSION].texture == 0 && s->image_count == 1);
    CHECK_MSG(!strstr(messages, "W "), "%s", messages);
    ec_scene_free(s);

    /* Thickness 0 is a thin wall of any colour. A volume that no light enters has no effect. */
    s = load(GLASS("", "'transmissionFactor':1", "'attenuationDistance':1,'attenuationColor':[0.5,0.5,0.5]"));
    CHECK(!s->materials->volume && !ec_refracts(s->materials) && s->materials->absorption[0] == 0 && s->materials->transmission == 1);
    ec_scene_free(s);
    s = load(TEXTURED(",'extensions':{'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':1,'attenuationColor':[0.5,0.5,0.5]}}", ""));
    CHECK(!s->materials->volume && s->materials->absorption[0] == 0 && s->materials->transmission == 0);
    CHECK_MSG(!strstr(messages, "W "), "%s", messages);
    ec_scene_free(s);

    /* A colour without a distance has no effect: the distance is infinite. Black absorbs as much as finite numbers allow. */
    s = load(GLASS("", "'transmissionFactor':1", "'thicknessFactor':1,'attenuationColor':[0,0.5,1]"));
    CHECK(s->materials->absorption[0] == 0 && s->materials->absorption[1] == 0 && s->materials->absorption[2] == 0);
    ec_scene_free(s);
    s = load(GLASS("", "'transmissionFactor':1", "'thicknessFactor':1,'attenuationDistance':1,'attenuationColor':[0,0.5,1]"));
    CHECK(s->materials->absorption[0] == 1e30f && s->materials->absorption[2] == 0);
    CHECK_MSG(!strstr(messages, "W "), "%s", messages);
    ec_scene_free(s);

    /* An index of 0 stands for infinity: no light gets in, and nothing is refracted. */
    s = load(GLASS("'ior':0", "'transmissionFactor':1", "'thicknessFactor':1"));
    CHECK(s->materials->ior == 0 && !ec_refracts(s->materials));
    CHECK_MSG(!strstr(messages, "W "), "%s", messages);
    ec_scene_free(s);

    static const struct {
        const char *what, *text;
        float ior, transmission, absorption;
    } odd[] = {
        {"an index below 1", GLASS("'ior':0.5", "'transmissionFactor':1", "'thicknessFactor':1"), 1, 1, 0},
        {"an index below 0", GLASS("'ior':-2", "'transmissionFactor':1", "'thicknessFactor':1"), 1, 1, 0},
        {"a huge index", GLASS("'ior':1e30", "'transmissionFactor':1", "'thicknessFactor':1"), 1000, 1, 0},
        {"more than all", GLASS("", "'transmissionFactor':1.5", "'thicknessFactor':1"), 1.5f, 1, 0},
        {"less than nothing", GLASS("", "'transmissionFactor':-1", "'thicknessFactor':1"), 1.5f, 0, 0},
        {"a negative thickness", GLASS("", "'transmissionFactor':1", "'thicknessFactor':-1"), 1.5f, 1, 0},
        {"no distance at all", GLASS("", "'transmissionFactor':1", "'thicknessFactor':1,'attenuationDistance':0,'attenuationColor':[0.5,1,1]"), 1.5f, 1, 1e30f},
        {"a negative distance", GLASS("", "'transmissionFactor':1", "'thicknessFactor':1,'attenuationDistance':-3,'attenuationColor':[0.5,1,1]"), 1.5f, 1, 1e30f},
        {"a colour below 0", GLASS("", "'transmissionFactor':1", "'thicknessFactor':1,'attenuationDistance':1,'attenuationColor':[-1,1,1]"), 1.5f, 1, 1e30f},
        {"a colour above 1", GLASS("", "'transmissionFactor':1", "'thicknessFactor':1,'attenuationDistance':1,'attenuationColor':[2,1,1]"), 1.5f, 1, 0},
    };
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        s = load(odd[i].text);
        m = s->materials;
        CHECK_MSG(m->ior == odd[i].ior && m->transmission == odd[i].transmission && m->absorption[0] == odd[i].absorption,
                  "%s: ior %g, transmission %g, absorption %g", odd[i].what, (double)m->ior, (double)m->transmission, (double)m->absorption[0]);
        CHECK_MSG(strstr(messages, "clamped") && strstr(messages, "materials[0] \"m\""), "%s: %s", odd[i].what, messages);
        ec_scene_free(s);
    }

    static const struct {
        const char *text, *message;
    } bad[] = {
        {GLASS("'ior':'1.5'", "", ""), "materials[0].extensions.KHR_materials_ior.ior must be a number"},
        {GLASS("'ior':1e39", "", ""), "ior"},
        {GLASS("", "'transmissionFactor':[1]", ""), "KHR_materials_transmission.transmissionFactor must be a number"},
        {GLASS("", "'transmissionTexture':{}", ""), "transmissionTexture.index is missing"},
        {GLASS("", "'transmissionTexture':{'index':6}", ""), "transmissionTexture.index is 6 but the file has 6 textures"},
        {GLASS("", "'transmissionTexture':1", ""), "transmissionTexture must be an object"},
        {GLASS("", "", "'thicknessFactor':true"), "KHR_materials_volume.thicknessFactor must be a number"},
        {GLASS("", "", "'thicknessTexture':{'index':-1}"), "thicknessTexture.index must be a non-negative integer"},
        {GLASS("", "", "'attenuationDistance':null"), "attenuationDistance must be a number"},
        {GLASS("", "", "'attenuationColor':[1,1]"), "attenuationColor must have 3 numbers"},
        {GLASS("", "", "'attenuationColor':[1,1,'x']"), "attenuationColor[2] must be a number"},
        {TEXTURED(",'extensions':{'KHR_materials_volume':[]}", ""), "KHR_materials_volume must be an object"},
        {TEXTURED(",'extensions':{'KHR_materials_ior':1.5}", ""), "KHR_materials_ior must be an object"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) expect_failure(bad[i].text, textured_blobs, bad[i].message);
}

static void test_images(void)
{
    ec_scene *s = load(TEXTURED(",'pbrMetallicRoughness':{'baseColorTexture':{'index':0},'metallicRoughnessTexture':"
                                "{'index':1}},'emissiveTexture':{'index':5}", ""));
    const ec_material *m = s->materials;
    CHECK(s->image_count == 2 && s->texture_count == 3);
    if (s->texture_count != 3) exit(1);
    const ec_texture *base = &s->textures[m->textures[EC_SLOT_BASE_COLOR].texture];
    const ec_texture *rough = &s->textures[m->textures[EC_SLOT_METALLIC_ROUGHNESS].texture];
    const ec_texture *glow = &s->textures[m->textures[EC_SLOT_EMISSION].texture];
    CHECK(base->nearest && base->wrap_s == EC_WRAP_CLAMP && base->wrap_t == EC_WRAP_MIRROR);
    CHECK(!rough->nearest && rough->wrap_s == EC_WRAP_REPEAT && rough->wrap_t == EC_WRAP_REPEAT);
    CHECK(glow->image == base->image && !glow->nearest);
    const ec_image *color = &s->images[base->image], *deep = &s->images[rough->image];
    CHECK(color->width == 2 && color->height == 1 && color->rgba8 && !color->rgba16);
    CHECK(color->rgba8[0] == 255 && color->rgba8[1] == 0 && color->rgba8[3] == 255 && color->rgba8[5] == 255);
    CHECK(deep->width == 2 && deep->rgba16 && !deep->rgba8);
    CHECK(deep->rgba16[0] == 0x0102 && deep->rgba16[2] == 0x0102 && deep->rgba16[3] == 0xffff && deep->rgba16[5] == 0xfffe);
    ec_scene_free(s);
    /* broken, absent and missing images count as white; the rest of the material stays */
    s = load(TEXTURED(",'pbrMetallicRoughness':{'baseColorTexture':{'index':2},'metallicRoughnessTexture':{'index':3}},"
                      "'normalTexture':{'index':4},'emissiveTexture':{'index':0}", ""));
    m = s->materials;
    CHECK(m->textures[EC_SLOT_BASE_COLOR].texture < 0 && m->textures[EC_SLOT_METALLIC_ROUGHNESS].texture < 0 && m->textures[EC_SLOT_NORMAL].texture < 0);
    CHECK(m->textures[EC_SLOT_EMISSION].texture == 0 && s->texture_count == 1);
    CHECK_MSG(strstr(messages, "images[2] \"broken\" cannot be decoded") && strstr(messages, "textures[3] has no image") &&
              strstr(messages, "missing.png: cannot open"), "%s", messages);
    CHECK_MSG(count_of(messages, "; it is taken as white\n") == 2 && count_of(messages, "; the map is left out\n") == 1, "%s", messages);
    ec_scene_free(s);
    expect_failure(TEXTURED(",'emissiveTexture':{'index':6}", ""), textured_blobs,
                   "materials[0].emissiveTexture.index is 6 but the file has 6 textures");
}

/* KHR_texture_transform's own example: the (u, v) of the corners after offset, rotation and scale. */
static void test_transform(void)
{
    ec_scene *s = load(TEXTURED(",'emissiveTexture':{'index':0,'texCoord':1,'extensions':{'KHR_texture_transform':"
                                "{'offset':[0.25,1],'rotation':1.5707963267948966,'scale':[2,3],'texCoord':0}}}", ""));
    const ec_texture_use *use = &s->materials[0].textures[EC_SLOT_EMISSION];
    CHECK(use->texture == 0 && use->uv_set == 0);
    /* (1, 0): scaled to (2, 0), then rotated a quarter counter-clockwise, with v pointing down: (0, -2) */
    CHECK_NEAR(use->transform[0] + use->transform[2], 0.25, 1e-6);
    CHECK_NEAR(use->transform[3] + use->transform[5], 1 - 2, 1e-6);
    /* (0, 1): (0, 3), then (3, 0) */
    CHECK_NEAR(use->transform[1] + use->transform[2], 0.25 + 3, 1e-6);
    CHECK_NEAR(use->transform[4] + use->transform[5], 1, 1e-6);
    ec_scene_free(s);
    /* Khronos' TextureTransformTest: rotated by 22.5 degrees, the place of the green marker (0.421, 1.016) on the quad must show the tip of
     * the arrow, which is at (0.778, 0.778) in the picture. */
    s = load(TEXTURED(",'emissiveTexture':{'index':0,'extensions':{'KHR_texture_transform':{'rotation':"
                      "0.39269908169872414}}}", ""));
    const float *m = s->materials[0].textures[EC_SLOT_EMISSION].transform;
    CHECK_NEAR(m[0] * 0.420952 + m[1] * 1.016267 + m[2], 0.7778, 1e-3);
    CHECK_NEAR(m[3] * 0.420952 + m[4] * 1.016267 + m[5], 0.7778, 1e-3);
    ec_scene_free(s);
}

static void test_missing_coordinates(void)
{
    /* Two primitives share a material with TEXCOORD_0 and TEXCOORD_1. Both lack the latter, and one lacks both. */
    ec_error err;
    ec_scene *s = load_text(
        "{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],'meshes':[{'primitives':["
        "{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':0},{'attributes':{'POSITION':0},'material':0}]}],"
        "'buffers':[{'byteLength':36,'uri':'@pos@'},{'byteLength':24,'uri':'@uv@'}],"
        "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':1,'byteLength':24}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
        "{'bufferView':1,'componentType':5126,'count':3,'type':'VEC2'}],"
        "'images':[{'uri':'@png8@'}],'textures':[{'source':0}],'materials':[{'name':'m',"
        "'pbrMetallicRoughness':{'baseColorTexture':{'index':0}},'emissiveTexture':{'index':0,'texCoord':1},"
        "'normalTexture':{'index':0,'texCoord':2}}]}", textured_blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (!s) return;
    const ec_material *first = &s->materials[s->triangle_material[0]], *second = &s->materials[s->triangle_material[1]];
    CHECK(s->triangle_count == 2 && first != second);
    CHECK(first->textures[EC_SLOT_BASE_COLOR].texture == 0 && first->textures[EC_SLOT_EMISSION].texture == -1);
    CHECK(second->textures[EC_SLOT_BASE_COLOR].texture == -1 && second->textures[EC_SLOT_EMISSION].texture == -1);
    CHECK(first->textures[EC_SLOT_NORMAL].texture == -1 && !strcmp(second->name, "m"));
    CHECK_MSG(strstr(messages, "TEXCOORD_1, which meshes[0] lacks") && strstr(messages, "TEXCOORD_2"), "%s", messages);
    CHECK(s->uv[0][0] == 0 && s->uv[0][2 * 3] == 0 && !s->uv[1]);
    ec_scene_free(s);
}

static void test_quantization(void)
{
    struct {
        int8_t position[12]; /* stride 4 */
        int8_t normal[12];
    } data = {{0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0}, {0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -128, 0}};
    const char *text = "{'asset':{'version':'2.0'}%EXT%,'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1}}]}],"
        "'buffers':[{'byteLength':24,'uri':'@pos@'}],'bufferViews':[{'buffer':0,'byteLength':24,'byteStride':4}],"
        "'accessors':[{'bufferView':0,'componentType':5120,'count':3,'type':'VEC3'},"
        "{'bufferView':0,'byteOffset':12,'componentType':5120,'normalized':true,'count':3,'type':'VEC3'}]}";
    const blob blobs[] = {{"@pos@", &data, sizeof data}, {0}};
    char *with = replace(text, "%EXT%", ",'extensionsRequired':['KHR_mesh_quantization']");
    ec_error err;
    ec_scene *s = load_text(with, blobs, &err);
    CHECK_MSG(s != NULL, "%s", err.text);
    if (s) {
        CHECK_NEAR(s->bounds_max[0] - s->bounds_min[0], 10, 0);
        CHECK_NEAR(s->normals[2], 1, 0);
        CHECK_NEAR(s->normals[8], -1, 0);
    }
    ec_scene_free(s);
    free(with);
    with = replace(text, "%EXT%", "");
    expect_failure(with, blobs, "does not allow");
    free(with);
}

int main(void)
{
    test_defaults();
    test_factors();
    test_glass();
    test_images();
    test_transform();
    test_missing_coordinates();
    test_quantization();
    TEST_END();
}
