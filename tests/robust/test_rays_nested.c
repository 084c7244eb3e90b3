/* tier: full */
/* Two closed surfaces, one just below the other: no ray hits the one behind before the one in front. */
#include <string.h>

#include "robust/cases.h"
#include "selftest/tracer.h"

/* Two balls with parallel facets, the second inside the first by 4e-5 of the radius. From outside the outer one is in front everywhere,
 * from inside the inner one. Along a ray they are 4e-5 / cosine apart, and t is wrong by at most 2e-6 reach / cosine. */
static ec_result nested_case(ec_selftest *t, ec_error *err)
{
    enum { LEVELS = 4 };
    const double inner = 1 - 4e-5, nowhere[3] = {0, 0, 0};
    uint64_t random = 3;
    ec_soup outer_ball, inner_ball, both;
    ec_tracer *r;
    EC_TRY(ec_tracer_of(t, &r, err));
    EC_TRY(ec_soup_ball(LEVELS, 0, (double[3]){1, 1, 1}, nowhere, &outer_ball, err));
    ec_result result = ec_soup_ball(LEVELS, 0, (double[3]){inner, inner, inner}, nowhere, &inner_ball, err);
    if (result == EC_OK) result = ec_soup_make(2 * outer_ball.count, &both, err);
    if (result == EC_OK) {
        memcpy(both.vertices, outer_ball.vertices, 9 * sizeof(float) * outer_ball.count);
        memcpy(both.vertices + 9 * (size_t)outer_ball.count, inner_ball.vertices, 9 * sizeof(float) * outer_ball.count);
    }
    uint32_t half = outer_ball.count;
    uint64_t rays = 0, wrong[2] = {0};
    ec_soup_free(&outer_ball);
    ec_soup_free(&inner_ball);
    EC_TRY(result);
    result = ec_tracer_build(r, &both, err);
    for (int outside = 0; outside < 2 && result == EC_OK; outside++) {
        ec_rays_within(r, &random, nowhere, (double[3]){1, 1, 1});
        for (uint32_t i = 0; i < EC_TRACER_RAYS && outside; i++) { /* back along the same lines, to end on the far side's outside */
            float o[3], d[3];
            ec_tracer_given(r, i, o, d);
            for (int k = 0; k < 3; k++) o[k] += 3 * d[k], d[k] = -d[k];
            ec_tracer_ray(r, i, o, d, EC_NO_ID);
        }
        for (uint32_t a = 0; ec_tracer_next(r, &a, EC_TRACER_RAYS, &result, err); a++) {
            for (uint32_t i = 0; i < EC_TRACER_RAYS; i++) {
                uint32_t prim = ec_tracer_hit(r, i).prim;
                wrong[outside] += prim == EC_NO_ID || (prim < half) != (outside == 1);
            }
            rays += EC_TRACER_RAYS;
        }
    }
    ec_soup_free(&both);
    EC_TRY(result);
    EC_TRY(ec_selftest_none(t, "from inside", wrong[0], rays / 2, NULL, err));
    return ec_selftest_none(t, "from outside", wrong[1], rays / 2, NULL, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"rays/nested balls", false, nested_case, "what lies just under a surface shows through it"},
    };
    return RUN_CASES(cases);
}
