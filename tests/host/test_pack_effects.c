/* tier: quick */
/* The scan is exact: each effect has a pair of materials, one that needs the effect and one that nearly does. */
#include "pack/pack.h"
#include "support/effect_model.h"
#include "support/test.h"

static uint64_t scan(const ec_scene *scene)
{
    ec_pack pack;
    ec_error err = {0};
    char why[EC_EFFECT_WHY + 24];
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    uint64_t bits = pack.effects.bits;
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        ec_effects_why(&pack.effects, ec_features[i].bit, why, sizeof why);
        CHECK_MSG((bits & ec_features[i].bit) ? strlen(why) > 8 : !*why, "%s: why is \"%s\"", ec_features[i].name, why);
    }
    ec_pack_free(&pack);
    return bits;
}

static uint64_t scan_material(const ec_material *m)
{
    effect_model e = em_new();
    em_quad(&e, em_material(&e, m), NULL);
    ec_scene *scene = em_scene(&e);
    uint64_t bits = scan(scene);
    ec_scene_free(scene);
    return bits;
}

static void check(const char *feature, uint64_t bit, const ec_material *m, bool expected, const char *how, int line)
{
    uint64_t bits = scan_material(m);
    CHECK_MSG(!!(bits & bit) == expected, "line %d: %s: %s, by %s", line, feature, expected ? "not called for" : "called for", how);
}

/* Changes material m by `calls` and by `does_not`, starting from one that needs no effects. */
#define PAIR(feature, calls, does_not)                                                             \
    do {                                                                                           \
        ec_material one = em_plain(), *m = &one;                                                   \
        calls;                                                                                     \
        check(#feature, EC_FEATURE_##feature, m, true, #calls, __LINE__);                          \
        *m = em_plain();                                                                           \
        does_not;                                                                                  \
        check(#feature, EC_FEATURE_##feature, m, false, #does_not, __LINE__);                      \
    } while (0)
#define USE(slot, texture) em_use(m, EC_SLOT_##slot, EM_##texture)

static void test_weights(void)
{
    PAIR(EMISSION, m->emission[2] = 1, m->emission[2] = 0);
    PAIR(EMISSION, (m->emission[0] = 1, USE(EMISSION, MIXED)), (m->emission[0] = 1, USE(EMISSION, BLACK)));
    PAIR(AREA_LIGHTS, (m->emission[1] = 1, USE(EMISSION, GREEN)), (m->emission[0] = 1, USE(EMISSION, GREEN)));
    PAIR(EMISSION, m->emission[0] = 1, (m->emission[0] = 1, m->unlit = true));
    PAIR(SPECULAR, m->metallic = 1, (m->metallic = 1, USE(METALLIC_ROUGHNESS, GREEN)));
    PAIR(SPECULAR, m->specular = 0.1f, (m->specular = 0.1f, USE(SPECULAR, BLACK)));
    PAIR(SPECULAR, (m->specular = 1, memset(m->specular_color, 0, 12)), m->specular = 0); /* black is white at grazing angles: f90 */
    PAIR(TRANSMISSION, m->transmission = 0.1f, (m->transmission = 1, USE(TRANSMISSION, BLACK)));
    PAIR(TRANSMISSION, (m->transmission = 1, USE(TRANSMISSION, MIXED)), (m->transmission = 1, USE(TRANSMISSION, GREEN))); /* in the red channel */
    PAIR(TRANSMISSION, (m->transmission = 1, m->metallic = 0.9f), (m->transmission = m->metallic = 1));
    PAIR(TRANSMISSION, m->transmission = 1, (m->transmission = 1, m->unlit = true));
    PAIR(ABSORPTION, (m->transmission = 1, m->volume = true, m->absorption[1] = 1), (m->transmission = 1, m->absorption[1] = 1));
    PAIR(ABSORPTION, (m->transmission = 1, m->volume = true, m->absorption[1] = 1),
         (m->transmission = 1, m->volume = true, m->absorption[1] = 1, USE(TRANSMISSION, BLACK)));
    PAIR(SCATTERING, (m->transmission = 1, m->volume = true, m->absorption[1] = m->scatter[1] = 1),
         (m->transmission = 1, m->volume = true, m->absorption[1] = m->scatter[0] = 1)); /* in the red channel nothing blocks it */
    PAIR(SCATTERING, (m->diffuse_transmission = 1, m->volume = true, m->absorption[1] = m->scatter[1] = 1),
         (m->transmission = 1, m->absorption[1] = m->scatter[1] = 1));
    PAIR(CLEARCOAT, (m->coat = 1, USE(CLEARCOAT, WHITE)), (m->coat = 1, USE(CLEARCOAT, GREEN)));
    PAIR(CLEARCOAT, m->coat = 1, (m->coat = 1, m->unlit = true));
    PAIR(SHEEN, (m->sheen[1] = 1, USE(SHEEN_COLOR, GREEN)), (m->sheen[0] = m->sheen[2] = 1, USE(SHEEN_COLOR, GREEN)));
    PAIR(ANISOTROPY, (m->metallic = 1, m->roughness = 0.5f, m->anisotropy = 1), (m->metallic = m->roughness = m->anisotropy = 1));
    PAIR(ANISOTROPY, (m->metallic = 1, m->roughness = 0.5f, m->anisotropy = 1, USE(ANISOTROPY, WHITE)),
         (m->metallic = 1, m->roughness = 0.5f, m->anisotropy = 1, USE(ANISOTROPY, GREEN))); /* strength is in the blue channel */
    PAIR(ANISOTROPY, (m->metallic = 1, m->roughness = 0.5f, m->anisotropy = 1), (m->roughness = 0.5f, m->anisotropy = 1));
    PAIR(ANISOTROPY, (m->transmission = 1, m->roughness = 0.5f, m->anisotropy = 1), (m->transmission = m->roughness = m->anisotropy = 1));
    PAIR(ANISOTROPY, (m->transmission = 1, m->volume = true, m->roughness = 0, m->anisotropy = 0.1f), (m->transmission = 1, m->volume = true, m->roughness = 0));
    PAIR(IRIDESCENCE, m->film = 1, (m->film = 1, m->film_least = m->film_most = 0));
    PAIR(IRIDESCENCE, (m->film = 1, m->film_ior = 1.3f, m->film_most = 400), (m->film = 1, m->film_ior = 1, m->film_most = 400));
    PAIR(DIFFUSE_TRANSMISSION, m->diffuse_transmission = 1, (m->diffuse_transmission = 1, USE(DIFFUSE_TRANSMISSION, BLACK)));
    PAIR(DIFFUSE_TRANSMISSION, m->diffuse_transmission = 1, (m->diffuse_transmission = m->metallic = 1));
    PAIR(DISPERSION, (m->transmission = m->dispersion = 1, m->volume = true), (m->transmission = m->dispersion = 1));
    PAIR(SMOOTH, (m->metallic = 1, m->roughness = 0), (m->metallic = 1, m->roughness = 0.02f));
    PAIR(SMOOTH, (m->metallic = 1, m->roughness = 0), m->roughness = 0); /* nothing reflects */
    PAIR(UNLIT, m->unlit = true, m->unlit = false);
    PAIR(CULLING, m->double_sided = false, m->double_sided = true);
    PAIR(CULLING, (m->unlit = true, m->double_sided = false), m->unlit = true);
    PAIR(CULLING, (m->double_sided = false, m->transmission = 1), (m->double_sided = false, m->transmission = 1, m->volume = true));
}

/* Textures without influence: of one value, which becomes part of the factor; with a factor of 0; for a layer that is absent. */
static void test_textures(void)
{
    PAIR(BASE_COLOR_TEXTURE, USE(BASE_COLOR, MIXED), USE(BASE_COLOR, GREY));
    PAIR(BASE_COLOR_TEXTURE, USE(BASE_COLOR, MIXED), (memset(m->base_color, 0, 16), USE(BASE_COLOR, MIXED)));
    PAIR(BASE_COLOR_TEXTURE, (m->unlit = true, USE(BASE_COLOR, MIXED)), (m->unlit = true, USE(BASE_COLOR, WHITE)));
    PAIR(METALLIC_ROUGHNESS_TEXTURE, (m->metallic = 1, USE(METALLIC_ROUGHNESS, MIXED)), (m->metallic = 1, USE(METALLIC_ROUGHNESS, GREY)));
    PAIR(EMISSION_TEXTURE, (m->emission[0] = 1, USE(EMISSION, MIXED)), (m->emission[0] = 1, USE(EMISSION, WHITE)));
    PAIR(EMISSION_TEXTURE, (m->emission[0] = 1, USE(EMISSION, MIXED)), USE(EMISSION, MIXED));
    PAIR(SPECULAR_TEXTURE, (m->specular = 1, USE(SPECULAR, MIXED)), (m->specular = 1, USE(SPECULAR, GREY)));
    PAIR(SPECULAR_TEXTURE, (m->specular = 1, USE(SPECULAR_COLOR, MIXED)), (m->metallic = 1, USE(SPECULAR_COLOR, MIXED)));
    PAIR(TRANSMISSION_TEXTURE, (m->transmission = 1, USE(TRANSMISSION, MIXED)), (m->transmission = 1, USE(TRANSMISSION, WHITE)));
    PAIR(CLEARCOAT_TEXTURE, (m->coat = m->coat_roughness = 1, USE(CLEARCOAT_ROUGHNESS, MIXED)), (m->coat = 1, USE(CLEARCOAT_ROUGHNESS, MIXED)));
    PAIR(CLEARCOAT_TEXTURE, (m->coat = 1, USE(CLEARCOAT, MIXED)), USE(CLEARCOAT, MIXED));
    PAIR(CLEARCOAT_NORMAL_TEXTURE, (m->coat = 1, USE(CLEARCOAT_NORMAL, MIXED)), USE(CLEARCOAT_NORMAL, MIXED));
    PAIR(CLEARCOAT_NORMAL_TEXTURE, (m->coat = 1, USE(CLEARCOAT_NORMAL, MIXED)),
         (m->coat = 1, m->coat_normal_scale = 0, USE(CLEARCOAT_NORMAL, MIXED)));
    PAIR(SHEEN_TEXTURE, (m->sheen[0] = m->sheen_roughness = 1, USE(SHEEN_ROUGHNESS, MIXED)),
         (m->sheen[0] = m->sheen_roughness = 1, USE(SHEEN_ROUGHNESS, GREY)));
    PAIR(SHEEN_TEXTURE, (m->sheen[0] = 1, USE(SHEEN_COLOR, MIXED)), (m->sheen_roughness = 1, USE(SHEEN_ROUGHNESS, MIXED)));
    PAIR(ANISOTROPY_TEXTURE, (m->metallic = 1, m->roughness = 0.5f, m->anisotropy = 1, USE(ANISOTROPY, MIXED)), USE(ANISOTROPY, MIXED));
    PAIR(NORMAL_TEXTURE, USE(NORMAL, MIXED), (m->normal_scale = 0, USE(NORMAL, MIXED)));
    PAIR(FLOAT_TEXTURE, USE(BASE_COLOR, DEEP), (USE(BASE_COLOR, MIXED), USE(EMISSION, DEEP)));
}

static void test_coverage(void)
{
    PAIR(ALPHA, (m->alpha_mode = EC_ALPHA_BLEND, m->base_color[3] = 0.9f), m->alpha_mode = EC_ALPHA_BLEND);
    PAIR(ALPHA, (m->alpha_mode = EC_ALPHA_BLEND, USE(BASE_COLOR, MIXED)), (m->alpha_mode = EC_ALPHA_BLEND, USE(BASE_COLOR, WHITE)));
    PAIR(ALPHA, (m->alpha_mode = EC_ALPHA_MASK, m->alpha_cutoff = 0.5f, m->base_color[3] = 0.49f),
         (m->alpha_mode = EC_ALPHA_MASK, m->alpha_cutoff = 0.5f, m->base_color[3] = 0.5f));
    PAIR(ALPHA, (m->unlit = true, m->alpha_mode = EC_ALPHA_BLEND, m->base_color[3] = 0.9f), m->base_color[3] = 0.5f);
    /* A surface that nothing shows needs no more effects than its absence. */
    PAIR(SHEEN, (m->sheen[0] = 1, m->alpha_mode = EC_ALPHA_BLEND, m->base_color[3] = 0.1f),
         (m->sheen[0] = 1, m->alpha_mode = EC_ALPHA_BLEND, m->base_color[3] = 0));
    PAIR(AREA_LIGHTS, (m->emission[0] = 1, m->alpha_mode = EC_ALPHA_MASK, m->alpha_cutoff = 0.5f, USE(BASE_COLOR, MIXED)),
         (m->emission[0] = 1, m->alpha_mode = EC_ALPHA_MASK, m->alpha_cutoff = 0.5f, m->base_color[3] = 0.4f, USE(BASE_COLOR, MIXED)));
}

static void check_scene(effect_model *e, uint64_t bits, bool expected, const char *what)
{
    ec_scene *scene = em_scene(e);
    CHECK_MSG(!!(scan(scene) & bits) == expected, "%s", what);
    ec_scene_free(scene);
}

static void check_light(ec_light light, bool expected, const char *what)
{
    effect_model e = em_new();
    ec_material m = em_plain();
    em_quad(&e, em_material(&e, &m), NULL);
    ec_model_light(e.model, &light, (double[]){0, 0, 2}, (double[]){0, 0, 0});
    check_scene(&e, EC_FEATURE_PUNCTUAL_LIGHTS, expected, what);
}

static void test_lights(void)
{
    check_light((ec_light){.type = EC_LIGHT_POINT, .intensity = {0, 0, 1}}, true, "a blue point");
    check_light((ec_light){.type = EC_LIGHT_POINT}, false, "a black point");
    check_light((ec_light){.type = EC_LIGHT_DIRECTIONAL}, false, "a black sun");
    check_light((ec_light){.type = EC_LIGHT_SPOT, .intensity = {1, 1, 1}, .cos_inner = 1, .cos_outer = 0.9f}, true, "a spot");
    check_light((ec_light){.type = EC_LIGHT_SPOT, .intensity = {1, 1, 1}, .cos_inner = 1, .cos_outer = 1}, false, "a spot without width");
}

/* has: a map or a constant of this radiance, with one texel of `other`. */
static void check_environment(bool map, float radiance, float other, uint64_t bits)
{
    effect_model e = em_new();
    ec_material m = em_plain();
    em_quad(&e, em_material(&e, &m), NULL);
    ec_scene *scene = em_scene(&e);
    ec_environment *map_of = &scene->environment;
    scene->has_environment = true;
    for (int k = 0; k < 3; k++) map_of->constant[k] = radiance;
    if (map) {
        map_of->width = 4, map_of->height = 2;
        map_of->rgb = calloc(24, sizeof *map_of->rgb);
        for (int i = 0; i < 24; i++) map_of->rgb[i] = i < 21 ? radiance : other;
    }
    uint64_t found = scan(scene) & (EC_FEATURE_ENVIRONMENT | EC_FEATURE_ENVIRONMENT_MAP);
    CHECK_MSG(found == bits, "environment %d, %g, %g: %llx", map, (double)radiance, (double)other, (unsigned long long)found);
    ec_scene_free(scene);
}

static void test_environment(void)
{
    check_environment(false, 1, 0, EC_FEATURE_ENVIRONMENT);
    check_environment(false, 0, 0, 0);
    check_environment(true, 1, 2, EC_FEATURE_ENVIRONMENT | EC_FEATURE_ENVIRONMENT_MAP);
    check_environment(true, 1, 1, EC_FEATURE_ENVIRONMENT); /* a map of one radiance counts as a constant */
    check_environment(true, 0, 0, 0);
    check_environment(true, 0, 1, EC_FEATURE_ENVIRONMENT | EC_FEATURE_ENVIRONMENT_MAP);
}

/* A sheen that no triangle shows: no mesh uses it, or the mesh has no triangles or no area. Then a node shows it. */
static void test_unused(void)
{
    static const float flat[9] = {0, 0, 0, 1, 0, 0, 2, 0, 0}, area[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const double moved[16] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 5, 0, 0, 1}, squashed[16] = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
    ec_material plain = em_plain(), sheen = em_plain();
    sheen.sheen[0] = 1;
    sheen.double_sided = false;
    em_use(&sheen, EC_SLOT_BASE_COLOR, EM_MIXED);
    for (int i = 0; i < 5; i++) {
        effect_model e = em_new();
        em_quad(&e, em_material(&e, &plain), NULL);
        int32_t material = em_material(&e, &sheen);
        if (i == 3) ec_model_place(e.model, squashed);
        if (i == 4) ec_model_place(e.model, moved);
        if (i > 0) ec_model_add(e.model, material, &(ec_model_mesh){.vertex_count = i == 1 ? 2 : 3, .positions = i == 2 ? flat : area});
        ec_scene *scene = em_scene(&e);
        ec_pack pack;
        ec_error err = {0};
        CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
        CHECK_MSG(pack.effects.bits == (i < 4 ? 0 : EC_FEATURE_SHEEN | EC_FEATURE_CULLING | EC_FEATURE_SPECULAR | EC_FEATURE_BASE_COLOR_TEXTURE),
                  "case %d: %llx of a material that no triangle shows", i, (unsigned long long)pack.effects.bits);
        CHECK(pack.texel_words == (i < 4 ? 0 : EM_SIDE * EM_SIDE)); /* one of the images */
        ec_pack_free(&pack);
        ec_scene_free(scene);
    }
}

static void test_vertices(void)
{
    static const float straight[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, bent[12] = {0.6f, 0, 0.8f, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    ec_material m = em_plain();
    for (int i = 0; i < 3; i++) {
        effect_model e = em_new();
        em_quad(&e, em_material(&e, &m), i == 0 ? NULL : i == 1 ? straight : bent);
        check_scene(&e, EC_FEATURE_SMOOTH_NORMALS, i == 2, "vertex normals");
    }
    for (int i = 0; i < 3; i++) {
        effect_model e = em_new();
        em_quad(&e, em_material(&e, &m), NULL);
        ec_scene *scene = em_scene(&e);
        scene->colors = calloc(4 * (size_t)scene->vertex_count + 4, sizeof *scene->colors);
        for (uint32_t k = 0; k < 4 * scene->vertex_count; k++) scene->colors[k] = 1;
        if (i == 1) scene->colors[5] = 0.5f;
        if (i == 2) scene->colors[4 * scene->vertex_count++] = 0.5f; /* a vertex that no triangle uses */
        CHECK_MSG(!!(scan(scene) & EC_FEATURE_VERTEX_COLORS) == (i == 1), "vertex colours, case %d", i);
        ec_scene_free(scene);
    }
}

/* From a scene that needs all optional effects, each is left out: then the scene does not need it. */
static void test_without(void)
{
    ec_scene *scene = em_everything();
    ec_scene_view view;
    ec_error err = {0};
    CHECK_MSG((scan(scene) & ec_effects_optional) == ec_effects_optional, "not called for: %llx", (unsigned long long)(ec_effects_optional & ~scan(scene)));
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        uint64_t bit = ec_features[i].bit, off = bit;
        if (!(ec_effects_optional & bit)) continue;
        if (bit == EC_FEATURE_SPECULAR) off |= EC_FEATURE_TRANSMISSION | EC_FEATURE_CLEARCOAT | EC_FEATURE_SHEEN | EC_FEATURE_IRIDESCENCE | EC_FEATURE_DIFFUSE_TRANSMISSION; /* these reflect too */
        if (bit == EC_FEATURE_BASE_COLOR_TEXTURE) off |= EC_FEATURE_ALPHA; /* contains coverage */
        CHECK_OK(ec_scene_view_without(scene, off, EC_ALL_MATERIALS, &view, &err), err);
        CHECK_MSG(!(scan(&view.scene) & bit), "%s is called for though it is left out", ec_features[i].name);
        ec_scene_view_free(&view);
    }
    /* Half of the texels are 1 and half 0, which are the same in sRGB. Only one material is changed. */
    CHECK_OK(ec_scene_view_without(scene, EC_FEATURE_ENVIRONMENT_MAP, EC_ALL_MATERIALS, &view, &err), err);
    CHECK(scene->environment.rgb && !view.scene.environment.rgb);
    CHECK_NEAR(view.scene.environment.constant[0], 0.45, 1e-7);
    CHECK_NEAR(view.scene.environment.constant[2], 0.65, 1e-7);
    ec_scene_view_free(&view);
    uint64_t textures = EC_FEATURE_BASE_COLOR_TEXTURE | EC_FEATURE_METALLIC_ROUGHNESS_TEXTURE | EC_FEATURE_NORMAL_TEXTURE;
    CHECK_OK(ec_scene_view_without(scene, textures, 1, &view, &err), err);
    const ec_material *m = &view.scene.materials[1];
    CHECK(m->base_color[0] == 0.25f && m->metallic == 0.25f && m->roughness == 0.25f);
    CHECK(m->textures[EC_SLOT_BASE_COLOR].texture < 0 && m->textures[EC_SLOT_NORMAL].texture < 0);
    CHECK(m->textures[EC_SLOT_SPECULAR].texture == EM_MIXED && view.scene.materials[2].textures[EC_SLOT_NORMAL].texture == EM_MIXED);
    ec_scene_view_free(&view);
    /* Coverage stays: for a texture with alpha, only its colours are left out. */
    CHECK_OK(ec_scene_view_without(scene, EC_FEATURE_BASE_COLOR_TEXTURE, EC_ALL_MATERIALS, &view, &err), err);
    m = &view.scene.materials[7];
    CHECK(m->base_color[0] == 0.25f && m->base_color[3] == 0.5f && m->textures[EC_SLOT_BASE_COLOR].texture != EM_MIXED);
    const ec_image *whole = &scene->images[EM_MIXED], *bare = &view.scene.images[view.scene.textures[m->textures[EC_SLOT_BASE_COLOR].texture].image];
    for (int i = 0; i < 4 * EM_SIDE * EM_SIDE; i++) CHECK(bare->rgba8[i] == (i % 4 == 3 ? whole->rgba8[i] : 255));
    ec_effects called;
    char why[EC_EFFECT_WHY + 24];
    CHECK_OK(ec_scene_calls(&view.scene, &called, &err), err);
    ec_effects_why(&called, EC_FEATURE_BASE_COLOR_TEXTURE, why, sizeof why);
    CHECK_MSG(!strcmp(why, "material 7 has alpha in its base colour texture"), "%s", why);
    ec_scene_view_free(&view);
    scene->materials[7].textures[EC_SLOT_BASE_COLOR].texture = EM_DEEP;
    CHECK_OK(ec_scene_view_without(scene, EC_FEATURE_BASE_COLOR_TEXTURE, 7, &view, &err), err);
    m = &view.scene.materials[7];
    bare = &view.scene.images[view.scene.textures[m->textures[EC_SLOT_BASE_COLOR].texture].image];
    for (int i = 0; i < 4 * EM_SIDE * EM_SIDE; i++) CHECK(bare->rgba16[i] == (i % 4 == 3 ? scene->images[EM_DEEP].rgba16[i] : 65535));
    ec_scene_view_free(&view);
    ec_scene_free(scene);
}

static void test_names(void)
{
    effect_model e = em_new();
    ec_material m = em_plain();
    m.double_sided = false;
    em_quad(&e, em_material(&e, &m), NULL);
    ec_scene *scene = em_scene(&e);
    ec_effects called;
    ec_error err = {0};
    char why[EC_EFFECT_WHY + 24];
    free(scene->materials[0].name);
    scene->materials[0].name = strdup("aéééééééééééééééééééé"); /* 36 bytes end within one */
    CHECK_OK(ec_scene_calls(scene, &called, &err), err);
    ec_effects_why(&called, EC_FEATURE_CULLING, why, sizeof why);
    CHECK_MSG(!strcmp(why, "material 0 \"aééééééééééééééééé\" is single-sided"), "%s", why);
    ec_scene_free(scene);
}

/* Requested by an option, for visible rough metal and glass. */
static void check_rough(const ec_material *m, bool expected, int line)
{
    effect_model e = em_new();
    ec_material unused = em_plain();
    unused.metallic = unused.roughness = 1;
    em_material(&e, &unused);
    em_quad(&e, em_material(&e, m), NULL);
    ec_scene *scene = em_scene(&e);
    ec_pack pack;
    ec_effects packed = {0}, found;
    ec_error err = {0};
    CHECK_OK(ec_pack_scene(scene, &pack, &err), err);
    ec_pack_rough(&pack.plain.scene, &packed);
    CHECK_OK(ec_scene_rough(scene, &found, &err), err);
    CHECK_MSG(!(pack.effects.bits & EC_FEATURE_MULTISCATTER), "line %d: called for without the option", line);
    CHECK_MSG(packed.bits == (expected ? EC_FEATURE_MULTISCATTER : 0), "line %d: %llx", line, (unsigned long long)packed.bits);
    CHECK_MSG(found.bits == packed.bits, "line %d: %llx by itself", line, (unsigned long long)found.bits);
    ec_pack_free(&pack);
    ec_scene_free(scene);
}

static void test_rough(void)
{
    ec_material one = em_plain(), *m = &one;
    check_rough(m, false, __LINE__);
    m->metallic = 1, m->roughness = 0.5f;
    check_rough(m, true, __LINE__);
    m->roughness = 0.005f;
    check_rough(m, false, __LINE__);
    m->roughness = 1, USE(METALLIC_ROUGHNESS, BLACK);
    check_rough(m, false, __LINE__);
    *m = em_plain(), m->roughness = 0.5f, m->transmission = 0.2f;
    check_rough(m, true, __LINE__);
    USE(TRANSMISSION, BLACK);
    check_rough(m, false, __LINE__);
    *m = em_plain(), m->metallic = 1, m->roughness = 0.5f, m->unlit = true;
    check_rough(m, false, __LINE__);
    *m = em_plain(), m->specular = 1, m->roughness = 1; /* plastic loses almost nothing */
    check_rough(m, false, __LINE__);
}

int main(void)
{
    const ec_material nothing = em_plain();
    CHECK(scan_material(&nothing) == 0);
    test_weights();
    test_textures();
    test_coverage();
    test_lights();
    test_environment();
    test_unused();
    test_vertices();
    test_without();
    test_names();
    test_rough();
    TEST_END();
}
