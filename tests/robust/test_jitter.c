/* tiers: quick, full */
/* Coordinates are known to an ulp at best, so a picture must not depend on one. All vertices, lights and cameras are moved by one ulp at
 * random. The picture must be the same within noise, and with the same random numbers much closer. An epsilon in metres, a hash of a
 * position's bits or a cancellation would fail here.
 *
 * With the same seed, a path stays the same unless the move sends it another way; from there on it is another path. If a share p of the
 * variance is in such paths, the two pictures differ by sqrt(p) times the difference of two seeds. So p is the square of that ratio.
 *
 * Several effects of an ulp are legitimate. An edge moves by 10^-7 of the picture's height, and each of a path's ten or so segments passes
 * tens of edges: 10^-5. A curved mirror magnifies a change of direction by twice the distance over its radius, so that paths with ten
 * bounces between such mirrors change completely. v3_frame turns where a normal's z changes its sign, which the walls of a box do (one of
 * the Cornell box's: p = 0.003). The limit of 0.05 allows for these, and detects a move of a thousandth: there p = 0.2 to 1, as the last
 * line of main shows. */
#include "support/gltf_writer.h"
#include "support/random.h"
#include "support/render_case.h"

enum { WIDTH = 48, HEIGHT = 36, SAMPLES = 64 };
#define MOST 0.05

/* Moves a coordinate one ulp up or down, measured at its value in the file: loading subtracted the centre. */
static void move(float *x, double center, double ulps, test_random *random)
{
    float file = fabsf((float)(*x + center));
    double ulp = (double)nextafterf(file, INFINITY) - file;
    *x = (float)(*x + (test_uniform(random) < 0.5 ? -ulps : ulps) * ulp);
}

static void jitter(ec_scene *scene, double ulps)
{
    test_random random = {11};
    for (uint32_t i = 0; i < 3 * scene->vertex_count; i++) {
        float *x = &scene->positions[i];
        uint32_t k = i % 3;
        move(x, scene->center[k], ulps, &random);
        scene->bounds_min[k] = fminf(scene->bounds_min[k], *x);
        scene->bounds_max[k] = fmaxf(scene->bounds_max[k], *x);
    }
    for (uint32_t i = 0; i < 3 * scene->light_count; i++) move(&scene->lights[i / 3].position[i % 3], scene->center[i % 3], ulps, &random);
    for (uint32_t i = 0; i < 3 * scene->camera_count; i++) move(&scene->cameras[i / 3].position[i % 3], scene->center[i % 3], ulps, &random);
}

static ec_render_options options(uint64_t seed)
{
    ec_render_options o = case_options(WIDTH, HEIGHT, SAMPLES);
    o.seed = (uint32_t)seed;
    o.light_choice = EC_LIGHTS_BY_POWER; /* with lamps as uniform as balls, an ulp may change the light tree: p = 0.09 in veach-mis */
    return o;
}

static double square_difference(const case_image *a, const case_image *b, uint32_t *changed)
{
    double sum = 0;
    *changed = 0;
    for (uint32_t pixel = 0; pixel < WIDTH * HEIGHT; pixel++) {
        bool other = false;
        for (uint32_t i = 3 * pixel; i < 3 * pixel + 3; i++) {
            double d = (double)a->rgb[i] - b->rgb[i];
            sum += d * d;
            other |= fabs(d) > 1e-4 * fabs((double)a->rgb[i]);
        }
        *changed += other;
    }
    return sum;
}

/* Three renders: the scene as it is; moved; moved, with another seed. */
typedef struct pictures {
    case_image still, moved, other;
    double p;
} pictures;

static pictures render_three(const char *name, ec_scene *scene, double ulps)
{
    ec_render_options o = options(1), other_seed = options(2);
    pictures all;
    uint32_t changed, by_seed;
    all.still = case_render(scene, &o);
    jitter(scene, ulps);
    all.moved = case_render(scene, &o);
    all.other = case_render(scene, &other_seed);
    all.p = square_difference(&all.still, &all.moved, &changed) / square_difference(&all.still, &all.other, &by_seed);
    printf("%s, %g ulps: p = %.1e, pixels changed by more than 10^-4: %u of %u, by another seed %u\n", name, ulps, all.p, changed,
           WIDTH * HEIGHT, by_seed);
    return all;
}

static void free_three(pictures *all, ec_scene *scene)
{
    case_free(&all->still);
    case_free(&all->moved);
    case_free(&all->other);
    ec_scene_free(scene);
}

static void check(const char *name, ec_scene *scene, bool all_lanes)
{
    pictures all = render_three(name, scene, 1);
    CHECK_MSG(all.p <= MOST, "%s: an ulp sent %.2g of the paths another way", name, all.p);
    case_check_same(&all.still, &all.other, 4, name);
    for (uint32_t lanes = 1; all_lanes && lanes <= 16; lanes = lanes == 1 ? 4 : 2 * lanes) {
        ec_render_options o = options(1);
        o.lanes = lanes;
        case_image wide = case_render(scene, &o);
        CHECK_MSG(case_same_bits(&wide.film, &all.moved.film), "%s: lanes %u: other bits", name, lanes);
        case_free(&wide);
    }
    free_three(&all, scene);
}

/* Checks that a move larger than rounding is detected. */
static void check_seen(const char *name, ec_scene *scene)
{
    pictures all = render_three(name, scene, 0x1p14);
    CHECK_MSG(all.p > MOST, "%s: a move of a thousandth is not seen", name);
    free_three(&all, scene);
}

/* A room of 10 m, a kilometre from the origin in the vertices themselves: its coordinates are known to 0.06 mm. */
static ec_scene *far_room(void)
{
    gltf_writer *w = gltf_new();
    int grey = gltf_lambert(w, 0.6, 0), lamp = gltf_lambert(w, 0, 8);
    double at[3] = {1000, -700, 1200}, hi[3] = {1010, -690, 1210};
    gltf_quad(w, grey, (double[3]){at[0], at[1], hi[2]}, (double[3]){10, 0, 0}, (double[3]){0, 0, -10}); /* floor */
    gltf_quad(w, grey, (double[3]){at[0], hi[1], at[2]}, (double[3]){10, 0, 0}, (double[3]){0, 0, 10});
    gltf_quad(w, grey, at, (double[3]){10, 0, 0}, (double[3]){0, 10, 0});
    gltf_quad(w, grey, (double[3]){at[0], at[1], hi[2]}, (double[3]){0, 0, -10}, (double[3]){0, 10, 0});
    gltf_quad(w, grey, (double[3]){hi[0], at[1], at[2]}, (double[3]){0, 0, 10}, (double[3]){0, 10, 0});
    gltf_quad(w, lamp, (double[3]){at[0] + 4, hi[1] - 0.01, at[2] + 4}, (double[3]){2, 0, 0}, (double[3]){0, 0, 2});
    gltf_box(w, grey, (double[3]){at[0] + 2, at[1], at[2] + 2}, (double[3]){at[0] + 5, at[1] + 6, at[2] + 5});
    gltf_camera(w, (double[3]){at[0] + 5, at[1] + 5, hi[2] + 8}, (double[3]){at[0] + 5, at[1] + 5, at[2]}, 0.9);
    ec_scene *scene = case_load(gltf_write(w, "far-room"), NULL);
    free(w);
    return scene;
}

int main(void)
{
    static const char shared[] = SHARED("assets/classic/gltf/veach-mis/veach-mis.gltf");
    if (test_tier("quick")) check("cornell-box", case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL), true);
    if (!test_tier("full")) TEST_END();
    check("glass", case_load(OWN_SCENE("glass/glass.gltf"), NULL), false);
    check("veach-plates", case_load(OWN_SCENE("veach-plates/veach-plates.gltf"), NULL), false);
    check("ladder", case_load(OWN_SCENE("ladder/ladder.gltf"), NULL), false);
    check("far room", far_room(), false);
    if (case_present(shared)) check("veach-mis", case_load(shared, NULL), false);
    check_seen("cornell-box", case_load(OWN_SCENE("cornell-box/cornell-box.gltf"), NULL));
    TEST_END();
}
