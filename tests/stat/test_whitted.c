/* tiers: quick, full */
/* Whitted's ray trees against closed forms, which are beside the scenes. A camera with a tiny field of view sees one point. */
#include "support/gltf_writer.h"
#include "support/render_case.h"

#define PI 3.14159265358979323846

static case_image look(const char *path, const char *environment, uint32_t max_depth, double cutoff)
{
    ec_scene *scene = case_load(path, environment);
    ec_render_options o = case_with_all_effects(case_options(8, 8, 4));
    o.integrator = EC_INTEGRATOR_WHITTED;
    o.max_depth = max_depth;
    o.cutoff = cutoff;
    case_image image = case_render(scene, &o);
    ec_scene_free(scene);
    return image;
}

/* There is no noise: only the position in the pixel is sampled. */
static void check(const char *what, const char *path, const char *environment, uint32_t max_depth, double cutoff, double expected)
{
    case_image image = look(path, environment, max_depth, cutoff);
    double error = fabs(image.mean[1] - expected);
    printf("%-44s depth %2u cutoff %-5g %.7f, expected %.7f\n", what, max_depth, cutoff, image.mean[1], expected);
    CHECK_MSG(error <= 1e-5 * fabs(expected), "%s, depth %u, cutoff %g: %.9g, expected %.9g", what, max_depth, cutoff, image.mean[1], expected);
    case_free(&image);
}

static int material(gltf_writer *w, double base, double metallic, double roughness, const char *extensions)
{
    return gltf_add(&w->materials,
                    "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.9g,%.9g,%.9g,1],\"metallicFactor\":%.9g,\"roughnessFactor\":%.9g},"
                    "\"extensions\":{%s}}", base, base, base, metallic, roughness, extensions);
}

#define PASSES "\"KHR_materials_transmission\":{\"transmissionFactor\":1}"
#define GLASS PASSES ",\"KHR_materials_ior\":{\"ior\":1.5},\"KHR_materials_volume\":{\"thicknessFactor\":1}"

static void box(gltf_writer *w, int id, double x0, double x1, double y0, double y1, double z0, double z1)
{
    double x = x1 - x0, y = y1 - y0, z = z1 - z0;
    gltf_quad(w, id, (double[3]){x0, y0, z1}, (double[3]){x, 0, 0}, (double[3]){0, y, 0});
    gltf_quad(w, id, (double[3]){x0, y0, z0}, (double[3]){0, y, 0}, (double[3]){x, 0, 0});
    gltf_quad(w, id, (double[3]){x1, y0, z0}, (double[3]){0, y, 0}, (double[3]){0, 0, z});
    gltf_quad(w, id, (double[3]){x0, y0, z0}, (double[3]){0, 0, z}, (double[3]){0, y, 0});
    gltf_quad(w, id, (double[3]){x0, y1, z0}, (double[3]){0, 0, z}, (double[3]){x, 0, 0});
    gltf_quad(w, id, (double[3]){x0, y0, z0}, (double[3]){x, 0, 0}, (double[3]){0, 0, z});
}

/* A metal of reflectance 0.6, seen head-on and at 60 degrees (Schlick). */
static void mirrors_reflect_by_fresnel(void)
{
    for (int tilted = 0; tilted < 2; tilted++) {
        gltf_writer *w = gltf_new();
        gltf_quad(w, material(w, 0.6, 1, 0, ""), (double[3]){-5, -5, 0}, (double[3]){10, 0, 0}, (double[3]){0, 10, 0});
        gltf_camera(w, (double[3]){0, tilted ? sqrt(3) : 0, 1}, (double[3]){0, 0, 0}, 1e-5);
        double expected = tilted ? 0.6 + 0.4 * pow(0.5, 5) : 0.6;
        check(tilted ? "metal mirror at 60 degrees" : "metal mirror", gltf_write(w, "whitted-mirror"), "2,2,2", 10, 0, 2 * expected);
        free(w);
    }
}

/* A slab of glass, head-on, before an environment of 1: R = 0.04 is reflected, and T^2 R^j passes after j internal reflections in segment j
 * + 3. */
static void slabs_share_light_out(void)
{
    const double R = 0.04, T = 0.96;
    gltf_writer *w = gltf_new();
    box(w, material(w, 1, 0, 0, GLASS), -5, 5, -5, 5, -0.2, 0);
    gltf_camera(w, (double[3]){0, 0, 1}, (double[3]){0, 0, 0}, 1e-5);
    const char *path = gltf_write(w, "whitted-slab");
    check("slab", path, "1,1,1", 1, 0, 0);
    check("slab", path, "1,1,1", 2, 0, R);
    check("slab", path, "1,1,1", 3, 0, R + T * T);
    check("slab", path, "1,1,1", 4, 0, R + T * T * (1 + R));
    check("slab", path, "1,1,1", 10, 0, R + T * T * (1 - pow(R, 8)) / (1 - R));
    check("slab", path, "1,1,1", 10, 0.05, T * T);          /* T R = 0.0384 and R are left out */
    check("slab", path, "1,1,1", 10, 0.03, R + T * T * (1 + R));
    free(w);
    w = gltf_new(); /* half of the light remains after 0.1 m */
    box(w, material(w, 1, 0, 0, PASSES ",\"KHR_materials_volume\":{\"thicknessFactor\":1,\"attenuationDistance\":0.1,"
                                       "\"attenuationColor\":[0.5,0.5,0.5]}"), -5, 5, -5, 5, -0.2, 0);
    gltf_camera(w, (double[3]){0, 0, 1}, (double[3]){0, 0, 0}, 1e-5);
    check("grey slab", gltf_write(w, "whitted-grey-slab"), "1,1,1", 4, 0, R + T * T * (0.25 + R * pow(0.25, 2)));
    free(w);
    w = gltf_new();
    gltf_quad(w, material(w, 0.5, 0, 0, PASSES), (double[3]){-5, -5, 0}, (double[3]){10, 0, 0}, (double[3]){0, 10, 0});
    gltf_camera(w, (double[3]){0, 0, 1}, (double[3]){0, 0, 0}, 1e-5);
    check("thin pane, tinted", gltf_write(w, "whitted-pane"), "1,1,1", 2, 0, R + T * 0.5);
    free(w);
}

/* Light that reaches the eye through `faces` interfaces, of which `at` comes next, with `left` segments left. */
static double stack_of_slabs(int at, int step, int faces, int left)
{
    if (at < 0 || at >= faces) return 1; /* outside at either end: environment */
    if (left < 2) return 0;
    return 0.04 * stack_of_slabs(at - step, -step, faces, left - 1) + 0.96 * stack_of_slabs(at + step, step, faces, left - 1);
}

/* Every hit branches: 2^10 leaves a sample, on a stack of eleven. */
static void trees_are_whole(void)
{
    gltf_writer *w = gltf_new();
    int glass = material(w, 1, 0, 0, GLASS);
    for (int i = 0; i < 6; i++) box(w, glass, -5, 5, -5, 5, -0.3 * i - 0.1, -0.3 * i);
    gltf_camera(w, (double[3]){0, 0, 1}, (double[3]){0, 0, 0}, 1e-5);
    check("six slabs", gltf_write(w, "whitted-slabs"), "1,1,1", 12, 0, stack_of_slabs(0, 1, 12, 12));
    free(w);
}

/* A right-angled prism turns the view up to a lamp: the ray meets the long face at 45 degrees, beyond the critical angle of 41.8. */
static void total_reflection_loses_nothing(void)
{
    const double R = 0.04, T = 0.96;
    gltf_writer *w = gltf_new();
    int glass = material(w, 1, 0, 0, GLASS);
    gltf_quad(w, glass, (double[3]){-1, -1, 1}, (double[3]){2, 0, 0}, (double[3]){0, 2, 0});  /* towards the eye */
    gltf_quad(w, glass, (double[3]){-1, 1, -1}, (double[3]){0, 0, 2}, (double[3]){2, 0, 0});  /* towards the lamp */
    gltf_quad(w, glass, (double[3]){-1, -1, 1}, (double[3]){0, 2, -2}, (double[3]){2, 0, 0}); /* at 45 degrees */
    gltf_quad(w, gltf_lambert(w, 0, 3), (double[3]){-1, 2, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
    gltf_camera(w, (double[3]){0, 0.1, 3}, (double[3]){0, 0.1, 0}, 1e-5);
    const char *path = gltf_write(w, "whitted-prism");
    check("prism", path, NULL, 4, 0, 3 * T * T);
    check("prism, one echo", path, NULL, 8, 0, 3 * T * T * (1 + R * R));
    free(w);
}

static gltf_writer *floor_of(double roughness, const char *extensions)
{
    gltf_writer *w = gltf_new();
    gltf_quad(w, material(w, 0.6, 0, roughness, extensions), (double[3]){-5, 0, 5}, (double[3]){10, 0, 0}, (double[3]){0, 0, -10});
    gltf_camera(w, (double[3]){0, 1, 1}, (double[3]){0, 0, 0}, 1e-5);
    return w;
}

#define MATT "\"KHR_materials_specular\":{\"specularFactor\":0}"

/* A lamp of 2 x 2 at height 2 lights from its centre with its whole area: E = 3 * 4 / 2^2. One ray decides on shadow. */
static void lamps_shine_from_their_centres(void)
{
    const double lit = 0.6 / PI * 3;
    for (int blocker = 0; blocker < 3; blocker++) {
        gltf_writer *w = floor_of(1, MATT);
        gltf_quad(w, gltf_lambert(w, 0, 3), (double[3]){-1, 2, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
        int black = gltf_lambert(w, 0, 0);
        if (blocker == 1) gltf_quad(w, black, (double[3]){-0.01, 1.9, -0.01}, (double[3]){0.02, 0, 0}, (double[3]){0, 0, 0.02});
        if (blocker == 2) gltf_quad(w, black, (double[3]){0.01, 1.9, -5}, (double[3]){9, 0, 0}, (double[3]){0, 0, 10});
        check(blocker == 1 ? "lamp, its centre hidden" : "lamp, its centre seen", gltf_write(w, "whitted-lamp"), NULL, 10, 0,
              blocker == 1 ? 0 : lit);
        free(w);
    }
    /* Seen in a mirror, a lamp shows its radiance and does not count as a light. */
    gltf_writer *w = gltf_new();
    gltf_quad(w, material(w, 0.6, 1, 0, ""), (double[3]){-5, 0, 5}, (double[3]){10, 0, 0}, (double[3]){0, 0, -10});
    gltf_quad(w, gltf_lambert(w, 0, 3), (double[3]){-1, 2, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
    gltf_camera(w, (double[3]){0, 1, 0}, (double[3]){0, 0, 0}, 1e-5);
    check("lamp in a mirror", gltf_write(w, "whitted-lamp-mirror"), NULL, 10, 0, 0.6 * 3);
    free(w);
}

/* An octahedron of radius r shines as a point of intensity Le A / 4 with A = 4 sqrt(3) r^2, and does not light itself. */
static void bodies_shine_as_points(void)
{
    gltf_writer *w = floor_of(1, MATT);
    int lamp = gltf_lambert(w, 0, 100);
    const float r = 0.05f;
    float p[72];
    for (int i = 0, n = 0; i < 8; i++) {
        float x[3] = {i & 1 ? r : -r, 2, 0}, y[3] = {0, i & 2 ? 2 + r : 2 - r, 0}, z[3] = {0, 2, i & 4 ? r : -r};
        int odd = !(i & 1) ^ !(i & 2) ^ !(i & 4);
        const float *corner[3] = {x, odd ? z : y, odd ? y : z};
        for (int c = 0; c < 3; c++) memcpy(p + 3 * n++, corner[c], sizeof x);
    }
    gltf_triangles(w, lamp, &(gltf_mesh){.count = 24, .positions = p});
    check("octahedral lamp", gltf_write(w, "whitted-octahedron"), NULL, 10, 0, 0.6 / PI * 100 * sqrt(3) * 0.05 * 0.05 / 4);
    free(w);
}

/* Roughness 0.5: n = 2 / 0.5^4 - 2 = 30. The light is at the mirror image of the eye, tilted by 10 degrees. */
static void highlights_are_blinns(void)
{
    gltf_writer *w = floor_of(0.5, "");
    double angle = 35 * PI / 180, d = 2, o[3] = {0, sqrt(0.5), sqrt(0.5)}, l[3] = {0, cos(angle), -sin(angle)}, h[3], length = 0;
    gltf_light(w, (double[3]){0, d * l[1], d * l[2]}, (double[3]){0, -1, 0}, "{\"type\":\"point\",\"intensity\":7}");
    for (int k = 0; k < 3; k++) h[k] = o[k] + l[k], length += h[k] * h[k];
    double oh = sqrt(length) / 2, F = 0.04 + 0.96 * pow(1 - oh, 5), nh = h[1] / sqrt(length);
    double f = (1 - F) * 0.6 / PI + F * (30 + 8) / (8 * PI) * pow(nh, 30);
    check("highlight", gltf_write(w, "whitted-highlight"), NULL, 10, 0, f * l[1] * 7 / (d * d));
    free(w);
}

/* Seen head-on through water without sides, which absorbs half of the light that it lets in (0.96). The light enters beside it, without a
 * loss. */
static void far_lights_are_not_absorbed(void)
{
    const double h = 0.2, angle = PI / 4;
    gltf_writer *w = gltf_new();
    gltf_quad(w, material(w, 0.6, 0, 1, MATT), (double[3]){-5, 0, 5}, (double[3]){10, 0, 0}, (double[3]){0, 0, -10});
    gltf_quad(w, material(w, 1, 0, 0, PASSES ",\"KHR_materials_volume\":{\"thicknessFactor\":1,\"attenuationDistance\":0.2,"
                                             "\"attenuationColor\":[0.5,0.5,0.5]}"),
              (double[3]){-0.1, h, 0.1}, (double[3]){0.2, 0, 0}, (double[3]){0, 0, -0.2});
    gltf_light(w, (double[3]){0, 0, 0}, (double[3]){-sin(angle), -cos(angle), 0}, "{\"type\":\"directional\",\"intensity\":3}");
    gltf_camera(w, (double[3]){0, 1, 0}, (double[3]){0, 0, 0}, 1e-5);
    check("floor under water, far light", gltf_write(w, "whitted-water"), NULL, 10, 0, 0.96 * 0.5 * 0.6 / PI * 3 * cos(angle));
    free(w);
}

/* The host empties the shadow queues' counters after every EC_SEGMENT lights. Light k has the intensity k + 1. */
static void each_of_many_lights_shines(uint32_t count)
{
    gltf_writer *w = floor_of(1, MATT);
    for (uint32_t k = 0; k < count; k++) {
        char light[64];
        snprintf(light, sizeof light, "{\"type\":\"point\",\"intensity\":%u}", k + 1);
        gltf_light(w, (double[3]){0, 2, 0}, (double[3]){0, -1, 0}, light);
    }
    check("many lights", gltf_write(w, "whitted-lights"), NULL, 10, 0, 0.6 / PI * count * (count + 1) / 2 / 4);
    free(w);
}

static void the_environment_is_ambient_light(void)
{
    gltf_writer *w = floor_of(1, MATT);
    box(w, gltf_lambert(w, 0, 0), -4, 4, 0.1, 0.2, -4, 0.05); /* casts no shadow on it */
    check("ambient light", gltf_write(w, "whitted-ambient"), "2,2,2", 10, 0, 1.2);
    free(w);
}

/* Bits do not depend on how the work is divided, for glass, mirrors and lamps. */
static void pictures_have_the_same_bits(void)
{
    gltf_writer *w = floor_of(0.05, "");
    int glass = material(w, 1, 0, 0, GLASS);
    for (int i = 0; i < 3; i++) box(w, glass, i - 1.4, i - 0.6, 0.1, 0.9, -1.2, -0.6 + 0.1 * i);
    gltf_quad(w, gltf_lambert(w, 0, 3), (double[3]){-1, 2, -1}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
    gltf_camera(w, (double[3]){0.5, 1, 2}, (double[3]){0, 0.3, 0}, 1);
    ec_scene *scene = case_load(gltf_write(w, "whitted-bits"), "0.2,0.3,0.4");
    static const uint32_t lanes[] = {0, 1, 4, 1, 1, 4}, waves[] = {0, 0, 3000, 0, 0, 700};
    static const char *const accels[] = {NULL, "bvh8", "grid", "kdtree", "none", NULL};
    case_image first;
    for (int i = 0; i < 6; i++) {
        ec_render_options o = case_options(48, 32, 4);
        o.integrator = EC_INTEGRATOR_WHITTED;
        o.camera = 1;
        o.lanes = lanes[i];
        o.wave = waves[i];
        o.accel = accels[i];
        if (i == 5) o = case_with_all_effects(o);
        case_image image = case_render(scene, &o);
        if (i) {
            CHECK_MSG(!memcmp(image.rgb, first.rgb, 3 * 48 * 32 * sizeof(float)), "LANES %u, wave %u, %s: other bits", lanes[i], waves[i], accels[i]);
            case_free(&image);
        } else {
            first = image;
        }
    }
    CHECK(first.mean[1] > 0.05 && first.stats.rays > 3 * first.stats.samples);
    case_free(&first);
    ec_scene_free(scene);
    free(w);
}

int main(void)
{
    if (test_tier("quick")) {
        mirrors_reflect_by_fresnel();
        lamps_shine_from_their_centres();
        each_of_many_lights_shines(2 * EC_SEGMENT + 3);
    }
    if (!test_tier("full")) TEST_END();
    slabs_share_light_out();
    trees_are_whole();
    total_reflection_loses_nothing();
    bodies_shine_as_points();
    highlights_are_blinns();
    far_lights_are_not_absorbed();
    each_of_many_lights_shines(EC_SEGMENT);
    the_environment_is_ambient_light();
    pictures_have_the_same_bits();
    TEST_END();
}
