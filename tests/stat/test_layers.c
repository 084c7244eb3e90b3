/* tier: full */
/* Layered materials in whole pictures: tiles of each on a floor, between a lamp and a sky. All ways to find light must agree, and bits do
 * not depend on lanes or on built-in effects. */
#include "support/gltf_writer.h"
#include "support/render_case.h"

static const char *const tiles[] = {
    "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1}",
    "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.8,\"clearcoatRoughnessFactor\":0.4}",
    "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.9,0.5,0.2],\"sheenRoughnessFactor\":0.3}",
    "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.2,0.5,0.9],\"sheenRoughnessFactor\":1},"
    "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1,\"clearcoatRoughnessFactor\":0.2}",
    "\"KHR_materials_iridescence\":{\"iridescenceFactor\":0.9,\"iridescenceIor\":1.5,\"iridescenceThicknessMaximum\":380}",
    "\"KHR_materials_diffuse_transmission\":{\"diffuseTransmissionFactor\":0.6,\"diffuseTransmissionColorFactor\":[0.9,0.5,0.1]}",
    "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.7,\"anisotropyRotation\":0.6}",
    "\"KHR_materials_transmission\":{\"transmissionFactor\":0.9},\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.9}",
    "\"KHR_materials_transmission\":{\"transmissionFactor\":1},\"KHR_materials_volume\":{\"thicknessFactor\":1},"
    "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.9,\"anisotropyRotation\":1}",
};
enum { TILES = sizeof tiles / sizeof *tiles };

/* Matt bases, then metals of roughness 0.3. */
static const char *floor_of_tiles(void)
{
    gltf_writer *w = gltf_new();
    for (int i = 0; i < 2 * TILES; i++) {
        bool metal = i >= TILES;
        int id = gltf_add(&w->materials,
                          "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.6,0.4,1],\"metallicFactor\":%d,\"roughnessFactor\":%g},"
                          "\"extensions\":{%s}}", metal, metal ? 0.3 : 0.8, tiles[i % TILES]);
        gltf_quad(w, id, (double[3]){i % TILES - TILES / 2.0, 0, metal ? 0 : 1}, (double[3]){1, 0, 0}, (double[3]){0, 0, -1});
    }
    gltf_quad(w, gltf_lambert(w, 0, 8), (double[3]){-0.5, 1.5, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
    gltf_camera(w, (double[3]){0.3, 2.2, 3.5}, (double[3]){0, 0, 0}, 0.9);
    const char *path = gltf_write(w, "layers");
    static char kept[512];
    snprintf(kept, sizeof kept, "%s", path);
    free(w);
    return kept;
}

static void same_bits(const ec_scene *scene)
{
    static const uint32_t lanes[] = {8, 1, 4, 16, 0};
    case_image image[5];
    for (int i = 0; i < 5; i++) {
        ec_render_options o = case_options(32, 24, 8);
        o.lanes = lanes[i];
        if (i == 4) o = case_with_all_effects(o);
        image[i] = case_render(scene, &o);
        CHECK_MSG(case_same_bits(&image[i].film, &image[0].film), "lanes %u, all effects %d: other bits", o.lanes, o.all_effects);
    }
    printf("%s\n", case_effects(&image[0]));
    for (int i = 0; i < 5; i++) case_free(&image[i]);
}

/* Light sampling alone is left out: its rare bright paths from the metals' lobes need many more samples. */
static void strategies_agree(const ec_scene *scene)
{
    static const struct {
        ec_sample sample;
        uint32_t spp;
    } ways[3] = {{EC_SAMPLE_MIS, 2048}, {EC_SAMPLE_BSDF, 8192}, {EC_SAMPLE_HEMISPHERE, 8192}};
    case_image image[3];
    for (int i = 0; i < 3; i++) {
        ec_render_options o = case_quick(case_random(16, ways[i].spp, ways[i].sample, (uint64_t)ways[i].sample + 3));
        o.max_depth = 4;
        image[i] = case_render(scene, &o);
    }
    case_check_same(&image[1], &image[0], 4, "bsdf and mis");
    case_check_same(&image[2], &image[0], 4, "hemisphere and mis");
    for (int i = 0; i < 3; i++) case_free(&image[i]);
}

int main(void)
{
    ec_scene *scene = case_load(floor_of_tiles(), "0.5,0.6,0.7");
    same_bits(scene);
    strategies_agree(scene);
    ec_scene_free(scene);
    TEST_END();
}
