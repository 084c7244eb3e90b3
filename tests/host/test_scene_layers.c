/* tier: quick */
/* Layers and other effects of a surface: coat, sheen, anisotropy, thin film, diffuse transmission, dispersion. */
#include "textured_triangle.h"

/* Converts an extension's members to the renderer's values; values out of range are clamped with a warning, values of a wrong type are an
 * error. */
#define LAYER(NAME, MEMBERS) TEXTURED(",'extensions':{'" NAME "':{" MEMBERS "}}", ",'extensionsRequired':['" NAME "']")

static const ec_material *load_layer(const char *text, ec_scene **s, bool odd)
{
    *s = load(text);
    CHECK_MSG(odd == (strstr(messages, "clamped") && strstr(messages, "materials[0] \"m\"")), "%s: %s", text, messages);
    return (*s)->materials;
}

static void test_coat(void)
{
    ec_scene *s;
    const ec_material *m = load_layer(LAYER("KHR_materials_clearcoat", ""), &s, false);
    CHECK(m->coat == 0 && m->coat_roughness == 0 && m->coat_normal_scale == 1 && m->textures[EC_SLOT_CLEARCOAT_NORMAL].texture < 0);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_clearcoat", "'clearcoatFactor':0.5,'clearcoatRoughnessFactor':0.25,'clearcoatTexture':{'index':0},"
                         "'clearcoatRoughnessTexture':{'index':1},'clearcoatNormalTexture':{'index':5,'scale':-2}"), &s, false);
    CHECK(m->coat == 0.5f && m->coat_roughness == 0.25f && m->coat_normal_scale == -2);
    CHECK(m->textures[EC_SLOT_CLEARCOAT].texture == 0 && m->textures[EC_SLOT_CLEARCOAT_ROUGHNESS].texture == 1 &&
          m->textures[EC_SLOT_CLEARCOAT_NORMAL].texture == 2);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_clearcoat", "'clearcoatFactor':2,'clearcoatRoughnessFactor':-1"), &s, true);
    CHECK(m->coat == 1 && m->coat_roughness == 0);
    ec_scene_free(s);
    expect_failure(LAYER("KHR_materials_clearcoat", "'clearcoatFactor':'1'"), textured_blobs, "KHR_materials_clearcoat.clearcoatFactor must be a number");
    expect_failure(LAYER("KHR_materials_clearcoat", "'clearcoatNormalTexture':{}"), textured_blobs, "clearcoatNormalTexture.index is missing");
}

static void test_sheen(void)
{
    ec_scene *s;
    const ec_material *m = load_layer(LAYER("KHR_materials_sheen", ""), &s, false);
    CHECK(m->sheen[0] == 0 && m->sheen[2] == 0 && m->sheen_roughness == 0 && m->textures[EC_SLOT_SHEEN_COLOR].texture < 0);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_sheen", "'sheenColorFactor':[0.5,0.25,1],'sheenRoughnessFactor':0.75,'sheenColorTexture':{'index':0},"
                         "'sheenRoughnessTexture':{'index':1}"), &s, false);
    CHECK(m->sheen[0] == 0.5f && m->sheen[1] == 0.25f && m->sheen[2] == 1 && m->sheen_roughness == 0.75f);
    CHECK(m->textures[EC_SLOT_SHEEN_COLOR].texture == 0 && m->textures[EC_SLOT_SHEEN_ROUGHNESS].texture == 1);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_sheen", "'sheenColorFactor':[-1,0.5,3],'sheenRoughnessFactor':7"), &s, true);
    CHECK(m->sheen[0] == 0 && m->sheen[1] == 0.5f && m->sheen[2] == 1 && m->sheen_roughness == 1);
    ec_scene_free(s);
    expect_failure(LAYER("KHR_materials_sheen", "'sheenColorFactor':[1,1]"), textured_blobs, "KHR_materials_sheen.sheenColorFactor must have 3 numbers");
}

static void test_anisotropy(void)
{
    ec_scene *s;
    const ec_material *m = load_layer(LAYER("KHR_materials_anisotropy", ""), &s, false);
    CHECK(m->anisotropy == 0 && m->anisotropy_rotation == 0 && m->textures[EC_SLOT_ANISOTROPY].texture < 0);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_anisotropy", "'anisotropyStrength':0.5,'anisotropyRotation':0.25,'anisotropyTexture':{'index':1}"), &s, false);
    CHECK(m->anisotropy == 0.5f && m->anisotropy_rotation == 0.25f && m->textures[EC_SLOT_ANISOTROPY].texture == 0);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_anisotropy", "'anisotropyStrength':1.5,'anisotropyRotation':62831.853071795864"), &s, true);
    CHECK(m->anisotropy == 1 && fabsf(m->anisotropy_rotation) < 1e-6f); /* whole turns are removed */
    ec_scene_free(s);
    expect_failure(LAYER("KHR_materials_anisotropy", "'anisotropyRotation':[1]"), textured_blobs, "KHR_materials_anisotropy.anisotropyRotation must be a number");
}

static void test_film(void)
{
    ec_scene *s;
    const ec_material *m = load_layer(LAYER("KHR_materials_iridescence", ""), &s, false);
    CHECK(m->film == 0 && m->film_ior == 1.3f && m->film_least == 100 && m->film_most == 400 && m->textures[EC_SLOT_IRIDESCENCE].texture < 0);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_iridescence", "'iridescenceFactor':0.5,'iridescenceIor':1.75,'iridescenceThicknessMinimum':30,"
                         "'iridescenceThicknessMaximum':20,'iridescenceTexture':{'index':1},'iridescenceThicknessTexture':{'index':0}"), &s, false);
    CHECK(m->film == 0.5f && m->film_ior == 1.75f && m->film_least == 30 && m->film_most == 20);
    CHECK(m->textures[EC_SLOT_IRIDESCENCE].texture == 0 && m->textures[EC_SLOT_IRIDESCENCE_THICKNESS].texture == 1);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_iridescence", "'iridescenceFactor':2,'iridescenceIor':0.5,'iridescenceThicknessMaximum':-1"), &s, true);
    CHECK(m->film == 1 && m->film_ior == 1 && m->film_most == 0);
    ec_scene_free(s);
    expect_failure(LAYER("KHR_materials_iridescence", "'iridescenceIor':'1'"), textured_blobs, "KHR_materials_iridescence.iridescenceIor must be a number");
}

static void test_diffuse_transmission(void)
{
    ec_scene *s;
    const ec_material *m = load_layer(LAYER("KHR_materials_diffuse_transmission", ""), &s, false);
    CHECK(m->diffuse_transmission == 0 && m->transmission_color[0] == 1 && m->textures[EC_SLOT_DIFFUSE_TRANSMISSION].texture < 0);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_diffuse_transmission", "'diffuseTransmissionFactor':0.5,'diffuseTransmissionColorFactor':[0.25,0.5,1],"
                         "'diffuseTransmissionTexture':{'index':1},'diffuseTransmissionColorTexture':{'index':0}},"
                         "'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':2,'attenuationColor':[1,0.5,1]"), &s, false);
    CHECK(m->diffuse_transmission == 0.5f && m->transmission_color[0] == 0.25f && m->transmission_color[2] == 1 && ec_bounds(m) && !ec_refracts(m));
    CHECK(m->absorption[0] == 0 && fabsf(m->absorption[1] - 0.34657359f) < 1e-6f);
    CHECK(m->textures[EC_SLOT_DIFFUSE_TRANSMISSION].texture == 0 && m->textures[EC_SLOT_DIFFUSE_TRANSMISSION_COLOR].texture == 1);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_diffuse_transmission", "'diffuseTransmissionFactor':2,'diffuseTransmissionColorFactor':[-1,0,3]"), &s, true);
    CHECK(m->diffuse_transmission == 1 && m->transmission_color[0] == 0 && m->transmission_color[2] == 1);
    ec_scene_free(s);
    expect_failure(LAYER("KHR_materials_diffuse_transmission", "'diffuseTransmissionFactor':[1]"), textured_blobs,
                   "KHR_materials_diffuse_transmission.diffuseTransmissionFactor must be a number");
}

static void test_dispersion(void)
{
    ec_scene *s;
    const ec_material *m = load_layer(LAYER("KHR_materials_dispersion", "'dispersion':0.36"), &s, false);
    CHECK(m->dispersion == 0.36f);
    ec_scene_free(s);
    m = load_layer(LAYER("KHR_materials_dispersion", "'dispersion':-1"), &s, true);
    CHECK(m->dispersion == 0);
    ec_scene_free(s);
    expect_failure(LAYER("KHR_materials_dispersion", "'dispersion':true"), textured_blobs, "KHR_materials_dispersion.dispersion must be a number");
}

/* Extinction comes from the volume; drafts before 2026 had another name for the colour. */
static void test_scattering(void)
{
    static const char *const names[] = {"multiscatterColorFactor", "multiscatterColor"};
    ec_scene *s;
    char text[1200];
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text, LAYER("KHR_materials_volume_scatter", "'%s':[0.5,0.25,1],'scatterAnisotropy':-0.5},'KHR_materials_transmission':{},"
                 "'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':2,'attenuationColor':[1,0.5,1]"), names[i]);
        const ec_material *m = load_layer(text, &s, false);
        CHECK(m->scatter[0] == 0.5f && m->scatter[1] == 0.25f && m->scatter[2] == 1 && m->scatter_anisotropy == -0.5f && m->absorption[1] > 0);
        ec_scene_free(s);
    }
    const ec_material *m = load_layer(LAYER("KHR_materials_volume_scatter", "'multiscatterColorFactor':[-1,0.5,3],'scatterAnisotropy':1"), &s, true);
    CHECK(m->scatter[0] == 0 && m->scatter[1] == 0.5f && m->scatter[2] == 1 && m->scatter_anisotropy == 0.999f);
    ec_scene_free(s);
    expect_failure(LAYER("KHR_materials_volume_scatter", "'multiscatterColor':[1,1]"), textured_blobs, "KHR_materials_volume_scatter.multiscatterColor must have 3 numbers");
}

int main(void)
{
    test_coat();
    test_sheen();
    test_anisotropy();
    test_film();
    test_diffuse_transmission();
    test_dispersion();
    test_scattering();
    TEST_END();
}
