/* tiers: quick, full */
/* The rasteriser sees the same as camera rays: first-hit depth and coverage of the same samples, one a pixel, in at least 99.9 % of the
 * pixels (only samples within rounding of a silhouette may differ). Its picture does not depend on the order of triangles or on how the
 * work is divided. */
#include "support/gltf_writer.h"
#include "support/render_case.h"

enum { SIZE = 256 };

static case_image render(const ec_scene *scene, ec_integrator integrator, uint32_t camera, uint32_t spp)
{
    ec_render_options o = case_with_all_effects(case_options(SIZE, SIZE, spp));
    o.max_depth = 1;
    o.camera = camera;
    o.integrator = integrator;
    return case_render(scene, &o);
}

static int same_place(const float *a, const float *b)
{
    return a[7] == b[7] && fabsf(a[6] - b[6]) <= 1e-4f * b[6];
}

static void check_agreement(const char *path, uint32_t camera)
{
    if (!case_present(path)) {
        printf("not there: %s\n", path);
        return;
    }
    ec_scene *scene = case_load(path, NULL);
    case_image raster = render(scene, EC_INTEGRATOR_RASTER, camera, 1), rays = render(scene, EC_INTEGRATOR_PATH, camera, 1);
    uint32_t differ = 0, seen = 0;
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        differ += !same_place(ec_film_features_at(&raster.film, i), ec_film_features_at(&rays.film, i));
        seen += ec_film_features_at(&rays.film, i)[EC_FILM_ALPHA] > 0;
    }
    printf("%-60.60s camera %u: %u of %u pixels differ, %u covered\n", strrchr(path, '/') + 1, camera, differ, SIZE * SIZE, seen);
    CHECK_MSG(seen > SIZE, "%s: nothing to see", path);
    CHECK_MSG(differ <= SIZE * SIZE / 1000, "%s, camera %u: %u pixels differ", path, camera, differ);
    case_free(&raster);
    case_free(&rays);
    ec_scene_free(scene);
}

static void swap_triangles(uint32_t *indices, uint32_t *materials, uint32_t a, uint32_t b)
{
    for (int k = 0; k < 3; k++) {
        uint32_t t = indices[3 * a + k];
        indices[3 * a + k] = indices[3 * b + k];
        indices[3 * b + k] = t;
    }
    uint32_t t = materials[a];
    materials[a] = materials[b];
    materials[b] = t;
}

static void check_order(const char *path)
{
    ec_scene *scene = case_load(path, NULL);
    case_image one = render(scene, EC_INTEGRATOR_RASTER, 0, 4);
    for (uint32_t a = 0, b = scene->triangle_count - 1; a < b; a++, b--)
        swap_triangles(scene->indices, scene->triangle_material, a, b);
    case_image other = render(scene, EC_INTEGRATOR_RASTER, 0, 4);
    uint32_t differ = 0;
    for (uint32_t i = 0; i < 3 * SIZE * SIZE; i++) differ += one.rgb[i] != other.rgb[i];
    CHECK_MSG(differ == 0, "%s: %u values depend on the order of the triangles", path, differ);
    case_free(&one);
    case_free(&other);
    ec_scene_free(scene);
}

static void check_same_bits(const char *path)
{
    ec_scene *scene = case_load(path, NULL);
    case_image first = render(scene, EC_INTEGRATOR_RASTER, 0, 4);
    static const uint32_t lanes[] = {1, 4, 8, 16}, waves[] = {5000, 20000, 0, 0};
    for (int i = 0; i < 4; i++) {
        ec_render_options o = case_options(SIZE, SIZE, 4);
        o.integrator = EC_INTEGRATOR_RASTER;
        o.lanes = lanes[i];
        o.wave = waves[i];
        case_image image = case_render(scene, &o);
        CHECK_MSG(!memcmp(image.rgb, first.rgb, 12 * SIZE * SIZE), "%s: %u lanes, wave %u", path, lanes[i], waves[i]);
        case_free(&image);
    }
    case_free(&first);
    ec_scene_free(scene);
}

/* No highlight is narrower than alpha 0.02. One stretched to alpha 1 along one axis keeps that width, however narrow it is across. */
static void check_brushed(void)
{
    case_image image[2];
    for (int i = 0; i < 2; i++) {
        gltf_writer *w = gltf_new();
        int metal = gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":%.9g},\"extensions\":{"
                                            "\"KHR_materials_anisotropy\":{\"anisotropyStrength\":1}}}", i ? sqrt(0.02) : 0.0);
        gltf_quad(w, metal, (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        gltf_light(w, (double[3]){0, 1, -1}, (double[3]){0, -1, 0}, "{\"type\":\"point\",\"intensity\":10}");
        gltf_camera(w, (double[3]){0, 1, 1}, (double[3]){0, 0, 0}, 1);
        ec_scene *scene = case_load(gltf_write(w, "raster-brushed"), NULL);
        image[i] = render(scene, EC_INTEGRATOR_RASTER, 0, 1);
        ec_scene_free(scene);
        free(w);
    }
    double worst = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i++) worst = fmax(worst, fabs((double)image[0].rgb[i] - image[1].rgb[i]) / (image[1].rgb[i] + 1e-3));
    printf("brushed metal of roughness 0 and 0.14: the same but for %.1e, mean %.3f\n", worst, image[1].mean[1]);
    CHECK_MSG(worst < 1e-3 && image[1].mean[1] > 0.1, "brushed metal: %g apart, mean %g", worst, image[1].mean[1]);
    case_free(&image[0]);
    case_free(&image[1]);
}

int main(void)
{
    if (test_tier("quick")) check_brushed();
    if (!test_tier("full")) TEST_END();
    check_agreement(OWN_SCENE("cornell-box/cornell-box.gltf"), 0);
    check_agreement(OWN_SCENE("showcase/showcase.gltf"), 0);
    check_agreement(OWN_SCENE("lamps/lamps.gltf"), 0);
    check_agreement(OWN_SCENE("lamps/lamps.gltf"), 1); /* orthographic */
    check_agreement(OWN_SCENE("veach-plates/veach-plates.gltf"), 0);
    check_agreement(OWN_SCENE("furnace/box-materials.gltf"), 0); /* the camera is inside: walls pass through the camera's plane */
    check_agreement(SHARED("assets/classic/gltf/sponza-dabrovic/sponza-dabrovic.gltf"), 0);
    check_agreement(SHARED("assets/gltf/DamagedHelmet/glTF-Binary/DamagedHelmet.glb"), 0);
    check_agreement(SHARED("assets/gltf/AlphaBlendModeTest/glTF-Binary/AlphaBlendModeTest.glb"), 0);
    check_agreement(SHARED("assets/gltf/TextureSettingsTest/glTF/TextureSettingsTest.gltf"), 0);
    check_order(OWN_SCENE("showcase/showcase.gltf"));
    check_same_bits(OWN_SCENE("lamps/lamps.gltf"));
    TEST_END();
}
