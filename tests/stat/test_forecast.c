/* Forecasts on synthetic films: pixels whose noise is exponential, or fireflies on a grey ground, or in few pixels only. A pilot of
 * four batches says how many it will take; then batches come until the bound is there. The 95 % interval must hold the truth in at
 * least 90 % of the repeats (80 % where six pixels hold all noise: their own spread is hardly known), the number it names must be
 * near, and where few pixels hold the noise it must say so. */
#include <string.h>

#include "film/forecast.h"
#include "pipeline/forecast.h"
#include "support/random.h"
#include "support/test.h"

enum { WIDTH = 48, HEIGHT = 32, PIXELS = WIDTH * HEIGHT, PILOT = 4, REPEATS = 200 };

static test_random state = {1};
static double uniform(void) { return test_uniform(&state); }

/* Mean 1 all of them. */
static double exponential(uint32_t p) { return (void)p, -log(uniform()); }
static double fireflies(uint32_t p) { return (void)p, uniform() < 0.01 ? 0.5 / 0.01 + 0.5 : 0.5; }
static double few(uint32_t p) { return p % 256 ? 1 : -2 * log(uniform()) - 1; }

static void add_batch(ec_film *film, double (*draw)(uint32_t))
{
    static float batch[3 * PIXELS];
    for (uint32_t i = 0; i < PIXELS; i++) batch[3 * i] = batch[3 * i + 1] = batch[3 * i + 2] = (float)draw(i);
    ec_error err;
    CHECK_OK(ec_film_add_batch(film, batch, &err), err);
}

static ec_forecast forecast_of(const ec_film *film, const ec_render_options *limits, const ec_pace *pace, double done, double gain)
{
    ec_film_error now = ec_film_estimate_error(film);
    return ec_forecast_make(film, &now, limits, pace, done, gain);
}

static void check(const char *name, double (*draw)(uint32_t), double target, double least_inside, double most_off)
{
    int inside = 0;
    double off = 0, spread = 0, took = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        ec_film film = {0};
        ec_error err;
        CHECK_OK(ec_film_create(&film, WIDTH, HEIGHT, 8, &err), err);
        for (int i = 0; i < PILOT; i++) add_batch(&film, draw);
        ec_render_options limits = {.error_target = target};
        ec_pace pace = {.seconds = 4.5, .first_seconds = 1.5}; /* a second a batch */
        ec_forecast f = forecast_of(&film, &limits, &pace, PILOT, 1);
        while (ec_film_estimate_error(&film).error_bound > target) add_batch(&film, draw);
        double samples = 8.0 * film.batch_count;
        inside += f.samples_low <= samples && samples <= f.samples_high;
        off += (f.samples / samples - 1) / REPEATS;
        spread += f.spread / REPEATS;
        took += samples / REPEATS;
        CHECK_NEAR(f.seconds, 4.5 + f.samples / 8 - PILOT, 1e-6);
        CHECK(f.seconds_low <= f.seconds && f.seconds <= f.seconds_high && f.pilot_samples == 8 * PILOT);
        CHECK(f.samples_low <= f.samples && f.samples <= f.samples_high);
        ec_film_destroy(&film);
    }
    printf("%-24s %4.0f samples: interval holds them in %5.1f %%, off by %+5.1f %% in the mean, spread %.2f\n", name, took,
           100.0 * inside / REPEATS, 100 * off, spread);
    CHECK_MSG(inside >= least_inside * REPEATS, "%s: inside in %d of %d", name, inside, REPEATS);
    CHECK_MSG(fabs(off) <= most_off, "%s: off by %g", name, off);
    CHECK_MSG((draw == few) == (spread > 0.3), "%s: spread %g", name, spread);
}

static void other_limits(void)
{
    ec_film film = {0};
    ec_error err;
    CHECK_OK(ec_film_create(&film, WIDTH, HEIGHT, 8, &err), err);
    for (int i = 0; i < PILOT; i++) add_batch(&film, exponential);
    ec_pace pace = {.seconds = 4.5, .first_seconds = 1.5};
    ec_render_options spp = {.spp = 160}, time = {.time_limit = 24.5}, both = {.error_target = 1e-3, .time_limit = 24.5}, none = {0};
    ec_forecast f = forecast_of(&film, &spp, &pace, PILOT, 1);
    CHECK_NEAR(f.samples, 160, 0);
    CHECK_NEAR(f.samples_low, f.samples_high, 0);
    CHECK_NEAR(f.seconds, 4.5 + 16, 1e-9);
    CHECK_NEAR(f.error_bound, sqrt(1.0 / 20), 0.02); /* 20 batches of variance 1, and the bound a little over */
    f = forecast_of(&film, &spp, &pace, PILOT, 0.25);
    CHECK_NEAR(f.error_bound, sqrt(0.25 / 20), 0.01); /* where an allotment of samples makes a quarter of the variance */
    CHECK_NEAR(f.samples, 160, 0);
    f = forecast_of(&film, &time, &pace, PILOT, 1);
    CHECK_NEAR(f.samples, 8 * 24, 1e-9);
    CHECK_NEAR(f.seconds, 24.5, 1e-9);
    f = forecast_of(&film, &both, &pace, PILOT, 1);
    CHECK_NEAR(f.samples, 8 * 24, 1e-9);
    CHECK(f.error_bound > 0.1 && f.error_bound < 0.3);
    f = forecast_of(&film, &none, &pace, PILOT, 1);
    CHECK(isinf(f.seconds) && isinf(f.samples));
    ec_film_destroy(&film);

    static float black[3 * PIXELS];
    CHECK_OK(ec_film_create(&film, WIDTH, HEIGHT, 8, &err), err);
    for (int i = 0; i < PILOT; i++) CHECK_OK(ec_film_add_batch(&film, black, &err), err);
    ec_render_options error = {.error_target = 0.01};
    f = forecast_of(&film, &error, &pace, PILOT, 1); /* nothing is known of the dark */
    CHECK(isinf(f.samples) && isinf(f.seconds) && isinf(f.error_bound));
    ec_film_destroy(&film);
}

int main(void)
{
    check("exponential", exponential, 0.12, 0.9, 0.03);
    check("fireflies", fireflies, 0.5, 0.9, 0.1);
    check("noise in six pixels", few, 0.02, 0.8, 0.5);
    other_limits();
    TEST_END();
}
