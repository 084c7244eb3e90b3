/* tiers: quick, full */
/* Predictions of rare paths: against closed forms where a flat mirror shows a small light, and against long renders where a mirror reflects
 * it onto a floor. */
#include "rare/paths.h"
#include "render/session.h"
#include "support/gltf_writer.h"
#include "support/render_case.h"

#define PI 3.14159265358979323846

enum { WIDTH = 256, HEIGHT = 128 };

/* A map of radiance `dark` with one texel of `bright`. */
static void set_map(ec_scene *scene, int width, int height, int x, int y, float dark, float bright)
{
    ec_environment *e = &scene->environment;
    free(e->rgb);
    *e = (ec_environment){.width = (uint32_t)width, .height = (uint32_t)height, .rgb = malloc(12ull * (size_t)(width * height))};
    if (!e->rgb) exit(1);
    for (int i = 0; i < 3 * width * height; i++) e->rgb[i] = i / 3 == y * width + x ? bright : dark;
    scene->has_environment = true;
}

static double solid_angle(int width, int height, int y) { return 2 * PI / width * PI / height * sin(PI * (y + 0.5) / height); }

/* A camera looks straight down at a plane that fills its view, `half` radians to each side. */
static ec_scene *load_plane(double metallic, double half)
{
    gltf_writer *w = gltf_new();
    const int plane = gltf_add(&w->materials, "{\"name\":\"plane\",\"pbrMetallicRoughness\":{\"metallicFactor\":%g,\"roughnessFactor\":%g},"
                                              "\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}}", metallic, metallic > 0 ? 0.0 : 1.0);
    gltf_quad(w, plane, (double[3]){-9, 0, 9}, (double[3]){18, 0, 0}, (double[3]){0, 0, -18});
    gltf_camera(w, (double[3]){0, 3, 0}, (double[3]){0, 0, 0}, 2 * half);
    ec_scene *scene = case_load(gltf_write(w, "rare-plane"), "1,1,1");
    free(w);
    return scene;
}

static ec_rare predict(const ec_scene *scene, const ec_render_options *options)
{
    ec_error err = {0};
    ec_render_stats stats;
    ec_session *session = NULL;
    ec_rare rare;
    if (ec_session_open(case_cl(), scene, options, 1, &session, &stats, &err) != EC_OK) case_end("set-up", &err);
    if (ec_session_predict(session, &rare, &err) != EC_OK) case_end("chains", &err);
    ec_session_close(session);
    return rare;
}

/* The light of all kinds, and the probability of the kind with most light. */
static double light_of(const ec_rare *rare, double *chance, const char *name)
{
    double sum = 0, most = 0;
    *chance = 0;
    for (uint32_t i = 0; i < rare->count; i++) {
        const ec_rare_kind *kind = &rare->kinds[i];
        printf("  through \"%s\" to %s: chance %.3g, luminance %.4g, gathered %.3g\n", kind->through, kind->light, kind->chance, kind->luminance, kind->gathered);
        sum += kind->luminance;
        if (kind->luminance > most) most = kind->luminance, *chance = kind->chance;
        CHECK_MSG(!strcmp(kind->through, name), "through \"%s\", not \"%s\"", kind->through, name);
    }
    return sum;
}

/* The texel is at this angle from the zenith. */
static void check_plane(const char *what, double metallic, double angle, bool is_seen)
{
    const double half = 0.4;
    ec_scene *scene = load_plane(metallic, half);
    const int y = (int)(angle / PI * HEIGHT);
    const float bright = 1e6f;
    set_map(scene, WIDTH, HEIGHT, 40, y, 1, bright);
    const ec_render_options o = case_options(40, 40, 16);
    const ec_rare rare = predict(scene, &o);
    const double theta = PI * (y + 0.5) / HEIGHT, omega = solid_angle(WIDTH, HEIGHT, y);
    const double expected = omega / (4 * tan(half) * tan(half) * pow(cos(theta), 3)); /* share of the camera's directions, by the picture's area */
    double chance;
    printf("%s, %.3g rad from the zenith:\n", what, theta);
    const double light = light_of(&rare, &chance, "plane");
    if (is_seen) {
        printf("  chance %.3g, closed form %.3g\n", chance, expected);
        CHECK_MSG(chance > 0.6 * expected && chance < 1.6 * expected, "chance %g, closed form %g", chance, expected);
        CHECK_MSG(light > 0.6 * expected * bright && light < 1.6 * expected * bright, "light %g, closed form %g", light, expected * bright);
    } else {
        CHECK_MSG(light < 0.02 * omega * bright, "light %g of paths that cannot be", light);
    }
    ec_scene_free(scene);
}

static double light_above(ec_scene *scene)
{
    const ec_render_options o = case_options(40, 40, 16);
    const ec_rare rare = predict(scene, &o);
    double chance;
    return light_of(&rare, &chance, "plane");
}

/* The mirror's square view extends farther into its corners: a texel beyond an edge becomes visible when the map is turned by 45 degrees. */
static void check_turned(void)
{
    ec_scene *scene = load_plane(1, 0.4);
    set_map(scene, WIDTH, HEIGHT, WIDTH / 2, (int)(0.48 / PI * HEIGHT), 1, 1e6f); /* towards +x */
    const double before = light_above(scene);
    ec_scene_adjust_environment(scene, 45, 1, NULL);
    const double turned = light_above(scene);
    printf("  beyond an edge %.3g, in a corner %.3g\n", before, turned);
    CHECK(before < 0.02 * turned && turned > 10);
    ec_scene_free(scene);
}

/* Two suns of one radiance stay separate: the mirror shows one, and nothing of the other. */
static void check_two_suns(void)
{
    ec_scene *scene = load_plane(1, 0.4);
    const int y = (int)(0.2 / PI * HEIGHT);
    set_map(scene, WIDTH, HEIGHT, 40, y, 1, 1e6f);
    const double one = light_above(scene);
    scene->environment.rgb[3 * (100 * WIDTH + 190)] = scene->environment.rgb[3 * (100 * WIDTH + 190) + 1] = 1e6f;
    scene->environment.rgb[3 * (100 * WIDTH + 190) + 2] = 1e6f; /* below the horizon */
    const double two = light_above(scene);
    CHECK_MSG(fabs(two - one) < 0.02 * one, "light %g with one sun, %g with another one out of sight", one, two);
    ec_scene_free(scene);
}

/* Dropped samples are counted in the render only: predicting does not change the counts. */
static void check_invalid_counts(void)
{
    const uint32_t wanted[EC_STAGE_COUNT] = {1, 2, 3, 4, 5};
    uint32_t found[EC_STAGE_COUNT];
    ec_scene *scene = load_plane(1, 0.4);
    ec_render_options o = case_options(40, 40, 16);
    ec_error err = {0};
    ec_render_stats stats = {0};
    ec_payload payload;
    ec_pipeline p = {0};
    ec_rare_lights lights = {0};
    ec_rare rare;
    set_map(scene, WIDTH, HEIGHT, 40, 8, 1, 1e6f);
    CHECK_OK(ec_payload_make(scene, &o, 1, 1u << ec_device_kind_of(&case_cl()->info), NULL, &payload, &stats, &err), err);
    CHECK_OK(ec_rare_lights_find(&payload.pack, &lights, &err), err);
    CHECK_OK(ec_pipeline_create(case_cl(), &payload, NULL, &p, &stats, &err), err);
    CHECK_OK(ec_buffer_write(p.cl, p.buffers[EC_ARG_INVALID], 0, sizeof wanted, wanted, &err), err);
    CHECK_OK(ec_rare_paths_predict(&lights, &p, &rare, NULL, &err), err);
    CHECK_OK(ec_pipeline_read_invalid(&p, found, &err), err);
    CHECK(rare.count > 0 && !memcmp(found, wanted, sizeof found));
    ec_pipeline_destroy(&p);
    ec_rare_lights_free(&lights);
    ec_payload_free(&payload);
    ec_scene_free(scene);
}

/* A wall beside a matt floor, in the light of a patch of sky that neither hides. */
static double floor_light(double wall, const char *name, ec_rare *rare)
{
    gltf_writer *w = gltf_new();
    const int grey = gltf_lambert(w, 0.5, 0);
    const int mirror = gltf_add(&w->materials, "{\"name\":\"mirror\",\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":"
                                               "[%g,%g,%g,1],\"metallicFactor\":1,\"roughnessFactor\":0}}", wall, wall, wall);
    gltf_quad(w, grey, (double[3]){-2, 0, 2}, (double[3]){4, 0, 0}, (double[3]){0, 0, -4});
    gltf_quad(w, mirror, (double[3]){0, 0, -2}, (double[3]){0, 0, 4}, (double[3]){0, 3, 0});
    gltf_camera(w, (double[3]){-1, 6, 0}, (double[3]){-1, 0, 0}, 0.25);
    ec_scene *scene = case_load(gltf_write(w, name), "1,1,1");
    free(w);
    set_map(scene, 64, 32, 2, 10, 0, 1000); /* light comes from -x, which the mirror faces */
    ec_render_options o = case_options(16, 16, 16384);
    o.max_depth = 3;
    *rare = predict(scene, &o);
    case_image image = case_render(scene, &o);
    const double mean = image.mean[1];
    case_free(&image);
    ec_scene_free(scene);
    return mean;
}

/* A mirror reflects light onto the floor: the predicted light is the difference that the mirror makes. */
static void check_floor(void)
{
    ec_rare rare, none;
    double chance;
    const double lit = floor_light(1, "rare-floor", &rare), dark = floor_light(0, "rare-floor-black", &none), expected = lit - dark;
    printf("a mirror beside a floor: %.4g with it, %.4g without\n", lit, dark);
    const double light = light_of(&rare, &chance, "mirror");
    CHECK_MSG(light > 0.6 * expected && light < 1.6 * expected, "light %g by way of the mirror, %g in a long render", light, expected);
}

/* A lamp in a glass bulb that is too small for the paths of the first look, in a room with a bright window, which those paths find. */
static void check_bulb(double size, bool is_glass)
{
    gltf_writer *w = gltf_new();
    const int grey = gltf_lambert(w, 0.5, 0), panel = gltf_lambert(w, 0, 1), filament = gltf_lambert(w, 0, 1 / (6 * size * size * 0.16));
    const int bulb = is_glass ? gltf_add_glass(w, &(gltf_glass){.base = 1, .transmission = 1, .ior = 1.5}) : grey;
    for (int k = 0; k < 3; k++) { /* walls that face inwards */
        const double u[3] = {4 * (k == 1), 4 * (k == 2), 4 * (k == 0)}, v[3] = {4 * (k == 2), 4 * (k == 0), 4 * (k == 1)};
        const double at[3] = {-2, -2, -2}, far[3] = {-2 + 4 * (k == 0), -2 + 4 * (k == 1), -2 + 4 * (k == 2)};
        gltf_quad(w, grey, at, u, v);
        gltf_quad(w, grey, far, v, u);
    }
    gltf_quad(w, panel, (double[3]){-0.5, 1.99, -0.5}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1});
    gltf_box(w, filament, (double[3]){-0.2 * size, -0.2 * size, -0.2 * size}, (double[3]){0.2 * size, 0.2 * size, 0.2 * size});
    if (is_glass) gltf_box(w, bulb, (double[3]){-size, -size, -size}, (double[3]){size, size, size});
    gltf_camera(w, (double[3]){1, 0, 1.9}, (double[3]){1.5, -1, -2}, 0.6);
    ec_scene *scene = case_load(gltf_write(w, "rare-bulb"), NULL);
    free(w);
    const ec_render_options o = case_options(16, 16, 16);
    const ec_rare rare = predict(scene, &o);
    bool is_blind = false;
    for (uint32_t i = 0; i < rare.count; i++) is_blind |= rare.kinds[i].is_relative;
    printf("a bulb of %g m%s: %u kinds%s\n", 2 * size, is_glass ? "" : " without glass", rare.count, is_blind ? ", nobody has come near its light" : "");
    CHECK(is_blind == is_glass);
    ec_scene_free(scene);
}

/* Light of a sun of one texel reflected by a chrome cube that only a few of the first look's paths meet. The cube stands on a floor, beside
 * a wall, if there is one, at +x or -x. eye: the camera's position; row, column: the texel. */
static double small_mirror_light(const char *what, int wall, const double eye[3], int column, int row)
{
    gltf_writer *w = gltf_new();
    const int grey = gltf_lambert(w, 0.5, 0);
    const int chrome = gltf_add(&w->materials, "{\"name\":\"chrome\",\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0}}");
    gltf_quad(w, grey, (double[3]){-2, 0, 2}, (double[3]){4, 0, 0}, (double[3]){0, 0, -4});
    if (wall) gltf_box(w, grey, (double[3]){wall > 0 ? 2 : -2.1, 0, -20}, (double[3]){wall > 0 ? 2.1 : -2, 20, 20});
    gltf_box(w, chrome, (double[3]){-0.03, 0.5, -0.03}, (double[3]){0.03, 0.56, 0.03});
    gltf_camera(w, eye, (double[3]){0, 0.3, 0}, 0.8);
    ec_scene *scene = case_load(gltf_write(w, "rare-mirror"), "1,1,1");
    free(w);
    set_map(scene, 64, 32, column, row, 1, 1e5f);
    const ec_render_options o = case_options(64, 64, 16);
    const ec_rare rare = predict(scene, &o);
    printf("a small chrome cube, the sun %s:\n", what);
    double chance;
    const double light = light_of(&rare, &chance, "chrome");
    ec_scene_free(scene);
    return light;
}

/* If the sun is visible from the cube, its light may be missing, also by a side that the first look's paths do not meet. Behind a wall it
 * may not. */
static void check_small_mirror(void)
{
    const double beside[3] = {-1.5, 1.5, 1.5}, across[3] = {1.5, 1, 0};
    const double seen = small_mirror_light("in sight", 0, beside, 32, 12); /* towards +x, 0.35 rad above the horizon */
    const double hidden = small_mirror_light("behind a wall", 1, beside, 32, 12);
    const double own = small_mirror_light("behind the cube itself", 0, across, 0, 12); /* towards -x */
    const double both = small_mirror_light("behind the cube and a wall", -1, across, 0, 12);
    CHECK_MSG(seen > 0.01 && hidden == 0 && own > 0 && both == 0, "light %g, %g, %g, %g", seen, hidden, own, both);
}

/* Most of this map's light has no main direction, so no ray can be aimed at it. Rays without a direction once ended the program. */
static void check_all_around(void)
{
    static const char model[] = SHARED("assets/gltf/MetalRoughSpheresNoTextures/glTF-Binary/MetalRoughSpheresNoTextures.glb"),
                      map[] = SHARED("assets/env/pmndrs-assets/studio.hdr");
    if (!case_present(model) || !case_present(map)) return;
    ec_scene *scene = case_load(model, map);
    const ec_render_options o = case_options(32, 32, 16);
    const ec_rare rare = predict(scene, &o);
    printf("spheres of few millimetres under studio.hdr: %u kinds\n", rare.count);
    CHECK(rare.count > 0);
    ec_scene_free(scene);
}

/* The brightest tile is 255 of 255 however its quotient is rounded: in this picture it was 256, which a byte stores as 0. */
static void check_tiles(void)
{
    ec_scene *scene = case_load(OWN_SCENE("lamps/lamps.gltf"), NULL);
    const ec_render_options o = case_options(61, 30, 16);
    const ec_rare rare = predict(scene, &o);
    CHECK(rare.count > 0);
    for (uint32_t i = 0; i < rare.count; i++) {
        uint32_t sum = 0, most = 0;
        for (int t = 0; t < EC_RARE_SHARES; t++) {
            sum += rare.kinds[i].share[t];
            if (rare.kinds[i].share[t] > most) most = rare.kinds[i].share[t];
        }
        CHECK_MSG(most == 255, "kind %u: the brightest tile has %u", i, most);
        CHECK_NEAR(rare.kinds[i].peak * sum, 255.0 * EC_RARE_SHARES, 1e-6);
    }
    ec_scene_free(scene);
}

int main(void)
{
    if (test_tier("quick")) {
        check_tiles();
        check_plane("a mirror that shows the light", 1, 0.2, true);
    }
    if (!test_tier("full")) TEST_END();
    check_all_around();
    check_bulb(0.002, true);
    check_bulb(0.002, false);
    check_small_mirror();
    check_plane("a mirror that does not", 1, 0.6, false);
    check_plane("a matt plane", 0, 0.2, false);
    check_turned();
    check_two_suns();
    check_invalid_counts();
    check_floor();
    TEST_END();
}
