/* Light behind panes: thin, smooth walls, which shadow rays pass. What points, spots, suns and lamps give a floor through any number
 * of them, in closed form or by integration in double, for every --sample: nothing is lost or counted twice. */
#include "support/floor_case.h"

#define INTENSITY 6.28318530717958648 /* 2 pi cd */
#define POINT "{\"type\":\"point\",\"intensity\":6.28318530717958648}"

/* Lights are 2 off to the side, not above where two triangles of a sheet meet: panes are passed at an angle. */
static const double at[3] = {1.2, 1.6, 0}, down[3] = {-1.2, -1.6, 0}, cosine = 0.8;

/* What a pane of index 1.5 lets pass at this cosine: base (1 - F), Schlick's F as glTF asks. */
static double pane_passes(double base, double cosine) { return base * (1 - (0.04 + 0.96 * pow(1 - cosine, 5))); }

static void add_pane(gltf_writer *w, int material, double height)
{
    gltf_quad(w, material, (double[3]){-30, height, 30}, (double[3]){60, 0, 0}, (double[3]){0, 0, -60});
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

/* The floor's light by way of `depth` segments, everywhere in the picture the same. One pane less does not see it. */
static void expect(gltf_writer *w, const char *name, ec_integrator integrator, int sample, uint32_t depth, uint32_t spp, double expected, double most_se)
{
    char file[96];
    snprintf(file, sizeof file, "panes-%s", name);
    ec_render_options o = case_options(8, 8, spp);
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

/* A point, a spot and a sun along the same way. I / r^2 cos albedo / pi. No
 * sampling is involved: every path brings the same. 64 panes leave each time 64 roundings more. */
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

/* With a wall between them no light comes, whatever the order; a MASK wall under its cut-off is not there; BLEND leaves its share. */
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

/* A lamp of 1 x 1 at height 1: its radiance times the integral of cos cos' / d^2 and what n panes let pass, by the midpoint rule on
 * 400 x 400 (it errs by 1e-6). Light sampling aims through the panes, directions pass them, and MIS weighs the two. */
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

int main(void)
{
    punctual();
    mixed();
    lamp();
    TEST_END();
}
