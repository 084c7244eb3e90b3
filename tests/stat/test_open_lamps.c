/* tier: full */
/* A lamp with holes, or with partial coverage, emits its light times its coverage, for every way to find it: a path hits it as rarely as
 * that, and a light sample has that weight. Closed form under an infinite ceiling that emits. */
#include "support/gltf_writer.h"
#include "support/render_case.h"

enum { ALBEDO = 6 /* tenths */, RADIANCE = 2 };

/* Alpha from a factor, and from the corners' colours: `left` at -x, `right` at +x. */
static void lit(const char *name, const char *mode, double factor, double left, double right, double coverage)
{
    for (int s = 0; s < 4; s++) {
        gltf_writer *w = gltf_new();
        gltf_quad(w, gltf_lambert(w, 0.1 * ALBEDO, 0), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
        gltf_camera(w, (double[3]){0, 0.2, 0}, (double[3]){0, 0, 0}, 1e-5);
        int lamp = gltf_add(&w->materials,
                            "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,%g]},\"emissiveFactor\":[1,1,1],%s,"
                            "\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":%d}}}", factor, mode, RADIANCE);
        const double alpha[4] = {left, right, right, left};
        float colors[16];
        for (int k = 0; k < 16; k++) colors[k] = k % 4 == 3 ? (float)alpha[k / 4] : 1;
        gltf_quad_with(w, lamp, (double[3]){-500, 1, -500}, (double[3]){1000, 0, 0}, (double[3]){0, 0, 1000}, colors, NULL);
        ec_render_options o = case_quick(case_options(8, 8, 4096));
        o.max_depth = 2;
        o.sample = (ec_sample)s;
        case_image image = case_render_file(gltf_write(w, "open-lamp"), "0,0,0", &o);
        printf("%-24s %.6f +- %.6f of %.6f\n", name, image.mean[1], image.mean_se[1], coverage * 0.1 * ALBEDO * RADIANCE);
        CASE_NEAR(&image, coverage * 0.1 * ALBEDO * RADIANCE, 4, 8e-3);
        case_free(&image);
        free(w);
    }
}

/* Lamps that count as points at their centres also have their alpha's brightness, in every lane width. */
static double by_centre(ec_integrator integrator, double alpha, uint32_t lanes)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, gltf_lambert(w, 0.5, 0), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
    gltf_camera(w, (double[3]){0, 0.2, 0}, (double[3]){0, 0, 0}, 1e-5);
    int lamp = gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,%g]},\"emissiveFactor\":[1,1,1],\"alphaMode\":\"BLEND\"}", alpha);
    gltf_quad(w, lamp, (double[3]){-1, 1, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
    ec_render_options o = case_quick(case_options(8, 8, 16));
    o.integrator = integrator;
    o.lanes = lanes;
    case_image image = case_render_file(gltf_write(w, "open-lamp"), "0,0,0", &o);
    double mean = image.mean[1];
    case_free(&image);
    free(w);
    return mean;
}

static void lit_by_centres(void)
{
    static const ec_integrator integrators[] = {EC_INTEGRATOR_WHITTED, EC_INTEGRATOR_RASTER};
    for (int i = 0; i < 2; i++) {
        double whole = by_centre(integrators[i], 1, 4);
        for (uint32_t lanes = 1; lanes <= 4; lanes += 3)
            CHECK_NEAR(by_centre(integrators[i], 0.25, lanes), 0.25 * whole, 1e-6 * whole);
    }
}

int main(void)
{
    lit_by_centres();
    lit("not open", "\"alphaMode\":\"OPAQUE\"", 0.3, 0.2, 0.4, 1);
    lit("alpha", "\"alphaMode\":\"BLEND\"", 0.3, 1, 1, 0.3);
    lit("vertex alpha", "\"alphaMode\":\"BLEND\"", 0.5, 1, 0.2, 0.3);
    lit("one half cut away", "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.5", 1, 1, 0, 0.5);
    TEST_END();
}
