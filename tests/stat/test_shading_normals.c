/* tiers: full, long */
/* A faceted ball with the normals of a round one: no light gets in, none is gained, and with --terminator smooth none is lost. */
#include "report/names.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

enum { PARTS = 3, SAMPLE_COUNT = EC_SAMPLE_HEMISPHERE + 1 };

/* The sides of an octahedron, each with PARTS^2 triangles, on the unit sphere: 72 facets. */
static void add_ball(gltf_writer *w, int material, double x, double y, double z)
{
    static float positions[8 * PARTS * PARTS * 9], normals[8 * PARTS * PARTS * 9];
    int n = 0;
    for (int side = 0; side < 8; side++)
        for (int i = 0; i < PARTS; i++)
            for (int j = 0; j < PARTS - i; j++)
                for (int up = 0; up < (j < PARTS - i - 1 ? 2 : 1); up++) {
                    int corners[3][2] = {{i + up, j + up}, {i + 1, j}, {i, j + 1}};
                    int flip = (side & 1) ^ (side >> 1 & 1) ^ (side >> 2) ^ up; /* fronts face outwards */
                    for (int c = 0; c < 3; c++) {
                        const int *at = corners[c && flip ? 3 - c : c];
                        double p[3] = {at[0], at[1], PARTS - at[0] - at[1]}, length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
                        for (int k = 0; k < 3; k++, n++) {
                            normals[n] = (float)((side >> k & 1 ? -p[k] : p[k]) / length);
                            positions[n] = (float)((double)normals[n] + (k == 0 ? x : k == 1 ? y : z));
                        }
                    }
                }
    gltf_triangles(w, material, &(gltf_mesh){n / 3, positions, normals, NULL, NULL});
}

static int clay(gltf_writer *w)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.8,0.8,1],\"metallicFactor\":0},\"doubleSided\":true,"
                                   "\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}}");
}

/* All scenes share one program. */
static ec_render_options shared(ec_render_options options)
{
    options.more_effects = EC_FEATURE_EMISSION | EC_FEATURE_AREA_LIGHTS | EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_ENVIRONMENT | EC_FEATURE_SPECULAR |
                           EC_FEATURE_SMOOTH_NORMALS | EC_FEATURE_CULLING | EC_FEATURE_TERMINATOR;
    return case_quick(options);
}

static case_image picture(const ec_scene *scene, ec_sample sample, ec_terminator terminator, uint32_t size, uint32_t spp)
{
    ec_render_options o = shared(case_random(size, spp, sample, (uint64_t)sample + 5));
    o.terminator = terminator;
    return case_render(scene, &o);
}

/* Seen from inside, with lamps and a sky outside: exactly no light. */
static void check_inside(uint32_t samples)
{
    gltf_writer *w = gltf_new();
    add_ball(w, clay(w), 0, 0, 0);
    int lamp = gltf_lambert(w, 0, 100);
    gltf_quad(w, lamp, (double[3]){-1, 1.1, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
    gltf_quad(w, lamp, (double[3]){-1.05, -1, -1}, (double[3]){0, 2, 0}, (double[3]){0, 0, 2});
    gltf_light(w, (double[3]){0, -2, 1}, (double[3]){0, 1, 0}, "{\"type\":\"point\",\"intensity\":1000}");
    gltf_camera(w, (double[3]){0.3, 0.1, -0.2}, (double[3]){-1, 0.4, 0.3}, 2.2);
    ec_scene *scene = case_load(gltf_write(w, "normals-inside"), "1,1,1");
    for (int t = 0; t <= EC_TERMINATOR_SMOOTH; t++)
        for (int s = 0; s < SAMPLE_COUNT; s++) {
            case_image image = picture(scene, (ec_sample)s, (ec_terminator)t, 32, samples);
            CHECK_MSG(image.mean[1] == 0, "%s, %s: %g inside of a closed ball", ec_terminator_names[t], ec_sample_names[s], image.mean[1]);
            case_free(&image);
        }
    ec_scene_free(scene);
    free(w);
}

/* In a sky of 1, a ball of albedo 0.8 shows 0.8: a ray from its tangent plane does not meet it again. From facets some rays do, and are
 * lost. */
static void check_furnace(void)
{
    gltf_writer *w = gltf_new();
    add_ball(w, clay(w), 0, 0, 0);
    gltf_camera(w, (double[3]){1, 2.4, 4}, (double[3]){0, 0, 0}, 0.28); /* its middle half */
    ec_scene *scene = case_load(gltf_write(w, "normals-furnace"), "1,1,1");
    for (int t = 0; t <= EC_TERMINATOR_SMOOTH; t++)
        for (int s = 0; s < SAMPLE_COUNT; s++) {
            case_image image = picture(scene, (ec_sample)s, (ec_terminator)t, 16, 1024);
            printf("furnace, %-9s %-10s albedo %.6f +- %.6f\n", ec_terminator_names[t], ec_sample_names[s], image.mean[1], image.mean_se[1]);
            double off = image.mean[1] - 0.8, se = image.mean_se[1];
            if (t == EC_TERMINATOR_SMOOTH) CHECK_MSG(fabs(off) <= 4 * se + 2e-6 && se < 4e-3, "smooth, %s: %g off", ec_sample_names[s], off);
            else CHECK_MSG(off < -0.002, "geometric, %s: %g off", ec_sample_names[s], off);
            case_free(&image);
        }
    ec_scene_free(scene);
    free(w);
}

/* A ball next to another body and near a lamp. */
static ec_scene *two_balls(void)
{
    gltf_writer *w = gltf_new();
    int material = clay(w);
    add_ball(w, material, -1.05, 0, 0);
    add_ball(w, gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.7,0.4,1],\"metallicFactor\":0.6,"
                                        "\"roughnessFactor\":0.4}}"), 1.05, 0, 0);
    gltf_quad(w, material, (double[3]){-4, -1, 4}, (double[3]){8, 0, 0}, (double[3]){0, 0, -8});
    gltf_quad(w, gltf_lambert(w, 0, 5), (double[3]){-2.5, 0.5, 1}, (double[3]){0, 0, -2}, (double[3]){1, 1.5, 0});
    gltf_camera(w, (double[3]){0, 2, 5}, (double[3]){0, 0, 0}, 0.6);
    ec_scene *scene = case_load(gltf_write(w, "normals-strategies"), "0.1,0.1,0.1");
    free(w);
    return scene;
}

/* All strategies give the same smooth picture; those that seldom find the lamp have four times as many samples. */
static void check_strategies(uint32_t samples)
{
    ec_scene *scene = two_balls();
    case_image image[SAMPLE_COUNT];
    for (int s = 0; s < SAMPLE_COUNT; s++) image[s] = picture(scene, (ec_sample)s, EC_TERMINATOR_SMOOTH, 16, s < EC_SAMPLE_BSDF ? samples : 4 * samples);
    for (int s = 1; s < SAMPLE_COUNT; s++) {
        char what[64];
        snprintf(what, sizeof what, "smooth terminator, %s and mis", ec_sample_names[s]);
        case_check_same(&image[s], &image[0], s < EC_SAMPLE_BSDF ? 1 : 4, what);
    }
    for (int s = 0; s < SAMPLE_COUNT; s++) case_free(&image[s]);
    ec_scene_free(scene);
}

static void check_widths(void)
{
    static const struct { uint32_t lanes; const char *tier; } widths[] = {{1, "full"}, {8, "full"}, {4, "long"}, {16, "long"}};
    ec_scene *scene = two_balls();
    case_image first = {0};
    for (int i = 0; i < 4; i++) {
        ec_render_options o = shared(case_options(16, 16, 16));
        o.terminator = EC_TERMINATOR_SMOOTH;
        o.lanes = widths[i].lanes;
        if (i && !test_tier(widths[i].tier)) continue;
        case_image one = case_render(scene, &o);
        if (i) CHECK_MSG(!memcmp(one.rgb, first.rgb, 3 * 16 * 16 * sizeof(float)), "LANES %u gives other bits than 1", widths[i].lanes);
        if (i) case_free(&one);
        else first = one;
    }
    case_free(&first);
    ec_scene_free(scene);
}

int main(void)
{
    const uint32_t more = test_tier("long") ? 4 : 1;
    check_inside(more * 64);
    if (test_tier("full")) check_furnace();
    check_strategies(more * 1024);
    check_widths();
    TEST_END();
}
