/* The picture is a function of scene, seed and options, not of how it was computed: LANES, acceleration structure, density of its
 * grid, wave size, effects built in, and the time of day change no bit of any number in the film. (Threads: tests/cli/test_render.py.) */
#include "accel/accel.h"
#include "support/render_case.h"

enum { WIDTH = 48, HEIGHT = 36 };

static ec_render_options base_options(void)
{
    ec_render_options o = case_options(WIDTH, HEIGHT, 8);
    o.batch = 4;
    o.seed = 5;
    return o;
}

static void check_one(const ec_scene *scene, const case_image *expected, const ec_render_options *o, const char *what)
{
    case_image image = case_render(scene, o);
    CHECK_MSG(case_same_bits(&image.film, &expected->film), "%s: lanes %u, %s, %g cells a reference, wave %u, all effects %d: other bits",
              what, o->lanes, o->accel ? o->accel : "auto", (double)o->grid_density, o->wave, o->all_effects);
    case_free(&image);
}

/* exhaustive: each accelerator other than packets with 8 lanes and one more width; else each with one width of its own. */
static void check_scene(const char *what, const ec_scene *scene, bool exhaustive)
{
    static const uint32_t lanes[] = {1, 4, 8, 16}, waves[] = {512, 4096, 5000};
    static const float densities[] = {0.01f, 1.0f, 300.0f, 10000.0f};
    ec_render_options o = base_options();
    case_image expected = case_render(scene, &o);
    CHECK(expected.mean[0] > 0);
    check_one(scene, &expected, &o, what); /* twice in a row */
    for (int l = 0; l < 4; l++)
        for (int a = 0; a < EC_ACCEL_COUNT; a++) {
            const bool own_width = a % 4 == l, packets = !ec_accels[a].lanes;
            if (!packets && !own_width && !(exhaustive && lanes[l] == 8)) continue;
            o = base_options();
            o.lanes = lanes[l];
            o.accel = ec_accels[a].name;
            check_one(scene, &expected, &o, what);
        }
    for (int i = 0; i < 4 && exhaustive; i++) {
        o = base_options();
        o.accel = "grid";
        o.grid_density = densities[i];
        check_one(scene, &expected, &o, what);
    }
    for (int i = 0; i < 3; i++) {
        o = base_options();
        o.wave = waves[i];
        check_one(scene, &expected, &o, what);
    }
    o = base_options();
    o = case_with_all_effects(o);
    check_one(scene, &expected, &o, what);
    o = base_options();
    o.seed = 6; /* and the comparison can see a difference */
    case_image other = case_render(scene, &o);
    CHECK(!case_same_bits(&other.film, &expected.film));
    printf("%s: %s\n", what, case_effects(&expected));
    case_free(&other);
    case_free(&expected);
}

int main(void)
{
    ec_scene *scene = case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL);
    check_scene("cornell-box", scene, true);
    ec_scene_free(scene);
    scene = case_load(OWN_SCENE("lamps/lamps.gltf"), "0.1,0.2,0.3"); /* every effect of core glTF */
    check_scene("lamps", scene, false);
    ec_scene_free(scene);
    scene = case_load(OWN_SCENE("drink/drink.gltf"), NULL); /* bodies in bodies, rough ones, a pane */
    check_scene("drink", scene, false);
    ec_scene_free(scene);
    TEST_END();
}
