/* tiers: quick, full */
/* Lamps chosen by the light tree give the same picture as lamps chosen by power, for every way to find them, with less noise. */
#include "support/lantern_hall.h"

static ec_render_options options(ec_light_choice choice, ec_sample sample, uint32_t spp, uint64_t seed)
{
    ec_render_options o = case_options(32, 32, spp);
    o.max_depth = 4;
    o.light_choice = choice;
    o.sample = sample;
    o.seed = seed;
    return o;
}

/* Inside a box whose walls emit 1 and reflect half of the light: 1 / (1 - 0.5) in every direction. Each wall has 5 x 5 lamps, so large that
 * most are found both ways: weights that do not add up would show. */
static void check_furnace(void)
{
    ec_error err = {0};
    ec_scene *scene;
    ec_model *m = ec_model_new();
    ec_material emitting = ec_material_lambert(0.5, 1);
    int32_t wall = ec_model_material(m, &emitting);
    for (int i = 0; i < 6 * 25; i++) {
        int axis = i / 50, a = (axis + 1) % 3, b = (axis + 2) % 3, low = i / 25 % 2 == 0;
        double at[3], u[3] = {0}, v[3] = {0};
        at[axis] = low ? -1 : 1, at[a] = -1 + 0.4 * (i % 5), at[b] = -1 + 0.4 * (i / 5 % 5);
        u[a] = v[b] = 0.4;
        ec_model_quad(m, wall, at, low ? u : v, low ? v : u);
    }
    ec_model_camera(m, EC_CAMERA_PERSPECTIVE, (double[3]){0.3, 0.2, 0.1}, (double[3]){-1, -0.4, -0.7}, 0.9);
    if (ec_model_scene(m, &scene, &err) != EC_OK) case_end("furnace", &err);
    for (int s = EC_SAMPLE_MIS; s <= EC_SAMPLE_BSDF; s++) {
        ec_render_options o = options(EC_LIGHTS_BY_TREE, (ec_sample)s, 256, 5);
        o.max_depth = 0;
        case_image image = case_render(scene, &o);
        CASE_NEAR(&image, 2, 4.5, 1e-3);
        printf("furnace, sample %d: %.6f +- %.6f\n", s, image.mean[1], image.mean_se[1]);
        case_free(&image);
    }
    ec_scene_free(scene);
}

int main(void)
{
    if (test_tier("quick")) check_furnace();
    if (!test_tier("full")) TEST_END();
    ec_scene *scene = lantern_hall(4, 12);
    ec_render_options o = options(EC_LIGHTS_BY_POWER, EC_SAMPLE_MIS, 1024, 1);
    case_image power = case_render(scene, &o);
    o = options(EC_LIGHTS_BY_TREE, EC_SAMPLE_MIS, 1024, 2);
    case_image tree = case_render(scene, &o);
    CHECK(strstr(case_effects(&tree), "light-tree") && !strstr(case_effects(&power), "light-tree"));
    printf("relMSE by power %.3g in %.2f s, by the tree %.3g in %.2f s\n", power.stats.film.relmse, power.stats.seconds, tree.stats.film.relmse, tree.stats.seconds);
    case_check_same(&tree, &power, 4, "tree, mis, against power");
    CHECK_MSG(tree.stats.film.relmse < 0.5 * power.stats.film.relmse, "relMSE %g by the tree, %g by power", tree.stats.film.relmse, power.stats.film.relmse);
    o = options(EC_LIGHTS_BY_TREE, EC_SAMPLE_LIGHT, 1024, 3);
    case_image light = case_render(scene, &o);
    case_check_same(&light, &tree, 4, "tree, light, against tree, mis");
    case_free(&light);
    case_free(&power);
    case_free(&tree);
    ec_scene_free(scene);
    TEST_END();
}
