/* tier: full */
/* Sums of more samples than a float can count. */
#include "robust/cases.h"
#include "selftest/shot.h"

/* The camera sees only a lamp: every sample is the lamp's radiance. */
static ec_result lamp(ec_selftest *t, ec_error *err)
{
    ec_scene *scene;
    EC_TRY(ec_shot_lamp(&scene, err));
    ec_render_options o = ec_shot_options(t, 4, 1u << 23);
    o.max_depth = 1;
    return ec_shot_only_row(t, "2^23 samples a pixel, 2^27 in all", scene, &o, (double)0.1f, err);
}

static ec_result many_samples_case(ec_selftest *t, ec_error *err)
{
    EC_TRY(lamp(t, err));
    ec_scene *scene;
    EC_TRY(ec_shot_box(0.5, &scene, err));
    ec_render_options o = ec_shot_options(t, 2, 1u << 20);
    return ec_shot_only_row(t, "furnace of 2^20 samples a pixel", scene, &o, 2, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"numbers/many samples", false, many_samples_case, "pictures that darken with more samples: float sums (-58 % at 1e8)"},
    };
    return RUN_CASES(cases);
}
