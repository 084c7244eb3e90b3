/* tier: full */
/* A clear coat over emission (KHR_materials_clearcoat, "Emission"): a lamp emits Le (1 - c F(n . v)) along v, with Schlick's F, f0 = 0.04,
 * about the coat's normal. Closed forms for a lamp in view and for one that lights a floor, for every way to find its light. */
#include "support/gltf_writer.h"
#include "support/render_case.h"

#define PI 3.14159265358979323846

static double schlick(double cosine) { return 0.04 + 0.96 * pow(1 - cosine, 5); }
static const double mean_reflectance = 0.04 + 0.96 / 21; /* cosine-weighted mean over all directions: 2 B(2, 6) = 1 / 21 */

static int coated(gltf_writer *w, double radiance, double coat, const char *more)
{
    return gltf_add(&w->materials,
                    "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1],\"metallicFactor\":0},\"emissiveFactor\":[1,1,1],"
                    "\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0},\"KHR_materials_clearcoat\":{\"clearcoatFactor\":%g%s},"
                    "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":%.9g}}}", coat, more, radiance);
}

static case_image picture(gltf_writer *w, const char *name, ec_integrator integrator, ec_sample sample, uint32_t spp)
{
    ec_render_options o = case_quick(case_options(8, 8, spp));
    o.max_depth = 2;
    o.integrator = integrator;
    o.sample = sample;
    char file[64];
    snprintf(file, sizeof file, "coated-%s", name);
    case_image image = case_render_file(gltf_write(w, file), "0,0,0", &o);
    printf("%-28s %.6f +- %.6f\n", name, image.mean[1], image.mean_se[1]);
    return image;
}

/* Seen at an angle to the facet; with `turn`, the mesh's normal is rotated away from the facet's by this angle, towards the eye. */
static void seen(double degrees, double turn, double coat, double texel)
{
    for (int i = 0; i < 3; i++) {
        gltf_writer *w = gltf_new();
        const double angle = degrees * PI / 180, way = turn * PI / 180;
        const float n[3] = {(float)sin(way), (float)cos(way), 0};
        float normals[12];
        for (int k = 0; k < 12; k++) normals[k] = n[k % 3];
        char more[96] = "";
        if (texel < 1) {
            uint8_t rgb[3] = {(uint8_t)(255 * texel), 9, 9};
            ec_error err = {0};
            CHECK_OK(ec_png_write(ECLAT_TEST_OUT "/coated-seen-0.png", 1, 1, rgb, &err), err);
            snprintf(more, sizeof more, ",\"clearcoatTexture\":{\"index\":%d}", gltf_add(&w->textures, "{\"source\":0}"));
        }
        gltf_quad_with(w, coated(w, 3, coat, more), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2}, NULL, normals);
        gltf_camera(w, (double[3]){3 * sin(angle), 3 * cos(angle), 0}, (double[3]){0, 0, 0}, 1e-5);
        case_image image = picture(w, "seen", (ec_integrator[]){EC_INTEGRATOR_PATH, EC_INTEGRATOR_WHITTED, EC_INTEGRATOR_RASTER}[i], EC_SAMPLE_MIS, 16);
        const double share = coat * floor(255 * texel) / 255 * schlick(cos(angle - way));
        CHECK_MSG(fabs(image.mean[1] - 3 * (1 - share)) < 2e-5, "%g degrees, integrator %d: %.6f, expected %.6f", degrees, i, image.mean[1], 3 * (1 - share));
        case_free(&image);
        free(w);
    }
}

static gltf_writer *grey_floor(void)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 0.6, 0), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
    gltf_camera(w, (double[3]){0.1, 0.2, 0}, (double[3]){0.1, 0, 0}, 1e-5);
    return w;
}

/* A point under an infinite ceiling that emits. */
static void lit_from_everywhere(void)
{
    for (int s = 0; s < 4; s++) {
        gltf_writer *w = grey_floor();
        gltf_quad(w, coated(w, 2, 0.9, ""), (double[3]){-2e4, 1, -2e4}, (double[3]){4e4, 0, 0}, (double[3]){0, 0, 4e4});
        case_image image = picture(w, "ceiling", EC_INTEGRATOR_PATH, (ec_sample)s, 16384);
        const double expected = 1.2 * (1 - 0.9 * mean_reflectance); /* 2e-5: floats, for triangles 40 000 times as wide as their distance */
        for (int c = 0; c < 3; c++)
            CHECK_MSG(fabs(image.mean[c] - expected) <= 4 * image.mean_se[c] + 2e-5 * expected && image.mean_se[c] <= 2e-3 * expected,
                      "strategy %d, channel %d: %.7f +- %.1e, expected %.7f", s, c, image.mean[c], image.mean_se[c], expected);
        case_free(&image);
        free(w);
    }
}

/* whitted and raster treat a lamp as a point at its centre, and a small body as a disc that faces all directions. */
static void lit_from_centres(void)
{
    for (int i = 0; i < 4; i++) {
        double light[2], factor = 0;
        for (int with = 0; with < 2; with++) {
            gltf_writer *w = grey_floor();
            int lamp = coated(w, 2, with, "");
            double d[3] = {0.9, 1, 0}, r = 0.01;
            if (i < 2) gltf_quad(w, lamp, (double[3]){d[0] + 0.1 - r, d[1], -r}, (double[3]){2 * r, 0, 0}, (double[3]){0, 0, 2 * r});
            else gltf_box(w, lamp, (double[3]){d[0] + 0.1 - r, d[1] - r, -r}, (double[3]){d[0] + 0.1 + r, d[1] + r, r});
            factor = 1 - (i < 2 ? schlick(1 / sqrt(1 + d[0] * d[0])) : mean_reflectance);
            case_image image = picture(w, i < 2 ? "centre" : "body", i % 2 ? EC_INTEGRATOR_RASTER : EC_INTEGRATOR_WHITTED, EC_SAMPLE_MIS, 16);
            light[with] = image.mean[1];
            case_free(&image);
            free(w);
        }
        CHECK_MSG(light[0] > 0 && fabs(light[1] / light[0] - factor) < 2e-5, "lamp %d: %.6f of the light, expected %.6f", i, light[1] / light[0], factor);
    }
}

int main(void)
{
    seen(80, 15, 0.6, 0.5);
    seen(70, 0, 0.6, 0.5);
    seen(80, 15, 1, 1);
    seen(0, 0, 1, 1);
    seen(70, 0, 1, 1);
    lit_from_everywhere();
    lit_from_centres();
    TEST_END();
}
