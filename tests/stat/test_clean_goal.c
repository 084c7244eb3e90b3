/* tier: quick */
/* The goal of a denoised picture (render/clean_goal.h): when its error is looked at, and how many samples are predicted. For pictures whose
 * error follows a law, looks are few, the end is found in the first round that reaches it, and forecasts contain it. */
#include "render/clean_goal.h"
#include "render/goal.h"
#include "support/test.h"

#define WIDER 1.05 /* high95 over error */

/* Returns the samples a pixel at which a render of such a picture ends; looks: how often its error was asked for. */
static double run(double error_at_pilot, double slope, double target, int *looks, ec_clean_range *predicted)
{
    ec_clean_goal goal = {0};
    *looks = 0;
    for (uint32_t batch = 0; batch < 100000; batch++) {
        if (!ec_schedule_is_round(EC_REPLICATES, batch) || !ec_schedule_has_pilot(EC_REPLICATES, batch)) continue;
        const double samples = (double)ec_schedule_samples(EC_REPLICATES, batch), error = error_at_pilot * pow(samples / 32, -slope / 2);
        if (!ec_clean_goal_is_due(&goal, samples, target)) {
            CHECK_MSG(error * WIDER > target, "the end at %g samples was slept through", samples);
            continue;
        }
        ec_clean_goal_take(&goal, samples, &(ec_clean_look){error, error * WIDER});
        if (++*looks == 2) *predicted = ec_clean_goal_samples(&goal, target);
        if (error * WIDER <= target) return samples;
    }
    return INFINITY;
}

static void check_law(double slope)
{
    int looks;
    ec_clean_range predicted = {0};
    const double end = run(0.1, slope, 0.02, &looks, &predicted), real = 32 * pow(0.1 * WIDER / 0.02, 2 / slope);
    printf("slope %g: ends at %g, really %g, %d looks, predicted %g (%g to %g)\n", slope, end, real, looks, predicted.expected, predicted.low, predicted.high);
    CHECK(end >= real && end <= 1.26 * real);
    CHECK(looks <= 2 + log2(end / 32) + 12);
    CHECK(predicted.low <= real && real <= predicted.high);
    CHECK_NEAR(log(predicted.expected / real), 0, 0.1);
}

/* A goal for the denoised picture is reached only at a look. */
static void check_goal(void)
{
    ec_goal goal = {.pixels = 1000, .replicates = EC_REPLICATES};
    ec_goal_set(&goal, 0, 0, 0.02);
    goal.now.error_bound = 0.05;
    CHECK(!ec_goal_met(&goal, (ec_mark){64, 1}, true, 8));
    ec_clean_goal_take(&goal.clean, 64, &(ec_clean_look){0.015, 0.021});
    CHECK(!ec_goal_met(&goal, (ec_mark){64, 1}, true, 8));
    ec_clean_goal_take(&goal.clean, 80, &(ec_clean_look){0.015, 0.019});
    CHECK(!ec_goal_met(&goal, (ec_mark){80, 1}, false, 8)); /* within a round */
    CHECK(ec_goal_met(&goal, (ec_mark){80, 1}, true, 8) && !strcmp(ec_goal_met(&goal, (ec_mark){80, 1}, true, 8), "error"));
}

/* Without a bound nothing is predicted, and there is a look at each doubling. */
static void check_unknown(void)
{
    ec_clean_goal goal = {0};
    CHECK(ec_clean_goal_is_due(&goal, 32, 0.02));
    CHECK(isinf(ec_clean_goal_samples(&goal, 0.02).low) && isinf(ec_clean_goal_bound(&goal, 64)));
    ec_clean_goal_take(&goal, 32, &(ec_clean_look){0.1, INFINITY});
    CHECK(!ec_clean_goal_is_due(&goal, 56, 0.02) && ec_clean_goal_is_due(&goal, 64, 0.02));
    CHECK(isinf(ec_clean_goal_samples(&goal, 0.02).expected));
}

int main(void)
{
    check_law(1);
    check_law(0.7);
    check_law(0.4);
    check_goal();
    check_unknown();
    TEST_END();
}
