/* tier: full */
/* Bodies in bodies: slabs of glass with liquids, ice and air between them, whose picture is that of a stack of layers (Fresnel and
 * Beer-Lambert in double); and balls in balls. Light is reflected between layers, so a stack is added up layer by layer. */
#include "report/names.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

static const double colour[3] = {0.9, 0.5, 0.2}, clear[3] = {1, 1, 1};

/* Transmittance after x metres of a medium that leaves `colour` after 0.5. */
static double left_after(int coloured, int channel, double x) { return coloured ? pow(colour[channel], x / 0.5) : 1; }

/* Unpolarised reflectance from index n1 to n2 (Fresnel); sine: n1 sin(angle), which refraction keeps. 1 beyond the critical angle. */
static double fresnel(double sine, double n1, double n2)
{
    if (sine >= n2) return 1;
    double c1 = sqrt(1 - sine * sine / (n1 * n1)), c2 = sqrt(1 - sine * sine / (n2 * n2));
    double s = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2), p = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
    return (s * s + p * p) / 2;
}

typedef struct layer {
    double index, thickness;
    int coloured;
} layer;

/* Reflectance and transmittance of a stack in air, from the last layer up (adding method). If the layers below reflect R and transmit T,
 *   R' = F + (1 - F)^2 A^2 R / (1 - F A^2 R),   T' = (1 - F) A T / (1 - F A^2 R) */
static void add_up(const layer *layers, int count, double sine, int channel, double *reflected, double *passed)
{
    double R = 0, T = 1;
    double below = 1; /* air */
    for (int i = count - 1; i >= -1; i--) {
        double index = i < 0 ? 1 : layers[i].index, F = fresnel(sine, index, below);
        double A = 1, all = 1 - F * R;
        R = F + (1 - F) * (1 - F) * R / all;
        T = (1 - F) * T / all;
        if (i >= 0) {
            A = left_after(layers[i].coloured, channel, layers[i].thickness / sqrt(1 - sine * sine / (index * index)));
            R *= A * A;
            T *= A;
        }
        below = index;
    }
    *reflected = R;
    *passed = T;
}

static gltf_glass body(double ior, int coloured)
{
    const double *c = coloured ? colour : clear;
    return (gltf_glass){1, 0, 1, ior, {c[0], c[1], c[2]}, coloured ? 0.5 : 0};
}
/* A slab from z = top down to z = bottom, so wide that no light comes from its rim. */
static void add_slab(gltf_writer *w, double ior, int coloured, double top, double bottom, double half)
{
    gltf_glass g = body(ior, coloured);
    gltf_box(w, gltf_add_glass(w, &g), (double[3]){-half, -half, bottom}, (double[3]){half, half, top});
}
static void add_sheet(gltf_writer *w, int material, double z)
{
    gltf_quad(w, material, (double[3]){-400, -400, z}, (double[3]){800, 0, 0}, (double[3]){0, 800, 0});
}
static void add_camera(gltf_writer *w, double angle)
{
    gltf_camera(w, (double[3]){20 * sin(angle), 0, 20 * cos(angle)}, (double[3]){0, 0, 0}, 1e-5);
}

/* All scenes share one program. */
static ec_render_options shared(ec_render_options options)
{
    options.more_effects = EC_FEATURE_EMISSION | EC_FEATURE_AREA_LIGHTS | EC_FEATURE_ENVIRONMENT | EC_FEATURE_SPECULAR | EC_FEATURE_SMOOTH |
                           EC_FEATURE_CULLING | EC_FEATURE_TRANSMISSION | EC_FEATURE_ABSORPTION | EC_FEATURE_MATCHED | EC_FEATURE_PANES | EC_FEATURE_NESTED;
    return case_quick(options);
}

static ec_render_options options_for(int sample, uint32_t spp)
{
    ec_render_options o = shared(case_options(16, 16, spp));
    o.sample = (ec_sample)sample;
    return o;
}

/* The whole picture is one direction. `exact`: tolerance of each channel for rounding, or for light left out by design. */
static void expect(gltf_writer *w, const char *name, const char *environment, const ec_render_options *o, const double want[3], double exact)
{
    char file[96];
    snprintf(file, sizeof file, "nested-%s", name);
    case_image image = case_render_file(gltf_write(w, file), environment, o);
    free(w);
    for (int c = 0; c < 3; c++) {
        CHECK_MSG(fabs(image.mean[c] - want[c]) <= 4 * image.mean_se[c] + exact * want[c] + 1e-9 && image.mean_se[c] <= 1e-3,
                  "%s, channel %d: %.7f +- %.7f, expected %.7f", name, c, image.mean[c], image.mean_se[c], want[c]);
    }
    printf("%-32s %.6f %.6f %.6f, expected %.6f %.6f %.6f, +- %.1e\n", name, image.mean[0], image.mean[1], image.mean[2], want[0],
           want[1], want[2], image.mean_se[1]);
    case_free(&image);
}

/* A slab in a slab makes three layers. The inner one is ice in water; an air gap, with total reflection beyond its critical angle; diamond;
 * a medium of the same index, which is invisible; or of nearly the same. */
static void slabs(void)
{
    static const double outer[6] = {1.5, 1.33, 1.5, 1.5, 1.5, 1.5}, inner[6] = {1.33, 1.31, 1, 2.4, 1.5, 1.5 * (1 + 1e-6)};
    static const double angles[2] = {0, 0.9};
    for (int n = 0; n < 6; n++)
        for (int a = 0; a < 2; a++)
            for (int lit = 0; lit < 2; lit++)
                for (int whitted = 0; whitted <= (n == 0); whitted++) {
                    layer stack[3] = {{outer[n], 0.2, 0}, {inner[n], 0.3, 1}, {outer[n], 0.1, 0}};
                    double want[3], other;
                    for (int c = 0; c < 3; c++) add_up(stack, 3, sin(angles[a]), c, lit ? &other : &want[c], lit ? &want[c] : &other);
                    char name[64];
                    snprintf(name, sizeof name, "%g-in-%g-%s-%g%s", inner[n], outer[n], lit ? "passes" : "reflects", angles[a], whitted ? "-whitted" : "");
                    gltf_writer *w = gltf_new();
                    add_slab(w, outer[n], 0, 0, -0.6, 90);
                    add_slab(w, inner[n], 1, -0.2, -0.5, 80);
                    add_sheet(w, gltf_lambert(w, 0, lit), -1);
                    add_camera(w, angles[a]);
                    ec_render_options o = options_for(EC_SAMPLE_MIS, whitted ? 4 : 256);
                    o.integrator = whitted ? EC_INTEGRATOR_WHITTED : EC_INTEGRATOR_PATH;
                    if (whitted) o.max_depth = 40, o.cutoff = 1e-6; /* some dozens of branches are left out */
                    expect(w, name, lit ? NULL : "1,1,1", &o, want, whitted ? 3e-4 : 3e-6);
                }
}

/* A liquid overlaps the glass around it by 1e-3: the body of smaller volume displaces the other, whichever wall comes first. The slabs
 * differ in width. And ice across the surface of water. */
static void overlaps(void)
{
    for (int s = 0; s <= EC_SAMPLE_HEMISPHERE; s += EC_SAMPLE_HEMISPHERE)
        for (int lit = 0; lit < 2; lit++) {
            double wall = s ? 0.2 : 0.199;
            layer stack[3] = {{1.5, wall, 0}, {1.33, 0.7 - 2 * wall, 1}, {1.5, wall, 0}}, ice[2] = {{1.31, 0.3, 0}, {1.33, 0.2, 1}};
            ec_render_options o = options_for(s, 256);
            double want[3], other;
            gltf_writer *w = gltf_new();
            for (int c = 0; c < 3; c++) add_up(stack, 3, sin(0.5), c, lit ? &other : &want[c], lit ? &want[c] : &other);
            add_slab(w, 1.5, 0, 0, -0.2, 90);
            add_slab(w, 1.5, 0, -0.5, -0.7, 90); /* another material */
            add_slab(w, 1.33, 1, -0.199, -0.501, s ? 100 : 60);
            add_sheet(w, gltf_lambert(w, 0, lit), -1);
            add_camera(w, 0.5);
            expect(w, lit ? "overlap-passes" : "overlap-reflects", lit ? NULL : "1,1,1", &o, want, 3e-6);

            w = gltf_new();
            for (int c = 0; c < 3; c++) add_up(ice, 2, sin(0.5), c, lit ? &other : &want[c], lit ? &want[c] : &other);
            add_slab(w, 1.33, 1, -0.1, -0.5, 90);
            add_slab(w, 1.31, 0, 0, -0.3, 80);
            add_sheet(w, gltf_lambert(w, 0, lit), -1);
            add_camera(w, 0.5);
            expect(w, lit ? "ice-passes" : "ice-reflects", lit ? NULL : "1,1,1", &o, want, 3e-6);
        }
}

/* 32 nested boxes of 32 materials: 64 walls, 63 layers. With index 1 they only absorb. No roulette, which would be most of the noise; light
 * after 400 segments is less than 1e-6. Rays start 9 u |z| beyond a wall: for index 1, all walls together keep 64 x 9 u x 0.7 x 3.2 = 8e-5
 * of blue from being absorbed. */
static void deep(void)
{
    for (int bare = 0; bare < 2; bare++) {
        enum { BODIES = 32 };
        layer stack[2 * BODIES - 1];
        double want[3], other;
        gltf_writer *w = gltf_new();
        for (int i = 0; i < BODIES; i++) {
            double index = bare ? 1 : 1.3 + 0.05 * (i % 5), depth = 0.01 * i;
            add_slab(w, index, i == BODIES - 1 || bare, -depth, -0.7 + depth, 90 - i);
            stack[i] = stack[2 * BODIES - 2 - i] = (layer){index, i == BODIES - 1 ? 0.7 - 2 * depth : 0.01, i == BODIES - 1 || bare};
        }
        for (int c = 0; c < 3; c++) add_up(stack, 2 * BODIES - 1, sin(0.5), c, &other, &want[c]);
        add_sheet(w, gltf_lambert(w, 0, 1), -1);
        add_camera(w, 0.5);
        ec_render_options o = options_for(EC_SAMPLE_MIS, bare ? 4 : 512);
        o.survival = 1;
        o.max_depth = 400;
        expect(w, bare ? "64-walls-of-index-1" : "64-walls", NULL, &o, want, bare ? 1e-4 : 2e-5);
    }
}

/* A camera in water in glass, 0.1 below the surface and 0.2 above a black lamp. Looking up, it sees white through water's surface and
 * glass, and the lamp in their reflections. Looking down, there is only water in between. Then attenuation distances of 1e30 and 1e-6. */
static void within(void)
{
    double want[3], seen[3], other, Fu = fresnel(0, 1.33, 1.5), Fg = fresnel(0, 1.5, 1);
    double R = Fu + (1 - Fu) * (1 - Fu) * Fg / (1 - Fu * Fg), T = (1 - Fu) * (1 - Fg) / (1 - Fu * Fg);
    for (int c = 0; c < 3; c++) seen[c] = left_after(1, c, 0.1) * (T + R * left_after(1, c, 0.3));
    ec_render_options o = options_for(EC_SAMPLE_MIS, 512);
    gltf_writer *w = gltf_new();
    add_slab(w, 1.5, 0, 0, -0.8, 90);
    add_slab(w, 1.33, 1, -0.2, -0.7, 80);
    add_sheet(w, gltf_lambert(w, 0, 1), -0.5);
    gltf_camera(w, (double[3]){0, 0, -0.3}, (double[3]){0, 0, 1}, 1e-5);
    expect(w, "camera-in-water", "1,1,1", &o, seen, 3e-6);

    w = gltf_new();
    for (int c = 0; c < 3; c++) want[c] = left_after(1, c, 0.2);
    add_slab(w, 1.5, 0, 0, -0.8, 90);
    add_slab(w, 1.33, 1, -0.2, -0.7, 80);
    add_sheet(w, gltf_lambert(w, 0, 1), -0.5);
    gltf_camera(w, (double[3]){0, 0, -0.3}, (double[3]){0, 0, -1}, 1e-5);
    expect(w, "lamp-in-water", NULL, &o, want, 3e-6);

    for (int soot = 0; soot < 2; soot++) {
        layer stack[3] = {{1.5, 0.2, 0}, {1.33, 0.3, 0}, {1.5, 0.1, 0}};
        gltf_glass g = {1, 0, 1, 1.33, {0.5, 0.5, 0.5}, soot ? 1e-6 : 1e30};
        w = gltf_new();
        add_slab(w, 1.5, 0, 0, -0.6, 90);
        gltf_box(w, gltf_add_glass(w, &g), (double[3]){-80, -80, -0.5}, (double[3]){80, 80, -0.2});
        add_sheet(w, gltf_lambert(w, 0, 1), -1);
        add_camera(w, 0);
        for (int c = 0; c < 3; c++) {
            add_up(stack, 3, 0, c, &other, &want[c]);
            if (soot) want[c] = 0;
        }
        expect(w, soot ? "soot" : "clear", NULL, &o, want, 3e-6);
    }
}

/* A ball by latitude and longitude. */
static void add_ball(gltf_writer *w, int material, double radius)
{
    enum { M = 24, N = 48 };
    static float p[18 * M * N];
    int count = 0;
    for (int i = 0; i < M; i++)
        for (int j = 0; j < N; j++) {
            double v[4][3];
            for (int k = 0; k < 4; k++) {
                double theta = 3.14159265358979 * (i + (k == 1 || k == 2)) / M, phi = 2 * 3.14159265358979 * (j + (k >= 2)) / N;
                v[k][0] = radius * sin(theta) * cos(phi), v[k][1] = radius * cos(theta), v[k][2] = radius * sin(theta) * sin(phi);
            }
            static const int order[6] = {0, 2, 1, 0, 3, 2};
            for (int k = 0; k < 6; k++, count++)
                for (int c = 0; c < 3; c++) p[3 * count + c] = (float)v[order[k]][c];
        }
    gltf_triangles(w, material, &(gltf_mesh){count, p, NULL, NULL, NULL});
}

/* Nested balls of white glass in white light: no path loses light, in any order of priorities. Gaps are as small as 4e-5 of the radius, or
 * overlap by as much. In such a thin layer with total reflection on both sides, light needs 0.13 / 4e-5 = 3000 reflections to the end of a
 * facet. The rest of those few paths (2 in 1024) is cut off. */
static void balls(void)
{
    static const double radii[3] = {0.6, 1 - 4e-5, 1 + 4e-5};
    for (int i = 0; i < 3; i++) {
        gltf_writer *w = gltf_new();
        gltf_glass outer = body(1.5, 0), liquid = body(1.33, 0), bubble = body(1, 0);
        add_ball(w, gltf_add_glass(w, &outer), 1);
        add_ball(w, gltf_add_glass(w, &liquid), radii[i]);
        add_ball(w, gltf_add_glass(w, &bubble), 0.3);
        gltf_camera(w, (double[3]){2, 3, 4}, (double[3]){0, 0, 0}, 0.4);
        ec_render_options o = options_for(EC_SAMPLE_MIS, 4);
        o.survival = 1; /* roulette would make all the noise */
        o.max_depth = 1000;
        case_image image = case_render_file(gltf_write(w, "nested-balls"), "1,1,1", &o);
        free(w);
        printf("balls, %.5g in 1: %.6f\n", radii[i], image.mean[1]);
        CHECK_MSG(image.mean[1] <= 1 + 1e-5 && image.mean[1] >= (i == 1 ? 0.99 : 1 - 1e-5), "balls, %.5g in 1: %.6f", radii[i], image.mean[1]);
        case_free(&image);
    }
}

/* A ball of the medium around it changes nothing in a picture with a lamp and a floor. */
static void not_seen(void)
{
    case_image image[2];
    for (int i = 0; i < 2; i++) {
        gltf_writer *w = gltf_new();
        gltf_quad(w, gltf_lambert(w, 0.6, 0), (double[3]){-3, -1.2, 3}, (double[3]){6, 0, 0}, (double[3]){0, 0, -6});
        gltf_quad(w, gltf_lambert(w, 0.3, 3), (double[3]){-2, 2.5, -2}, (double[3]){4, 0, 0}, (double[3]){0, 0, 4});
        gltf_glass glass = body(1.5, 1), same = body(1.5, 1);
        gltf_box(w, gltf_add_glass(w, &glass), (double[3]){-1, -1, -1}, (double[3]){1, 1, 1});
        if (i) add_ball(w, gltf_add_glass(w, &same), 0.8);
        gltf_camera(w, (double[3]){0, 0.7, 4}, (double[3]){0, 0, 0}, 0.8);
        ec_render_options o = shared(case_random(16, 4096, EC_SAMPLE_MIS, (uint64_t)i));
        image[i] = case_render_file(gltf_write(w, "nested-not-seen"), NULL, &o);
        free(w);
    }
    case_check_same(&image[1], &image[0], 4, "a ball of the same index in a block");
    for (int i = 0; i < 2; i++) case_free(&image[i]);
}

int main(void)
{
    slabs();
    overlaps();
    deep();
    within();
    balls();
    not_seen();
    TEST_END();
}
