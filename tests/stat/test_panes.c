/* tiers: quick, full */
/* Light behind panes: thin, smooth walls, and those of bodies of index 1, which shadow rays pass. Light of points, spots, suns and lamps on
 * a floor through any number of them, in closed form or by integration in double, for every --sample: no light is lost or counted twice. */
#include "support/floor_case.h"

#define INTENSITY 6.28318530717958648 /* 2 pi cd */
#define POINT "{\"type\":\"point\",\"intensity\":6.28318530717958648}"

/* Lights are 2 to the side, not above the edge between a sheet's two triangles: rays pass panes at an angle. */
static const double at[3] = {1.2, 1.6, 0}, down[3] = {-1.2, -1.6, 0}, cosine = 0.8;

/* Transmittance of a pane of index 1.5 at this cosine: base (1 - F), with glTF's Schlick F. */
static double pane_passes(double base, double cosine) { return base * (1 - (0.04 + 0.96 * pow(1 - cosine, 5))); }

static void add_pane(gltf_writer *w, int material, double height)
{
    gltf_quad(w, material, (double[3]){-30, height, 30}, (double[3]){60, 0, 0}, (double[3]){0, 0, -60});
}
/* Transmitted light has the base colour: other panes here are grey. */
static const double tint[3] = {0.9, 0.5, 0.2};
static int tinted(gltf_writer *w)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],\"metallicFactor\":0,\"roughnessFactor\":0},"
                    "\"doubleSided\":true,\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}}}", tint[0], tint[1], tint[2]);
}
static void add_panes(gltf_writer *w, double base, int count)
{
    int material = gltf_add_glass(w, &(gltf_glass){base, 0, 1, 0, {0}, 0});
    for (int i = 0; i < count; i++) add_pane(w, material, 0.5 + i / (double)count);
}
static int coverage(gltf_writer *w, const char *mode, double alpha)
{
    return gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,%g],\"metallicFactor\":0},\"alphaMode\":\"%s\","
                    "\"doubleSided\":true,\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}}", alpha, mode);
}

static void expect_colour(ec_scene *scene, const char *name, const ec_render_options *o, const double expected[3], double most_se)
{
    case_image image = case_render(scene, o);
    for (int c = 0; c < 3; c++)
        CHECK_MSG(fabs(image.mean[c] - expected[c]) <= 4.5 * image.mean_se[c] + 2e-5 * expected[c] && image.mean_se[c] <= most_se * expected[c],
                  "%s, channel %d: %.8g +- %.2g, expected %.8g", name, c, image.mean[c], image.mean_se[c], expected[c]);
    printf("%-24s %.6f %.6f %.6f, expected %.6f %.6f %.6f\n", name, image.mean[0], image.mean[1], image.mean[2], expected[0], expected[1], expected[2]);
    case_free(&image);
    ec_scene_free(scene);
}

/* The floor's light by paths of `depth` segments, uniform over the picture. With one segment less the camera does not see it. */
static void expect(gltf_writer *w, const char *name, ec_integrator integrator, int sample, uint32_t depth, uint32_t spp, double expected, double most_se)
{
    char file[96];
    snprintf(file, sizeof file, "panes-%s", name);
    ec_render_options o = case_quick(case_options(8, 8, spp));
    o.integrator = integrator;
    o.sample = (ec_sample)sample;
    o.max_depth = depth;
    o.cutoff = 0.001;
    case_image image = case_render_file(gltf_write(w, file), NULL, &o);
    for (int c = 0; c < 3; c++)
        CHECK_MSG(fabs(image.mean[c] - expected) <= 4.5 * image.mean_se[c] + 2e-5 * expected && image.mean_se[c] <= most_se * expected,
                  "%s, integrator %d, %s: %.8g +- %.2g, expected %.8g", name, integrator, ec_sample_names[sample], image.mean[c],
                  image.mean_se[c], expected);
    printf("%-24s %-10s %.7f +- %.7f, expected %.7f\n", name, ec_sample_names[sample], image.mean[1], image.mean_se[1], expected);
    case_free(&image);
}

/* A point, a spot and a sun in the same direction: I / r^2 cos albedo / pi. No sampling is involved: every path brings the same light. 64
 * panes cause 64 roundings more. */
static void punctual(void)
{
    static const int counts[4] = {0, 1, 3, 64};
    static const char *const kinds[3] = {POINT,
                                         "{\"type\":\"spot\",\"intensity\":6.28318530717958648,\"spot\":{\"outerConeAngle\":0.5}}",
                                         "{\"type\":\"directional\",\"intensity\":6.28318530717958648}"};
    const double base = 0.97;
    for (int kind = 0; kind < 3; kind++)
        for (int i = 0; i < 4; i++)
            for (int whitted = 0; whitted < 2; whitted++) {
                int n = counts[i];
                gltf_writer *w = floor_scene(0.2);
                add_panes(w, base, n);
                gltf_light(w, at, down, kinds[kind]);
                double want = INTENSITY / (kind == 2 ? 1 : 4) * cosine * 0.6 / PI * pow(pane_passes(base, cosine), n);
                char name[32];
                snprintf(name, sizeof name, "%d-before-%d", n, kind);
                expect(w, name, whitted ? EC_INTEGRATOR_WHITTED : EC_INTEGRATOR_PATH, EC_SAMPLE_MIS, whitted ? 0 : (uint32_t)n + 2, 16, want, 1e-6);
                if (n && !whitted) expect(w, name, EC_INTEGRATOR_PATH, EC_SAMPLE_MIS, (uint32_t)n + 1, 16, 0, 1);
                free(w);
            }
}

/* An opaque wall among the panes blocks all light, in any order. A MASK wall below its cut-off has no effect, and BLEND leaves its share. */
static void mixed(void)
{
    const struct {
        const char *name, *mode;
        double alpha, left, most_se;
    } cases[4] = {{"pane-and-wall", "OPAQUE", 1, 0, 1}, {"pane-and-mask", "MASK", 0.4, 1, 1e-6}, {"pane-and-solid-mask", "MASK", 0.6, 0, 1},
                  {"pane-and-blend", "BLEND", 0.4, 0.6, 8e-3}};
    for (int i = 0; i < 4; i++)
        for (int above = 0; above < 2; above++)
            for (int s = 0; s <= EC_SAMPLE_HEMISPHERE; s += EC_SAMPLE_HEMISPHERE) {
                gltf_writer *w = floor_scene(0.2);
                add_panes(w, 0.9, 1);
                add_pane(w, coverage(w, cases[i].mode, cases[i].alpha), above ? 0.7 : 0.3);
                gltf_light(w, at, down, POINT);
                expect(w, cases[i].name, EC_INTEGRATOR_PATH, s, 3, 1024, INTENSITY / 4 * cosine * 0.6 / PI * pane_passes(0.9, cosine) * cases[i].left,
                       cases[i].most_se);
                free(w);
            }
}

/* A lamp of 1 x 1 at height 1: its radiance times the integral of cos cos' / d^2 and the transmittance of n panes, by the midpoint rule on
 * 400 x 400 (error 1e-6). Light sampling aims through the panes, BSDF directions pass them, and MIS weighs both. */
static void lamp(void)
{
    for (int n = 1; n < 4; n += 2) {
        double want = 0;
        for (int y = 0; y < 400; y++)
            for (int x = 0; x < 400; x++) {
                double a = (x + 0.5) / 400, b = (y + 0.5) / 400 - 0.5, d2 = a * a + b * b + 1;
                want += 4 * 0.6 / PI / (d2 * d2) * pow(pane_passes(0.8, 1 / sqrt(d2)), n) / 160000;
            }
        for (int s = 0; s <= EC_SAMPLE_HEMISPHERE; s++) {
            gltf_writer *w = floor_scene(0.2);
            int material = gltf_add_glass(w, &(gltf_glass){0.8, 0, 1, 0, {0}, 0});
            for (int i = 0; i < n; i++) add_pane(w, material, 0.4 + 0.1 * i);
            gltf_quad(w, gltf_lambert(w, 0, 4), (double[3]){0, 1, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
            char name[32];
            snprintf(name, sizeof name, "%d-before-a-lamp", n);
            expect(w, name, EC_INTEGRATOR_PATH, s, (uint32_t)n + 2, 4096, want, 5e-3);
            free(w);
        }
    }
}

/* Coloured panes before a point, a sun and the sky: base colour^n each. For the sky, over all directions: the integral of 2 c (1 - F(c)) is
 * 0.96 (1 - 2 / 42). Panes extend to a cosine of 2e-4. */
static void colours(void)
{
    static const char *const lights[3] = {POINT, "{\"type\":\"directional\",\"intensity\":6.28318530717958648}", NULL};
    for (int kind = 0; kind < 3; kind++)
        for (int n = 1; n <= 3; n += 2) {
            gltf_writer *w = floor_scene(0.2);
            int material = tinted(w);
            char name[32];
            ec_render_options o = case_quick(case_options(8, 8, lights[kind] ? 16 : 4096));
            double want[3];
            if (!lights[kind] && n > 1) {
                free(w);
                continue;
            }
            o.max_depth = (uint32_t)n + 2;
            for (int i = 0; i < n; i++)
                gltf_quad(w, material, (double[3]){-3000, 0.5 + 0.2 * i, 3000}, (double[3]){6000, 0, 0}, (double[3]){0, 0, -6000});
            if (lights[kind]) gltf_light(w, at, down, lights[kind]);
            else /* the pane reflects a dark environment */
                gltf_quad(w, gltf_lambert(w, 0, 0), (double[3]){-3000, -0.01, 3000}, (double[3]){6000, 0, 0}, (double[3]){0, 0, -6000});
            for (int c = 0; c < 3; c++)
                want[c] = lights[kind] ? INTENSITY / (kind ? 1 : 4) * cosine * 0.6 / PI * pow(pane_passes(tint[c], cosine), n)
                                       : 0.6 * tint[c] * 0.96 * (1 - 2 / 42.0);
            snprintf(name, sizeof name, "%d-tinted-before-%d", n, kind);
            expect_colour(case_load(gltf_write(w, name), lights[kind] ? NULL : "1,1,1"), name, &o, want, lights[kind] ? 1e-6 : 5e-3);
            free(w);
        }
}

static void add_body(gltf_writer *w, const double left[3], double low, double high, double half)
{
    gltf_glass g = {0.9, 0.5, 1, 1, {left[0], left[1], left[2]}, 0.5};
    gltf_box(w, gltf_add_glass(w, &g), (double[3]){-half, low, -half}, (double[3]){half, high, half});
}

/* Bodies of index 1 before a point and a sun, also rough ones: 0.9 for each wall, times their absorption. 1: one; 2: one in another, which
 * it displaces; 3: around the point itself. */
static void bodies(int first, int last, int ways)
{
    static const double outer[3] = {0.9, 0.6, 0.3}, inner[3] = {0.2, 0.5, 0.8};
    static const uint32_t walls[4] = {0, 2, 4, 1};
    static const double outer_way[4] = {0, 0.6 / 0.8, 0.3 / 0.8, 1.2 / 0.8};
    for (int kind = first; kind <= last; kind++)
        for (int sun = 0; sun < (kind < 3 ? 2 : 1); sun++)
            for (int way = 0; way < ways; way++) { /* paths, paths with a segment less, Whitted's */
                gltf_writer *w = floor_scene(0.2);
                add_body(w, outer, 0.4, kind == 3 ? 2 : 1, 30);
                if (kind == 2) add_body(w, inner, 0.5, 0.8, 20);
                gltf_light(w, at, down, sun ? "{\"type\":\"directional\",\"intensity\":6.28318530717958648}" : POINT);
                ec_render_options o = case_quick(case_options(8, 8, 16));
                o.integrator = way == 2 ? EC_INTEGRATOR_WHITTED : EC_INTEGRATOR_PATH;
                o.max_depth = way == 2 ? 0 : walls[kind] + 2 - (way == 1);
                o.cutoff = 0.001;
                double want[3];
                for (int c = 0; c < 3; c++)
                    want[c] = way == 1 ? 0 : INTENSITY / (sun ? 1 : 4) * cosine * 0.6 / PI * pow(0.9, walls[kind]) * pow(outer[c], outer_way[kind] / 0.5) *
                                                 (kind == 2 ? pow(inner[c], 0.3 / 0.8 / 0.5) : 1);
                char name[48];
                snprintf(name, sizeof name, "bodies-%d-%s-%d", kind, sun ? "sun" : "point", way);
                expect_colour(case_load(gltf_write(w, name), NULL), name, &o, want, 1e-6);
                free(w);
            }
}

/* A texture's alpha in the way: texels of 51 and 204. The light passes at u = 0.65, where alpha is 0.68: 0.2 x 51 / 255 + 0.8 x 204 / 255. */
static void textured_alpha(void)
{
    static const struct {
        const char *mode;
        double cutoff, left;
    } cases[3] = {{"BLEND", 0.5, 0.32}, {"MASK", 0.66, 0}, {"MASK", 0.7, 1}};
    for (int sun = 0; sun < 2; sun++)
        for (int i = 0; i < 3; i++) {
            gltf_writer *w = floor_scene(0.2);
            int panel = gltf_add(&w->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1],\"metallicFactor\":0},\"alphaMode\":\"%s\","
                                 "\"alphaCutoff\":%g,\"doubleSided\":true,\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}}",
                                 cases[i].mode, cases[i].cutoff);
            gltf_quad(w, panel, (double[3]){-2, 0.8, 2}, (double[3]){4, 0, 0}, (double[3]){0, 0, -4});
            gltf_light(w, at, down, sun ? "{\"type\":\"directional\",\"intensity\":6.28318530717958648}" : POINT);
            ec_scene *scene = case_load(gltf_write(w, "textured-alpha"), NULL);
            scene->images = calloc(1, sizeof *scene->images);
            scene->textures = calloc(1, sizeof *scene->textures);
            scene->images[0] = (ec_image){.width = 2, .height = 1, .rgba8 = calloc(8, 1)};
            scene->images[0].rgba8[3] = 51;
            scene->images[0].rgba8[7] = 204;
            scene->image_count = scene->texture_count = 1;
            for (uint32_t m = 0; m < scene->material_count; m++)
                if (scene->materials[m].alpha_mode != EC_ALPHA_OPAQUE)
                    scene->materials[m].textures[EC_SLOT_BASE_COLOR] = (ec_texture_use){0, 0, {1, 0, 0, 0, 1, 0}};
            double want = INTENSITY / (sun ? 1 : 4) * cosine * 0.6 / PI * cases[i].left, all[3] = {want, want, want};
            char name[48];
            ec_render_options o = case_quick(case_options(8, 8, 4096));
            o.max_depth = 2;
            snprintf(name, sizeof name, "alpha of a texture, %s %g", cases[i].mode, cases[i].cutoff);
            expect_colour(scene, name, &o, all, 6e-3);
            free(w);
        }
}

int main(void)
{
    if (test_tier("quick")) {
        colours();
        bodies(2, 2, 2);
    }
    if (test_tier("full")) {
        bodies(1, 3, 3);
        textured_alpha();
        punctual();
        mixed();
        lamp();
    }
    TEST_END();
}
