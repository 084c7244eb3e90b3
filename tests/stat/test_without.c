/* tier: full */
/* Leaves out every effect that --without can leave out, from a scene that needs it: the picture changes, and the scene no longer needs the
 * effect. One build with all effects renders the pictures; kernels built for the scene without an effect give the same bits
 * (test_effects_fuzz.c). */
#include "pack/pack.h"
#include "device/effects.h"
#include "support/effect_model.h"
#include "support/render_case.h"

/* Effects that also need this one, and so must go first: other reflections, and effects that contain coverage. */
static uint64_t with(uint64_t bit)
{
    const uint64_t over = EC_FEATURE_TRANSMISSION | EC_FEATURE_CLEARCOAT | EC_FEATURE_SHEEN | EC_FEATURE_IRIDESCENCE | EC_FEATURE_DIFFUSE_TRANSMISSION;
    return bit | (bit == EC_FEATURE_SPECULAR ? over : bit == EC_FEATURE_BASE_COLOR_TEXTURE ? EC_FEATURE_ALPHA : 0);
}

int main(void)
{
    ec_scene *scene = em_everything();
    ec_render_options o = case_with_all_effects(case_options(48, 48, 4));
    o.max_depth = 5;
    case_cl()->keeps_programs = true;
    case_image whole = case_render(scene, &o), again = case_render(scene, &o);
    CHECK(case_same_bits(&whole.film, &again.film));
    for (uint32_t i = 0; i < ec_feature_count; i++) {
        uint64_t bit = ec_features[i].bit;
        if (!(ec_effects_optional & bit)) continue;
        o.without = bit;
        case_image less = case_render(scene, &o);
        uint32_t changed = 0;
        for (uint32_t p = 0; p < 48 * 48; p++) changed += memcmp(whole.rgb + 3 * p, less.rgb + 3 * p, 12) != 0;
        printf("without %-30s %u of 2304 pixels differ, mean %.4f\n", ec_features[i].name, changed, less.mean[1]);
        CHECK_MSG(whole.stats.effects.called.bits & bit, "%s is not called for", ec_features[i].name);
        CHECK_MSG(changed, "the picture is the same without %s", ec_features[i].name);
        CHECK_MSG(ec_effect_describe(&less.stats.effects, i).left_out, "%s is not said to be left out", ec_features[i].name);
        case_free(&less);
        ec_scene_view view;
        ec_effects called;
        ec_error err = {0};
        CHECK_OK(ec_scene_view_without(scene, with(bit), EC_ALL_MATERIALS, &view, &err), err);
        CHECK_OK(ec_scene_calls(&view.scene, &called, &err), err);
        CHECK_MSG(!(called.bits & bit), "%s is called for though it is left out", ec_features[i].name);
        ec_scene_view_free(&view);
    }
    case_free(&whole);
    case_free(&again);
    ec_scene_free(scene);
    TEST_END();
}
