/* tier: long */
/* For every model under shared/assets/gltf, the kernels for its effects and those for all effects give the same bits. */
#define _XOPEN_SOURCE 700 /* nftw */
#include "support/light.h"
#include "support/models.h"
#include "support/render_case.h"
#include "gltf/reader.h"

int main(void)
{
    static const char folder[] = SHARED("assets/gltf");
    uint64_t called = 0;
    int compared = 0;
    if (!case_present(folder) || !models_collect(folder)) TEST_SKIP("no %s", folder);
    case_cl()->keeps_programs = true; /* models with the same effects share kernels */
    for (int i = 0; i < model_count; i++) {
        ec_error err = {0};
        ec_scene *scene;
        if (ec_scene_load(models[i], &scene, NULL, &err) != EC_OK) continue; /* test_models.c checks that */
        if (!has_light(scene)) CHECK_OK(ec_scene_set_environment(scene, "1,1,1", NULL, &err), err);
        ec_render_options o = case_options(24, 24, 2);
        o.camera = scene->default_camera;
        o.max_depth = 6;
        o.lanes = 1; /* compiles quickest */
        o.accel = "bvh8";
        case_image special = case_render(scene, &o);
        o = case_with_all_effects(o);
        case_image full = case_render(scene, &o);
        CHECK_MSG(case_same_bits(&special.film, &full.film), "%s: other bits than with every effect; it calls for %s", models[i],
                  case_effects(&special));
        called |= special.stats.effects.called.bits;
        compared++;
        case_free(&special);
        case_free(&full);
        ec_scene_free(scene);
    }
    char names[EC_EFFECT_NAMES];
    ec_feature_names(EC_FEATURE_ALL & ~called, names, sizeof names);
    printf("%d models; none calls for: %s\n", compared, names);
    CHECK(compared > 20);
    TEST_END();
}
