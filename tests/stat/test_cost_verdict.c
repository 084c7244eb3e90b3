/* tier: quick */
/* Verdicts of a study on synthetic rows: no winner without evidence, and the sentence names the best of the column. */
#include "cost/cost.h"
#include "support/test.h"

enum { ROWS = 5 };

/* A curve of independent samples: error 10 % after a second; `noise` is that of its squared error. */
static ec_cost_row make(const char *id, const char *group, double time, double time_se, double noise)
{
    ec_cost_row row = {.state = EC_COST_MEASURED, .rung = {.group = group, .unbiased = true}, .relative_time = time, .relative_time_se = time_se, .point_count = 4, .unit = 8};
    snprintf(row.rung.id, sizeof row.rung.id, "%s", id);
    snprintf(row.rung.name, sizeof row.rung.name, "%s", id);
    for (int i = 0; i < 4; i++) {
        const double mse = 0.01 / (1 << i);
        row.points[i] = (ec_cost_point){.samples = 1u << i, .batches = 2, .seconds = time * (1 << i), .mse = mse, .mse_se = noise * mse};
    }
    row.variance = 0.01;
    for (int i = 0; i < EC_COST_TARGETS; i++) row.seconds_to[i] = ec_cost_seconds_to(&row, ec_cost_targets[i], &row.extrapolated[i]);
    return row;
}

static bool says(const ec_cost_study *study, const char *words)
{
    char text[EC_COST_WORDS];
    ec_cost_words(study, text, sizeof text);
    const bool is_there = strstr(text, words) != NULL;
    if (!is_there) printf("not '%s' in: %s\n", words, text);
    return is_there;
}

int main(void)
{
    ec_cost_row rows[ROWS] = {make("path", "base", 1, 0, 0.02), make("rr-0.5", "roulette", 0.9, 0.01, 0.1), make("bvh2", "accelerator", 0.97, 0.02, 0),
                              make("no-indirect", "effect", 0.1, 0.01, 0.02), make("raster", "integrator", 0.1, 0.01, 0.02)};
    ec_cost_study study = {.rows = rows, .row_count = ROWS, .options = {.width = 64, .height = 48}};
    const ec_cost_column to_5 = EC_COST_TO_FIRST;
    rows[0].rung.is_base = true;
    rows[2].rung.speed_only = rows[2].same_bits = true;
    rows[2].point_count = 0;
    rows[3].rung.is_effect = rows[3].biased = rows[4].biased = true;
    rows[3].rung.unbiased = rows[4].rung.unbiased = false;
    rows[3].bias2 = 0.27 * 0.27;
    rows[4].bias2 = 0.3 * 0.3;

    /* 10 % sooner, but with 10 % of noise: no winner. */
    CHECK(ec_cost_best(&study, to_5) == 0 && ec_cost_best(&study, EC_COST_TIME) == 1);
    CHECK(says(&study, "An error of 5 % at 64x48 pixels takes 4 s with the default of eclat render. It is the best of 3 ways to render whose time is known"));
    CHECK(says(&study, "without no-indirect 27.0 %."));
    CHECK(says(&study, "No time takes raster under 30.0 %."));
    /* With 1 % of noise: a winner. */
    rows[1] = make("rr-0.5", "roulette", 0.9, 0.01, 0.01);
    CHECK(ec_cost_best(&study, to_5) == 1);
    CHECK(says(&study, "With rr rr-0.5 it takes 0.90 ± 0.02 times as long, the least of 3 ways"));
    /* For an extrapolated time the slope's noise counts too; without a slope there is no evidence. */
    rows[0].fit = rows[1].fit = (ec_cost_fit){-0.5, 0.001};
    CHECK(ec_cost_best(&study, to_5 + 1) == 1);
    rows[1].fit.se = 0.05;
    CHECK(ec_cost_best(&study, to_5 + 1) == 0);
    rows[1].fit.se = NAN;
    CHECK(ec_cost_best(&study, to_5 + 1) == 0 && ec_cost_best(&study, to_5) == 1);
    /* Structures give the default's bits, so only their times are compared. */
    rows[2].relative_time = 0.8;
    CHECK(ec_cost_best(&study, to_5) == 2);
    CHECK(says(&study, "With bvh2 it takes 0.80 ± 0.02 times as long"));
    rows[2].same_bits = false;
    CHECK(ec_cost_best(&study, to_5) == 1);
    rows[1].lacks_light = true; /* implausibly good figures */
    CHECK(ec_cost_best(&study, to_5) == 0 && ec_cost_best(&study, EC_COST_TIME) == 0);
    rows[1].relative_time_se = NAN; /* too few repetitions */
    rows[1].lacks_light = false;
    CHECK(ec_cost_best(&study, to_5) == 0);
    /* The errors of the default itself are unknown. */
    for (int i = 0; i < EC_COST_TARGETS; i++) rows[0].seconds_to[i] = NAN;
    CHECK(ec_cost_best(&study, to_5) == UINT32_MAX);
    CHECK(says(&study, "the budget was too small to tell an error of 5 %"));
    rows[4].state = EC_COST_TOO_SMALL;
    CHECK(says(&study, "1 of 5 rungs were not measured"));
    rows[0].state = EC_COST_PENDING;
    CHECK(says(&study, "the default was not measured"));
    TEST_END();
}
