/* tier: full */
/* --scattering multiple in whole pictures: rough metal and rough glass under a lamp and a sky. All ways to find light agree, the regained
 * light shows, and white metal in white light returns no more than arrives. */
#include "support/gltf_writer.h"
#include "support/render_case.h"

static int metal(gltf_writer *w, double base, double roughness)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],\"metallicFactor\":1,\"roughnessFactor\":%g}}", base,
                    base * base, base * base * base, roughness);
}

static const char *boxes(void)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, metal(w, 0.9, 0.7), (double[3]){-2, 0, 2}, (double[3]){4, 0, 0}, (double[3]){0, 0, -4});
    gltf_glass rough = {1, 0.8, 1, 1.5, {0}, 0}, pane = {1, 0.6, 1, 0, {0}, 0};
    gltf_box(w, gltf_add_glass(w, &rough), (double[3]){-1.1, 0.1, -0.4}, (double[3]){-0.3, 0.9, 0.4});
    gltf_quad(w, gltf_add_glass(w, &pane), (double[3]){-0.2, 0.1, 0.3}, (double[3]){0.6, 0, 0}, (double[3]){0, 0.8, 0});
    gltf_box(w, metal(w, 1, 1), (double[3]){0.5, 0, -0.4}, (double[3]){1.2, 0.7, 0.4});
    gltf_quad(w, gltf_lambert(w, 0, 6), (double[3]){-0.6, 1.6, -0.6}, (double[3]){1.2, 0, 0}, (double[3]){0, 0, 1.2});
    gltf_camera(w, (double[3]){0.2, 1.2, 3}, (double[3]){0, 0.4, 0}, 0.8);
    static char kept[512];
    snprintf(kept, sizeof kept, "%s", gltf_write(w, "multiple-scattering"));
    free(w);
    return kept;
}

static case_image picture(const ec_scene *scene, ec_sample sample, ec_scattering scattering, uint32_t spp)
{
    ec_render_options o = case_quick(case_random(16, spp, sample, (uint64_t)sample + 7));
    o.max_depth = 5;
    o.scattering = scattering;
    return case_render(scene, &o);
}

/* Light sampling alone is left out: it does not find light through glass. */
static void strategies_agree(void)
{
    ec_scene *scene = case_load(boxes(), "0.4,0.5,0.6");
    case_image mis = picture(scene, EC_SAMPLE_MIS, EC_SCATTERING_MULTIPLE, 4096), bsdf = picture(scene, EC_SAMPLE_BSDF, EC_SCATTERING_MULTIPLE, 8192);
    case_image uniform = picture(scene, EC_SAMPLE_HEMISPHERE, EC_SCATTERING_MULTIPLE, 8192), once = picture(scene, EC_SAMPLE_MIS, EC_SCATTERING_SINGLE, 1024);
    case_check_same(&bsdf, &mis, 4, "bsdf and mis");
    case_check_same(&uniform, &mis, 4, "hemisphere and mis");
    printf("%.4f +- %.4f, once: %.4f +- %.4f\n", mis.mean[0], mis.mean_se[0], once.mean[0], once.mean_se[0]);
    CHECK(mis.mean[0] > 1.05 * once.mean[0]);
    case_image *all[] = {&mis, &bsdf, &uniform, &once};
    for (int i = 0; i < 4; i++) case_free(all[i]);
    ec_scene_free(scene);
}

/* A white metal quad in a sky of 1, rendered by all kernels: at most 1, and nearly 1. */
static void furnace_stays_at_one(void)
{
    for (int i = 0; i < 2; i++) {
        gltf_writer *w = gltf_new();
        gltf_quad(w, metal(w, 1, i ? 0.5 : 1), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        gltf_camera(w, (double[3]){2, 1, 0}, (double[3]){0, 0, 0}, 1e-5);
        ec_scene *scene = case_load(gltf_write(w, "multiple-furnace"), "1,1,1");
        case_image image = picture(scene, EC_SAMPLE_MIS, EC_SCATTERING_MULTIPLE, 4096);
        printf("furnace: %.5f +- %.5f\n", image.mean[0], image.mean_se[0]);
        CHECK(image.mean[0] <= 1 + 4 * image.mean_se[0] && image.mean[0] > 0.99 && image.mean_se[0] < 1e-3);
        case_free(&image);
        ec_scene_free(scene);
        free(w);
    }
}

int main(void)
{
    strategies_agree();
    furnace_stays_at_one();
    TEST_END();
}
