/* tier: full */
/* KHR_materials_dispersion: the direction in which a prism refracts each line, by Snell's law. And each channel of a picture with
 * dispersion equals that channel of a picture whose glass has the channel's index for all. */
#include "support/gltf_writer.h"
#include "support/render_case.h"

/* Cauchy's two terms from n_d and the Abbe number, at the lines C, d and F. */
static double index_of(int channel, double n, double dispersion)
{
    static const double line[3] = {656.3, 587.6, 486.1};
    double b = (n - 1) * dispersion / 20 / (pow(line[2], -2) - pow(line[0], -2));
    return fmax(n + b * (pow(line[channel], -2) - pow(line[1], -2)), 1);
}

static int add_glass(gltf_writer *w, double ior, double dispersion, double roughness)
{
    return gltf_add(&w->materials,
                    "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":%.9g},\"extensions\":{\"KHR_materials_transmission\":"
                    "{\"transmissionFactor\":1},\"KHR_materials_ior\":{\"ior\":%.9g},\"KHR_materials_volume\":{\"thicknessFactor\":1},"
                    "\"KHR_materials_dispersion\":{\"dispersion\":%.9g}}}", roughness, ior, dispersion);
}

static double passed(double cosine, double n) /* Fresnel transmittance for light from air at this cosine */
{
    double beyond = sqrt(1 - (1 - cosine * cosine) / (n * n));
    double s = (cosine - n * beyond) / (cosine + n * beyond), p = (n * cosine - beyond) / (n * cosine + beyond);
    return 1 - (s * s + p * p) / 2;
}

/* One ray enters a prism of 60 degrees at the angle of minimum deviation of the line d. Each line must hit a strip that emits only its
 * colour, half as wide as the distance between lines, with the light that both faces transmit. max_depth leaves out internal reflections. */
static void prism(double n, double dispersion)
{
    const double rad = 3.14159265358979323846 / 180, apex = 60 * rad, incidence = asin(n * sin(apex / 2)), far = 40;
    double expected[3], way[3][2];
    gltf_writer *w = gltf_new();
    int glass = add_glass(w, n, dispersion, 0);
    double into = incidence - apex / 2; /* above the horizon */
    /* Faces through the apex (0, 1) down to y = -1, outwards: x = -+2 tan(apex / 2). */
    double half = 2 * tan(apex / 2);
    gltf_quad(w, glass, (double[3]){0, 1, -5}, (double[3]){-half, -2, 0}, (double[3]){0, 0, 10});
    gltf_quad(w, glass, (double[3]){0, 1, -5}, (double[3]){0, 0, 10}, (double[3]){half, -2, 0});
    gltf_quad(w, glass, (double[3]){-half, -1, -5}, (double[3]){2 * half, 0, 0}, (double[3]){0, 0, 10});
    double foot[2] = {-half / 2, 0};
    for (int k = 0; k < 3; k++) {
        double index = index_of(k, n, dispersion), one = asin(sin(incidence) / index), two = apex - one, out = asin(index * sin(two));
        double inside = into - (incidence - one); /* above the horizon; the left face's inner normal points apex / 2 below it */
        /* The ray goes from the base to the right face, x = half / 2 (1 - y), and leaves it away from its normal, which points apex / 2
         * above the horizon. */
        double t = (half / 2 * (1 - foot[1]) - foot[0]) / (cos(inside) + half / 2 * sin(inside));
        double x = foot[0] + t * cos(inside), y = foot[1] + t * sin(inside), leaves = apex / 2 - out;
        way[k][0] = x + far * cos(leaves), way[k][1] = y + far * sin(leaves);
        expected[k] = passed(cos(incidence), index) * passed(cos(out), index);
    }
    double across[2] = {way[2][0] - way[0][0], way[2][1] - way[0][1]}, apart = hypot(across[0], across[1]), nearest = apart;
    for (int k = 0; k < 2; k++) nearest = fmin(nearest, hypot(way[k + 1][0] - way[k][0], way[k + 1][1] - way[k][1]));
    for (int k = 0; k < 3; k++) {
        double u[2] = {across[0] / apart * nearest / 2, across[1] / apart * nearest / 2};
        int strip = gltf_add(&w->materials, "{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1]},\"emissiveFactor\":[%d,%d,%d]}",
                             k == 0, k == 1, k == 2);
        gltf_quad(w, strip, (double[3]){way[k][0] - u[0] / 2, way[k][1] - u[1] / 2, -5}, (double[3]){u[0], u[1], 0}, (double[3]){0, 0, 10});
    }
    gltf_camera(w, (double[3]){foot[0] - 10 * cos(into), foot[1] - 10 * sin(into), 0}, (double[3]){foot[0], foot[1], 0}, 1e-5);
    ec_scene *scene = case_load(gltf_write(w, "prism"), "0,0,0");
    free(w);
    ec_render_options o = case_quick(case_options(16, 16, 512));
    o.max_depth = 3;
    case_image image = case_render(scene, &o);
    for (int k = 0; k < 3; k++) {
        printf("index %.3g, dispersion %.3g, channel %d: %.5f +- %.5f of %.5f\n", n, dispersion, k, image.mean[k], image.mean_se[k], expected[k]);
        CHECK(fabs(image.mean[k] - expected[k]) < 4 * image.mean_se[k] + 1e-5 && image.mean_se[k] < 0.01);
    }
    case_free(&image);
    ec_scene_free(scene);
}

/* Balls of glass on tiles under a lamp and a sky. */
static ec_scene *balls(double ior, double dispersion)
{
    gltf_writer *w = gltf_new();
    for (int i = 0; i < 2; i++) {
        double x = i * 1.1 - 1.05;
        gltf_box(w, add_glass(w, ior, dispersion, i ? 0.4 : 0), (double[3]){x, 0.1, -0.5}, (double[3]){x + 1, 1, 0.5});
    }
    for (int i = 0; i < 4; i++) gltf_quad(w, gltf_lambert(w, i % 2 ? 0.8 : 0.2, 0), (double[3]){i - 2, 0, 2}, (double[3]){1, 0, 0}, (double[3]){0, 0, -4});
    gltf_quad(w, gltf_lambert(w, 0, 4), (double[3]){-1, 3, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
    gltf_camera(w, (double[3]){1, 2, 4}, (double[3]){0, 0.4, 0}, 0.7);
    char name[32];
    snprintf(name, sizeof name, "balls-%.4f-%.2f", ior, dispersion);
    ec_scene *scene = case_load(gltf_write(w, name), "0.5,0.6,0.7");
    free(w);
    return scene;
}

static case_image picture(const ec_scene *scene, uint32_t spp, uint64_t seed, ec_sample sample, uint32_t lanes)
{
    ec_render_options o = case_quick(case_random(16, spp, sample, seed));
    o.max_depth = 6;
    o.lanes = lanes;
    return case_render(scene, &o);
}

static void channels_are_their_own(void)
{
    ec_scene *scene = balls(1.5, 2);
    case_image parted = picture(scene, 1024, 1, EC_SAMPLE_MIS, 8), by_bsdf = picture(scene, 2048, 2, EC_SAMPLE_BSDF, 8);
    case_image few = picture(scene, 32, 3, EC_SAMPLE_MIS, 8), few_wide = picture(scene, 32, 3, EC_SAMPLE_MIS, 16);
    CHECK_MSG(case_same_bits(&few.film, &few_wide.film), "lanes 8 and 16 give other bits");
    ec_scene_free(scene);
    for (int k = 0; k < 3; k++) {
        scene = balls(index_of(k, 1.5, 2), 0);
        case_image plain = picture(scene, 1024, 10 + (uint64_t)k, EC_SAMPLE_MIS, 8);
        for (size_t i = 0; i < 3 * 256; i++) /* the other channels stay as they are */
            if (i % 3 != (size_t)k) plain.rgb[i] = parted.rgb[i], plain.se[i] = parted.se[i];
        char name[48];
        snprintf(name, sizeof name, "channel %d and index %.4f", k, index_of(k, 1.5, 2));
        case_check_same(&parted, &plain, 4, name);
        case_free(&plain);
        ec_scene_free(scene);
    }
    case_check_same(&by_bsdf, &parted, 4, "bsdf and mis");
    case_free(&parted);
    case_free(&by_bsdf);
    case_free(&few);
    case_free(&few_wide);
}

/* A block that reflects all of its middle colour, in white light: with the index of blue it must not return more light than arrives. */
static void reflects_no_more(void)
{
    gltf_writer *w = gltf_new();
    int glass = gltf_add(&w->materials,
                         "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0},\"extensions\":{\"KHR_materials_transmission\":"
                         "{\"transmissionFactor\":1},\"KHR_materials_volume\":{\"thicknessFactor\":1},\"KHR_materials_dispersion\":"
                         "{\"dispersion\":2},\"KHR_materials_specular\":{\"specularColorFactor\":[25,25,25]}}}");
    gltf_box(w, glass, (double[3]){-1, -1, -1}, (double[3]){1, 1, 1});
    gltf_camera(w, (double[3]){0, 0, 5}, (double[3]){0.2, 0.3, 0}, 1e-5);
    ec_render_options o = case_quick(case_options(8, 8, 4096));
    case_image image = case_render_file(gltf_write(w, "reflects-all"), "1,1,1", &o);
    for (int k = 0; k < 3; k++) printf("reflecting glass, channel %d: %.5f +- %.5f\n", k, image.mean[k], image.mean_se[k]);
    CASE_NEAR(&image, 1.0, 4, 0.01);
    case_free(&image);
    free(w);
}

int main(void)
{
    reflects_no_more();
    prism(1.5, 1);
    prism(1.7, 0.2);
    channels_are_their_own();
    TEST_END();
}
