/* tiers: full, long */
/* Light sampling, BSDF sampling, both together and uniform directions must converge to one picture, for all emitters and occluders: they
 * share no code for finding light. Small pictures with many samples; ztest.h compares every pair without allowance for a common bias.
 *
 * BSDF sampling and uniform directions seldom meet a lamp, so that 32 batches of a single dark pixel say little about its variance: these
 * are compared in squares of 4 x 4 pixels. (The full tier has a quarter of the samples and squares of twice the side, so as many samples in
 * each.) Roulette must not matter either. Each comparison fails by chance with at most one of a hundred seeds; the seeds are fixed. */
#include "report/names.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

/* Effects built in for scenes that do not need them all: a program takes longer to compile than a scene to render. */
#define LIT (EC_FEATURE_EMISSION | EC_FEATURE_AREA_LIGHTS | EC_FEATURE_ENVIRONMENT | EC_FEATURE_ENVIRONMENT_MAP | EC_FEATURE_CULLING | EC_FEATURE_SPECULAR | EC_FEATURE_SMOOTH)
#define OPAQUE (LIT | EC_FEATURE_EMISSION_TEXTURE | EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_SMOOTH_NORMALS | EC_FEATURE_VERTEX_COLORS | EC_FEATURE_NORMAL_TEXTURE | EC_FEATURE_ALPHA)
#define GLASS (LIT | EC_FEATURE_TRANSMISSION | EC_FEATURE_ABSORPTION | EC_FEATURE_PANES | EC_FEATURE_NESTED)

static void agree(const char *name, const char *path, const char *environment, uint64_t effects)
{
    enum { COUNT = EC_SAMPLE_HEMISPHERE + 1 };
    static const uint32_t more[COUNT] = {[EC_SAMPLE_MIS] = 1, [EC_SAMPLE_LIGHT] = 1, [EC_SAMPLE_BSDF] = 4, [EC_SAMPLE_HEMISPHERE] = 4};
    const uint32_t samples = test_tier("long") ? 4096 : 1024, side = test_tier("long") ? 1 : 2;
    ec_scene *scene = case_load(path, environment);
    case_image image[COUNT];
    for (int s = 0; s < COUNT; s++) {
        ec_render_options o = case_random(16, more[s] * samples, (ec_sample)s, (uint64_t)s + 11);
        o.lanes = 8; /* for these settings, too */
        o.more_effects = effects;
        o.max_depth = 5;
        image[s] = case_render(scene, &o);
        CHECK_MSG(image[s].mean[1] > 0, "%s, %s: black", name, ec_sample_names[s]);
    }
    char what[128];
    for (int s = 1; s < COUNT; s++)
        for (int t = 0; t < s; t++) {
            snprintf(what, sizeof what, "%s, %s and %s", name, ec_sample_names[s], ec_sample_names[t]);
            case_check_same(&image[s], &image[t], side * (more[s] > more[t] ? more[s] : more[t]), what);
        }
    for (int s = 0; s < COUNT; s++) case_free(&image[s]);
    ec_scene_free(scene);
}

/* Most of the light in a white box has passed from wall to wall, so that light lost by roulette shows here. With walls of 0.73 and P = 0.5
 * endless paths would have infinite variance (0.73^2 > 0.5), so paths have ten segments. */
static void roulette_agrees(void)
{
    static const double survival[3] = {0, 0.8, 0.5};
    ec_scene *scene = case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL);
    case_image image[3];
    for (int i = 0; i < 3; i++) {
        ec_render_options o = case_random(16, 2048, EC_SAMPLE_MIS, (uint64_t)i + 31);
        o.max_depth = 10;
        o.survival = survival[i];
        image[i] = case_render(scene, &o);
    }
    case_check_same(&image[1], &image[0], 1, "roulette, 0.8 and auto");
    case_check_same(&image[2], &image[0], 1, "roulette, 0.5 and auto");
    case_check_same(&image[2], &image[1], 1, "roulette, 0.5 and 0.8");
    for (int i = 0; i < 3; i++) case_free(&image[i]);
    ec_scene_free(scene);
}

/* Reflected three times by dark mirrors (floor, ceiling, floor) to a white sky: each sample is F(45 deg)^3, unless roulette ends it. */
static void mirrors_are_spared(void)
{
    gltf_writer *w = gltf_new();
    const int dark = gltf_add(&w->materials, "{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.1,0.1,1],\"metallicFactor\":1,\"roughnessFactor\":0}}");
    gltf_quad(w, dark, (double[3]){-1, 0, 1}, (double[3]){3.5, 0, 0}, (double[3]){0, 0, -2});
    gltf_quad(w, dark, (double[3]){0.5, 1, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
    gltf_camera(w, (double[3]){-0.5, 0.5, 0}, (double[3]){0, 0, 0}, 0.002);
    ec_scene *scene = case_load(gltf_write(w, "strategies-mirrors"), "1,1,1");
    ec_render_options o = case_random(8, 64, EC_SAMPLE_MIS, 5);
    case_image image = case_render(scene, &o);
    const double f = 0.1 + 0.9 * pow(1 - sqrt(0.5), 5);
    CHECK_MSG(fabs(image.mean[1] / (f * f * f) - 1) < 2e-3 && image.mean_se[1] < 1e-4 * image.mean[1], "%g +- %g of light by way of mirrors, not %g",
              image.mean[1], image.mean_se[1], f * f * f);
    case_free(&image);
    ec_scene_free(scene);
    free(w);
}

/* A floor of the given material that fills the picture, with a white block on it; a light must be added. */
static gltf_writer *stage(int (*floor_material)(gltf_writer *))
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, floor_material(w), (double[3]){-12, 0, 2}, (double[3]){24, 0, 0}, (double[3]){0, 0, -20});
    int white = gltf_lambert(w, 0.7, 0);
    gltf_quad(w, white, (double[3]){0.2, 0.4, 0.6}, (double[3]){0.5, 0, 0}, (double[3]){0, 0, -0.5});
    gltf_quad(w, white, (double[3]){0.2, 0, 0.6}, (double[3]){0.5, 0, 0}, (double[3]){0, 0.4, 0});
    gltf_camera(w, (double[3]){0, 2, 3}, (double[3]){0, 0.2, 0}, 0.8);
    return w;
}
static int matt(gltf_writer *w) { return gltf_lambert(w, 0.6, 0); }
static int glossy_metal(gltf_writer *w)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.7,0.4,1],\"metallicFactor\":1,"
                                   "\"roughnessFactor\":0.35}}");
}
static int mirror(gltf_writer *w)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.8,0.7,1],\"metallicFactor\":1,"
                                   "\"roughnessFactor\":0}}");
}
static int varnish(gltf_writer *w)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.2,0.5,0.7,1],\"metallicFactor\":0.2,"
                                   "\"roughnessFactor\":0}}");
}
static int plastic(gltf_writer *w)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.2,0.5,0.7,1],\"metallicFactor\":0.2,"
                                   "\"roughnessFactor\":0.45}}");
}
static int shining(gltf_writer *w) { return gltf_lambert(w, 0.6, 0.2); }

/* Facing down at height 1. */
static void add_lamp(gltf_writer *w, int material, double side)
{
    gltf_quad(w, material, (double[3]){-0.5 - side / 2, 1, -side / 2}, (double[3]){side, 0, 0}, (double[3]){0, 0, side});
}

static void run(gltf_writer *w, const char *name, const char *environment, uint64_t effects)
{
    char file[96];
    snprintf(file, sizeof file, "strategies-%s", name);
    agree(name, gltf_write(w, file), environment, effects);
    free(w);
}

static const char *write_environment(void)
{
    enum { WIDTH = 32, HEIGHT = 16 };
    static float rgb[3 * WIDTH * HEIGHT];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            int is_sun = (x == 9 || x == 10) && (y == 4 || y == 5), is_sky = y < HEIGHT / 2;
            for (int k = 0; k < 3; k++) rgb[3 * (y * WIDTH + x) + k] = is_sun ? 40 : is_sky ? 0.3f + 0.1f * (float)k : 0.1f;
        }
    ec_channel channels[3] = {{.name = "R", .data = rgb, .stride = 3}, {.name = "G", .data = rgb + 1, .stride = 3}, {.name = "B", .data = rgb + 2, .stride = 3}};
    ec_error err = {0};
    CHECK_OK(ec_exr_write(ECLAT_TEST_OUT "/strategies-sky.exr", WIDTH, HEIGHT, channels, 3, NULL, 0, &err), err);
    return ECLAT_TEST_OUT "/strategies-sky.exr";
}

/* Gives texture `index` of the scene NAME a picture of `size` squared. */
static int add_texture(gltf_writer *w, const char *name, uint32_t size, const uint8_t *rgb)
{
    char path[512];
    snprintf(path, sizeof path, "%s/strategies-%s-%d.png", ECLAT_TEST_OUT, name, w->textures.count);
    ec_error err = {0};
    CHECK_OK(ec_png_write(path, size, size, rgb, &err), err);
    return gltf_add(&w->textures, "{\"source\":%d}", w->textures.count);
}

/* Most of the lamp is dark; two bright, coloured texels. */
static void textured_emission(void)
{
    uint8_t rgb[3 * 8 * 8] = {0};
    static const uint8_t bright[2][3] = {{255, 200, 60}, {40, 90, 255}};
    memcpy(rgb + 3 * 10, bright[0], 3);
    memcpy(rgb + 3 * 45, bright[1], 3);
    memcpy(rgb + 3 * 46, bright[1], 3);
    gltf_writer *w = stage(matt);
    int texture = add_texture(w, "textured-emission", 8, rgb);
    int lamp = gltf_add(&w->materials, "{\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":%d},\"extensions\":{"
                        "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":20}}}", texture);
    add_lamp(w, lamp, 1);
    run(w, "textured-emission", NULL, OPAQUE);
}

/* The light of a lamp under a clear coat depends on the angle, on a bent normal, and on a texture of the coat. */
static void coated_lamp(void)
{
    static const float normals[12] = {-0.6f, -0.8f, 0, 0.6f, -0.8f, 0, 0, -0.8f, -0.6f, 0, -0.8f, 0.6f};
    uint8_t rgb[3 * 4 * 4] = {0};
    for (int i = 0; i < 16; i++) rgb[3 * i] = (uint8_t)(i % 3 ? 255 : 40);
    gltf_writer *w = stage(matt);
    int texture = add_texture(w, "coated-lamp", 4, rgb);
    int lamp = gltf_add(&w->materials, "{\"doubleSided\":true,\"emissiveFactor\":[1,1,1],\"extensions\":{\"KHR_materials_clearcoat\":{"
                        "\"clearcoatFactor\":1,\"clearcoatRoughnessFactor\":0.5,\"clearcoatTexture\":{\"index\":%d}},"
                        "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4}}}", texture);
    gltf_quad_with(w, lamp, (double[3]){-1, 0.5, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1}, NULL, normals);
    run(w, "coated-lamp", NULL, 0);
}

static int see_through(gltf_writer *w, const char *mode, double alpha)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.3,0.8,0.5,%g],\"metallicFactor\":0},"
                    "\"alphaMode\":\"%s\",\"doubleSided\":true,\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}}",
                    alpha, mode);
}

/* Coverage between lamp and floor: from 0 to 1 across the panel, by vertex colour. BLEND lets a share through, MASK half. */
static void panels(const char *mode)
{
    static const float colors[16] = {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
    gltf_writer *w = stage(matt);
    add_lamp(w, gltf_lambert(w, 0.3, 10), 0.5);
    gltf_quad_with(w, see_through(w, mode, 1), (double[3]){-1.2, 0.6, 0.6}, (double[3]){1.4, 0, 0}, (double[3]){0, 0, -1.2}, colors,
                   NULL);
    run(w, !strcmp(mode, "MASK") ? "mask-panel" : "blend-panel", NULL, OPAQUE);
}

/* Glass between lamp and floor. Only paths find light through glass, as if light sampling did not exist: the lamp is wide. */
static void glass_before_a_lamp(const char *name, const gltf_glass *glass)
{
    gltf_writer *w = stage(matt);
    add_lamp(w, gltf_lambert(w, 0.3, 3), 1.6);
    int material = gltf_add_glass(w, glass);
    if (glass->ior > 0) gltf_box(w, material, (double[3]){-1.2, 0.45, -0.7}, (double[3]){0.15, 0.7, 0.7});
    else gltf_quad(w, material, (double[3]){-1.2, 0.6, 0.7}, (double[3]){1.4, 0, 0}, (double[3]){0, 0, -1.4});
    run(w, name, NULL, GLASS);
}

/* A lamp in a body of coloured glass: light samples reach it from within, paths through the body's faces from outside. The block is beside
 * it. */
static void lamp_in_glass(void)
{
    gltf_writer *w = stage(matt);
    gltf_quad(w, gltf_lambert(w, 0.5, 5), (double[3]){-1.2, 0.7, -0.7}, (double[3]){1.4, 0, 0}, (double[3]){0, 0, 1.4});
    gltf_quad(w, gltf_lambert(w, 0.5, 0), (double[3]){-0.9, 0.3, 0.4}, (double[3]){0.6, 0, 0}, (double[3]){0, 0.1, -0.8});
    gltf_glass amber = {1, 0, 1, 1.2, {0.9, 0.5, 0.2}, 0.4};
    gltf_box(w, gltf_add_glass(w, &amber), (double[3]){-1.3, 0.2, -0.8}, (double[3]){0.3, 0.8, 0.8});
    run(w, "lamp-in-glass", NULL, GLASS);
}

/* Water without a glass: a single face with a volume below it, which rays leave sideways. */
static void water_without_sides(const char *sky)
{
    gltf_writer *w = stage(matt);
    gltf_glass water = {1, 0, 1, 1.33, {0.5, 0.8, 0.9}, 0.5};
    gltf_quad(w, gltf_add_glass(w, &water), (double[3]){-0.8, 0.3, 0.8}, (double[3]){1.6, 0, 0}, (double[3]){0, 0, -1.6});
    run(w, "water-without-sides", sky, GLASS);
}

/* Closed form: a black BLEND sheet of coverage 0.4 (and behind it one of 0.5) before all light leaves 0.6 x 0.5 of it, for every way to
 * find it. The sheets are far wider than the lamp. */
static void blend_in_closed_form(void)
{
    double bare[3] = {0}, se[3] = {0};
    for (int sheets = 0; sheets < 2; sheets++)
        for (int s = 0; s < 3; s++) {
            gltf_writer *w = gltf_new();
            gltf_quad(w, gltf_lambert(w, 0.6, 0), (double[3]){-1, 0, 1}, (double[3]){2, 0, 0}, (double[3]){0, 0, -2});
            gltf_camera(w, (double[3]){0, 0.2, 0}, (double[3]){0, 0, 0}, 1e-5);
            add_lamp(w, gltf_lambert(w, 0, 4), 1);
            for (int i = 0; sheets && i < 2; i++) {
                int black = gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,%g],\"metallicFactor\":0},"
                                     "\"alphaMode\":\"BLEND\",\"doubleSided\":true,\"extensions\":{\"KHR_materials_specular\":"
                                     "{\"specularFactor\":0}}}", i ? 0.5 : 0.4);
                gltf_quad(w, black, (double[3]){-50, 0.4 + 0.1 * i, 50}, (double[3]){100, 0, 0}, (double[3]){0, 0, -100});
            }
            ec_render_options o = case_options(8, 8, 8192);
            o.lanes = 8;
            o.more_effects = OPAQUE;
            o.max_depth = 2;
            o.sample = (ec_sample)s;
            case_image image = case_render_file(gltf_write(w, "strategies-sheets"), NULL, &o);
            if (!sheets) {
                bare[s] = image.mean[1];
                se[s] = image.mean_se[1];
            } else {
                double sigma = hypot(image.mean_se[1], 0.3 * se[s]);
                printf("two sheets, strategy %d: %.5f +- %.5f of the light\n", s, image.mean[1] / bare[s], sigma / bare[s]);
                CHECK_MSG(fabs(image.mean[1] - 0.3 * bare[s]) <= 4 * sigma && sigma < 5e-3 * bare[s],
                          "strategy %d: %.5f of the light, expected 0.3", s, image.mean[1] / bare[s]);
            }
            case_free(&image);
            free(w);
        }
}

/* Shading normals far from the geometric ones, from vertex normals and a normal map, with vertex colours. */
static void bent_normals(void)
{
    static const float normals[12] = {-0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0, 0.8f, -0.6f, 0, 0.8f, 0.6f};
    static const float colors[16] = {1, 0.2f, 0.2f, 1, 0.2f, 1, 0.2f, 1, 0.2f, 0.2f, 1, 1, 1, 1, 1, 1};
    uint8_t rgb[3 * 4 * 4];
    for (int i = 0; i < 16; i++) {
        rgb[3 * i] = (uint8_t)(60 + 130 * (i % 2));
        rgb[3 * i + 1] = (uint8_t)(80 + 100 * (i / 4 % 2));
        rgb[3 * i + 2] = 220;
    }
    gltf_writer *w = gltf_new();
    int texture = add_texture(w, "bent-normals", 4, rgb);
    int bent = gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"metallicFactor\":0.3,\"roughnessFactor\":0.5},"
                        "\"normalTexture\":{\"index\":%d,\"scale\":1.2}}", texture);
    gltf_quad_with(w, bent, (double[3]){-1.5, 0, 1.5}, (double[3]){3, 0, 0}, (double[3]){0, 0, -3}, colors, normals);
    gltf_camera(w, (double[3]){0, 2, 3}, (double[3]){0, 0, 0}, 0.8);
    add_lamp(w, gltf_lambert(w, 0.3, 8), 0.6);
    run(w, "bent-normals", "0.2,0.3,0.4", OPAQUE);
}

/* All kinds of light at once; the lamp shines on both sides and is lit itself. */
static void everything(const char *sky)
{
    gltf_writer *w = stage(shining);
    int lamp = gltf_add(&w->materials, "{\"doubleSided\":true,\"emissiveFactor\":[1,0.5,0.25],\"extensions\":{"
                        "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":5}}}");
    gltf_quad(w, lamp, (double[3]){-1, 0.3, -0.5}, (double[3]){0.5, 0.2, 0}, (double[3]){0, 0.4, 0.3});
    gltf_light(w, (double[3]){1, 1.5, 1}, (double[3]){0, -1, 0}, "{\"type\":\"point\",\"intensity\":3}");
    gltf_light(w, (double[3]){-1, 1.5, 1}, (double[3]){0.2, -1, 0},
               "{\"type\":\"spot\",\"intensity\":5,\"spot\":{\"outerConeAngle\":0.4}}");
    gltf_light(w, (double[3]){0, 0, 0}, (double[3]){0.3, -1, 0.2}, "{\"type\":\"directional\",\"intensity\":0.5}");
    run(w, "everything", sky, OPAQUE);
}

int main(void)
{
    const char *sky = write_environment();
    gltf_writer *w;
    w = stage(matt);
    add_lamp(w, gltf_lambert(w, 0.3, 30), 0.25);
    run(w, "small-lamp", NULL, OPAQUE);
    blend_in_closed_form();
    w = stage(glossy_metal);
    add_lamp(w, gltf_lambert(w, 0.3, 10), 0.5);
    run(w, "glossy-metal", NULL, OPAQUE);
    w = stage(mirror); /* the lamp's image is in view, and light by the mirror reaches the block's underside */
    add_lamp(w, gltf_lambert(w, 0.3, 10), 0.6);
    run(w, "lamp-in-a-mirror", NULL, OPAQUE);
    w = stage(varnish);
    add_lamp(w, gltf_lambert(w, 0.3, 10), 0.5);
    run(w, "varnish", NULL, OPAQUE);
    w = stage(plastic);
    add_lamp(w, gltf_lambert(w, 0.3, 10), 0.5);
    run(w, "plastic", NULL, OPAQUE);
    run(stage(matt), "environment-map", sky, OPAQUE);
    run(stage(plastic), "environment-map-on-plastic", sky, OPAQUE);
    textured_emission();
    coated_lamp();
    glass_before_a_lamp("glass-before-a-lamp", &(gltf_glass){0.9, 0, 1, 1.5, {0.5, 0.8, 0.9}, 0.3});
    glass_before_a_lamp("rough-glass-before-a-lamp", &(gltf_glass){0.9, 0.9, 1, 1.5, {0.5, 0.8, 0.9}, 0.3});
    glass_before_a_lamp("milky-glass-before-a-lamp", &(gltf_glass){0.9, 0, 0.5, 1.5, {0}, 0});
    glass_before_a_lamp("pane-before-a-lamp", &(gltf_glass){0.8, 0, 0.9, 0, {0}, 0});
    glass_before_a_lamp("rough-pane-before-a-lamp", &(gltf_glass){0.8, 0.5, 0.9, 0, {0}, 0});
    lamp_in_glass();
    water_without_sides(sky);
    panels("BLEND");
    panels("MASK");
    bent_normals();
    everything(sky);
    roulette_agrees();
    mirrors_are_spared();
    TEST_END();
}
