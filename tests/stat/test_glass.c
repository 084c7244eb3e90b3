/* tiers: quick, full */
/* Glass whose picture is known without rendering it: plates and slabs of clear and coloured glass, with objects inside, and boxes in a
 * white environment. For every --sample, which must not matter for light that only one direction finds. */
#include "report/names.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

enum { SAMPLE_COUNT = EC_SAMPLE_HEMISPHERE + 1 };

/* Ways to sample, as bits. Where scenes differ in several respects, each value meets every way, but not every scene does. */
enum { EVERY = (1 << SAMPLE_COUNT) - 1, EVERY_OTHER = 1 << EC_SAMPLE_MIS | 1 << EC_SAMPLE_BSDF };

static bool is_quick; /* one way to sample; renders take less time than compiling fast kernels */

/* All scenes share one program. */
static ec_render_options shared(ec_render_options options)
{
    options.more_effects = EC_FEATURE_EMISSION | EC_FEATURE_AREA_LIGHTS | EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_ENVIRONMENT | EC_FEATURE_SPECULAR |
                           EC_FEATURE_SMOOTH | EC_FEATURE_CULLING | EC_FEATURE_TRANSMISSION | EC_FEATURE_ABSORPTION | EC_FEATURE_PANES |
                           EC_FEATURE_NESTED;
    return is_quick ? case_quick(options) : options;
}

static const double colour[3] = {0.9, 0.5, 0.2};

/* Transmittance after x metres of a medium that leaves `colour` after 0.5 (KHR_materials_volume: Beer-Lambert). */
static double left_after(int channel, double x)
{
    return pow(colour[channel], x / 0.5);
}
static gltf_glass body(double ior, int coloured)
{
    return (gltf_glass){1, 0, 1, ior, {colour[0], colour[1], colour[2]}, coloured ? 0.5 : 0};
}

/* Unpolarised reflectance between air and glass (Fresnel). */
static double fresnel(double cosine, double ior)
{
    double cos_t = sqrt(1 - (1 - cosine * cosine) / (ior * ior));
    double s = (cosine - ior * cos_t) / (cosine + ior * cos_t), p = (ior * cosine - cos_t) / (ior * cosine + cos_t);
    return (s * s + p * p) / 2;
}

/* A camera at this distance looks at the origin from `angle` off the z axis: the whole picture is one direction. */
static void add_camera(gltf_writer *w, double angle)
{
    gltf_camera(w, (double[3]){20 * sin(angle), 0, 20 * cos(angle)}, (double[3]){0, 0, 0}, 1e-5);
}
static void add_sheet(gltf_writer *w, int material, double z)
{
    gltf_quad(w, material, (double[3]){-90, -90, z}, (double[3]){180, 0, 0}, (double[3]){0, 180, 0});
}
/* A slab with its front at z = 0. */
static void add_slab(gltf_writer *w, const gltf_glass *g, double thickness)
{
    gltf_box(w, gltf_add_glass(w, g), (double[3]){-90, -90, -thickness}, (double[3]){90, 90, 0});
}
static int mirror(gltf_writer *w)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0}}");
}

/* The picture's mean with some strategies: within 4 standard errors, which must be small; larger where rough lobes are sampled by
 * directions that do not follow them. */
static void expect(gltf_writer *w, const char *name, const char *environment, int ways, const double *expected, double most_se, double most_blind_se)
{
    char file[96];
    snprintf(file, sizeof file, "glass-%s", name);
    ec_scene *scene = case_load(gltf_write(w, file), environment);
    free(w);
    if (is_quick) ways = 1 << EC_SAMPLE_MIS;
    for (int s = 0; s < SAMPLE_COUNT; s++) {
        if (!(ways >> s & 1)) continue;
        ec_render_options o = shared(case_options(16, 16, 1024));
        o.sample = (ec_sample)s;
        o.seed = 30 + (uint64_t)s;
        case_image image = case_render(scene, &o);
        double most = s == EC_SAMPLE_LIGHT || s == EC_SAMPLE_HEMISPHERE ? most_blind_se : most_se;
        for (int c = 0; c < 3; c++)
            CHECK_MSG(fabs(image.mean[c] - expected[c]) <= 4 * image.mean_se[c] + 3e-6 * expected[c] + 1e-9 && image.mean_se[c] <= most,
                      "%s, %s, channel %d: %.7f +- %.7f, expected %.7f", name, ec_sample_names[s], c, image.mean[c], image.mean_se[c], expected[c]);
        printf("%-28s %-10s %.6f %.6f %.6f, expected %.6f %.6f %.6f, +- %.1e\n", name, ec_sample_names[s], image.mean[0], image.mean[1], image.mean[2],
               expected[0], expected[1], expected[2], image.mean_se[1]);
        case_free(&image);
    }
    ec_scene_free(scene);
}

/* A thin wall reflects Schlick's F with F0 = 0.04 and transmits base (1 - F) straight on. Behind it is black, then a lamp of 1. */
static void thin_plates(int count)
{
    static const double cosines[3] = {0.5, 1, 0.1};
    for (int i = 0; i < count; i++)
        for (int lit = 0; lit < 2; lit++) {
            double F = 0.04 + 0.96 * pow(1 - cosines[i], 5), want = lit ? 0.7 * (1 - F) : F;
            char name[64];
            snprintf(name, sizeof name, "thin-%s-%g", lit ? "passes" : "reflects", cosines[i]);
            gltf_writer *w = gltf_new();
            add_sheet(w, gltf_add_glass(w, &(gltf_glass){0.7, 0, 1, 0, {0}, 0}), 0);
            add_sheet(w, gltf_lambert(w, 0, lit), -1);
            add_camera(w, acos(cosines[i]));
            expect(w, name, lit ? NULL : "1,1,1", EVERY_OTHER << (i + lit) % 2, (double[3]){want, want, want}, 1e-3, 1e-3);
        }
}

/* Rough white thin walls: reflection and transmission add up to the albedo of a rough white metal (scenes/furnace/README.md, by
 * quadrature), F and 1 - F of the lobe and its mirror image. */
static void rough_plates(void)
{
    static const double alphas[3] = {0.1, 0.5, 1}, cosines[3] = {1, 0.5, 0.1};
    static const double albedo[3][3] = {{0.98830, 0.96921, 0.88346}, {0.68785, 0.69825, 0.86010}, {0.30685, 0.45069, 0.76021}};
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 3; i++) {
            char name[64];
            snprintf(name, sizeof name, "rough-%g-%g", alphas[a], cosines[i]);
            gltf_writer *w = gltf_new();
            add_sheet(w, gltf_add_glass(w, &(gltf_glass){1, sqrt(alphas[a]), 1, 0, {0}, 0}), 0);
            add_camera(w, acos(cosines[i]));
            expect(w, name, "1,1,1", EVERY_OTHER << (a + i) % 2, (double[3]){albedo[a][i], albedo[a][i], albedo[a][i]}, 1e-3, 2e-2);
        }
}

/* A slab reflects light between its two faces: with A left after one passage,
 *   T = (1 - F)^2 A / (1 - F^2 A^2), R = F + (1 - F)^2 F A^2 / (1 - F^2 A^2)
 * Nothing else is in the way; the slab is so wide that no light comes from its rim. */
static void slabs(void)
{
    static const double cosines[2] = {1, 0.5}, iors[3] = {1.5, 2.4, 1};
    for (int n = 0; n < 3; n++)
        for (int i = 0; i < 2; i++)
            for (int coloured = 0; coloured < 2; coloured++)
                for (int lit = 0; lit < 2; lit++) {
                    double F = fresnel(cosines[i], iors[n]), cos_t = sqrt(1 - (1 - cosines[i] * cosines[i]) / (iors[n] * iors[n])), want[3];
                    for (int c = 0; c < 3; c++) {
                        double A = coloured ? left_after(c, 0.4 / cos_t) : 1, through = (1 - F) * (1 - F) / (1 - F * F * A * A);
                        want[c] = lit ? through * A : F + through * F * A * A;
                    }
                    char name[64];
                    snprintf(name, sizeof name, "slab-%g%s-%s-%g", iors[n], coloured ? "-coloured" : "", lit ? "passes" : "reflects", cosines[i]);
                    gltf_writer *w = gltf_new();
                    gltf_glass g = body(iors[n], coloured);
                    add_slab(w, &g, 0.4);
                    add_sheet(w, gltf_lambert(w, 0, lit), -1);
                    add_camera(w, acos(cosines[i]));
                    expect(w, name, lit ? NULL : "1,1,1", 1 << (n + i + 2 * coloured + 2 * lit) % 4, want, 1e-3, 1e-3);
                }
}

/* Absorption inside a body. A black lamp 0.3 deep: (1 - F) A of its light gets out, and reflected light is lost. A mirror there: F + (1 -
 * F)^2 A^2 / (1 - F A^2). A camera 0.3 deep that looks out: (1 - F) A / (1 - F A'), with A' for the way across. */
static void within(void)
{
    double F = 0.04, lamp[3], reflected[3], seen[3], point[3];
    for (int c = 0; c < 3; c++) {
        double A = left_after(c, 0.3);
        lamp[c] = (1 - F) * A;
        reflected[c] = F + (1 - F) * (1 - F) * A * A / (1 - F * A * A);
        seen[c] = (1 - F) * A / (1 - F * left_after(c, 0.4));
        /* Index 1: a point light of I = 2 pi straight above a floor of albedo 0.6, both inside the body: I / r^2 x albedo / pi, r = 0.2. */
        point[c] = 2 * 0.6 / 0.04 * left_after(c, 0.2) * left_after(c, 0.3);
    }
    gltf_glass g = body(1.5, 1), air = body(1, 1);
    gltf_writer *w = gltf_new();
    add_slab(w, &g, 0.4);
    add_sheet(w, gltf_lambert(w, 0, 1), -0.3);
    add_camera(w, 0);
    expect(w, "lamp-in-slab", NULL, EVERY, lamp, 1e-3, 1e-3);

    w = gltf_new();
    add_slab(w, &g, 0.4);
    add_sheet(w, mirror(w), -0.3);
    add_camera(w, 0);
    expect(w, "mirror-in-slab", "1,1,1", EVERY, reflected, 1e-3, 1e-3);

    w = gltf_new();
    add_slab(w, &g, 0.4);
    gltf_camera(w, (double[3]){0, 0, -0.3}, (double[3]){0, 0, 1}, 1e-5);
    expect(w, "camera-in-slab", "1,1,1", EVERY, seen, 1e-3, 1e-3);

    w = gltf_new();
    add_slab(w, &air, 0.4);
    add_sheet(w, gltf_lambert(w, 0.6, 0), -0.3);
    gltf_light(w, (double[3]){0, 0, -0.1}, (double[3]){0, 0, -1}, "{\"type\":\"point\",\"intensity\":6.28318530717958648}");
    add_camera(w, 0);
    ec_scene *scene = case_load(gltf_write(w, "glass-point-in-slab"), NULL);
    ec_render_options o = shared(case_options(8, 8, 256));
    o.max_depth = 3; /* in through the face and to the light: nothing from the other faces */
    case_image image = case_render(scene, &o);
    for (int c = 0; c < 3; c++) CHECK_NEAR(image.mean[c], point[c], 1e-5 * point[c]);
    case_free(&image);
    ec_scene_free(scene);
    free(w);
}

/* White glass in a white environment is invisible: flat faces lose no light, and each path brings 1. Only roulette makes noise. */
static void boxes_in_white(void)
{
    static const double iors[3] = {1, 1.5, 2.4};
    for (int n = 0; n < 3; n++) {
        char name[64];
        snprintf(name, sizeof name, "box-in-white-%g", iors[n]);
        gltf_writer *w = gltf_new();
        gltf_glass g = body(iors[n], 0);
        gltf_box(w, gltf_add_glass(w, &g), (double[3]){-1, -1, -1}, (double[3]){1, 1, 1});
        gltf_camera(w, (double[3]){2, 3, 4}, (double[3]){0, 0, 0}, 0.5);
        expect(w, name, "1,1,1", EVERY, (double[3]){1, 1, 1}, 1e-3, 1e-3);
    }
}

/* Half clear, half scattering glass that reflects nothing (KHR_materials_specular), except inside beyond the critical angle: it is white
 * too, however long light stays inside. */
static void half_clear_box_in_white(void)
{
    gltf_writer *w = gltf_new();
    int half = gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0},\"extensions\":{"
                                       "\"KHR_materials_transmission\":{\"transmissionFactor\":0.5},\"KHR_materials_volume\":{\"thicknessFactor\":1},"
                                       "\"KHR_materials_specular\":{\"specularFactor\":0}}}");
    gltf_box(w, half, (double[3]){-1, -1, -1}, (double[3]){1, 1, 1});
    gltf_camera(w, (double[3]){2, 3, 4}, (double[3]){0, 0, 0}, 0.5);
    expect(w, "half-clear-box-in-white", "1,1,1", EVERY, (double[3]){1, 1, 1}, 5e-3, 2e-2);
}

/* A rough white body loses light only between microfacets, and never returns more than arrives. (Uniform directions hardly find any of the
 * light where it is smoothest.) */
static void rough_boxes_in_white(void)
{
    static const double roughnesses[3] = {0.2, 0.5, 1};
    for (int r = 0; r < 3; r++)
        for (int s = 0; s < SAMPLE_COUNT; s++) {
            gltf_writer *w = gltf_new();
            gltf_box(w, gltf_add_glass(w, &(gltf_glass){1, roughnesses[r], 1, 1.5, {0}, 0}), (double[3]){-1, -1, -1}, (double[3]){1, 1, 1});
            gltf_camera(w, (double[3]){2, 3, 4}, (double[3]){0, 0, 0}, 0.3);
            ec_render_options o = shared(case_options(16, 16, 256));
            o.sample = (ec_sample)s;
            case_image image = case_render_file(gltf_write(w, "glass-rough-box"), "1,1,1", &o);
            free(w);
            if (s == 0) printf("rough box, roughness %g: %.4f +- %.4f\n", roughnesses[r], image.mean[1], image.mean_se[1]);
            CHECK_MSG(image.mean[1] <= 1 + 4 * image.mean_se[1] && (image.mean[1] > 0.2 || s == EC_SAMPLE_HEMISPHERE), "rough box, roughness %g, %s: %.4f +- %.4f", roughnesses[r],
                      ec_sample_names[s], image.mean[1], image.mean_se[1]);
            case_free(&image);
        }
}

/* A body of index 1 is invisible: between a lamp and the floor, it does not change the picture. Shadow rays end at it. So light behind it
 * is found only by paths that pass straight through, and never twice. */
static void nothing_of_index_1(void)
{
    case_image image[1 + SAMPLE_COUNT];
    for (int i = 0; i < 1 + SAMPLE_COUNT; i++) {
        gltf_writer *w = gltf_new();
        gltf_quad(w, gltf_lambert(w, 0.6, 0), (double[3]){-2, 0, 2}, (double[3]){4, 0, 0}, (double[3]){0, 0, -4});
        gltf_quad(w, gltf_lambert(w, 0.3, 3), (double[3]){-1, 2, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
        gltf_glass air = body(1, 0);
        if (i) gltf_box(w, gltf_add_glass(w, &air), (double[3]){-1, 0.5, -0.8}, (double[3]){0.3, 1.3, 0.9});
        gltf_camera(w, (double[3]){0, 1.2, 4}, (double[3]){0, 0.8, 0}, 0.8);
        ec_render_options o = shared(case_random(16, i ? 4096 : 2048, i ? (ec_sample)(i - 1) : EC_SAMPLE_MIS, (uint64_t)i));
        image[i] = case_render_file(gltf_write(w, "glass-nothing"), NULL, &o);
        free(w);
        char what[96];
        snprintf(what, sizeof what, "a body of index 1, %s", i ? ec_sample_names[i - 1] : "");
        if (i) case_check_same(&image[i], &image[0], 4, what);
    }
    for (int i = 0; i < 1 + SAMPLE_COUNT; i++) case_free(&image[i]);
}

int main(void)
{
    if (test_tier("quick")) {
        is_quick = true;
        thin_plates(1);
        within();
    }
    if (test_tier("full")) {
        is_quick = false;
        thin_plates(3);
        within();
        boxes_in_white();
        rough_plates();
        slabs();
        half_clear_box_in_white();
        rough_boxes_in_white();
        nothing_of_index_1();
    }
    TEST_END();
}
