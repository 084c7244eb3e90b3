/* tier: quick */
/* Intervals of pixels with known noise: normal, skewed, fireflies, few replicates, none. */
#include "film/resolve.h"
#include "film/statistics.h"
#include "support/films.h"
#include "support/random.h"
#include "support/test.h"

enum { W = 24, H = 20, P = W * H };

typedef double (*draw_fn)(test_random *random, uint32_t pixel, int replicate);

/* So many replicates of one sample each. */
static ec_film filled(int replicates, draw_fn draw, uint64_t seed)
{
    ec_film film;
    ec_error err;
    test_random random = {seed};
    CHECK_OK(ec_film_create(&film, W, H, replicates ? (uint32_t)replicates : 1, &err), err);
    for (int b = 0; b < replicates; b++) {
        static float batch[3 * P];
        for (uint32_t p = 0; p < P; p++) {
            float x = (float)draw(&random, p, b);
            for (int c = 0; c < 3; c++) batch[3 * p + (uint32_t)c] = x * (float)(c + 1);
        }
        CHECK_OK(films_add(&film, (uint32_t)b, batch, &err), err);
    }
    return film;
}

static double draw_normal(test_random *r, uint32_t p, int b) { return (void)p, (void)b, 1 + 0.1 * test_normal(r); }

/* Mean of four exponentials: skewness 1, mean 1. The mean of 16 of them has skewness 1/4. */
static double draw_skewed(test_random *r, uint32_t p, int b)
{
    double sum = 0;
    (void)p, (void)b;
    for (int i = 0; i < 4; i++) sum -= log(test_uniform(r));
    return sum / 4;
}

/* One pixel met a bright path once. */
static double draw_firefly(test_random *r, uint32_t p, int b) { return draw_normal(r, p, b) + (p == 5 * W + 7 && b == 3 ? 30 : 0); }

static double draw_exact(test_random *r, uint32_t p, int b) { return (void)r, (void)b, p % 7; }

/* In three of every five pixels, the first replicate has 60, 75 and 100 % of a sum of 4; the others are steady. */
static double draw_two(test_random *r, uint32_t p, int b)
{
    static const double first[5] = {2, 2.4, 3, 4, 2};
    (void)r;
    return p / W % 5 != 2 || p % W % 5 != 2 ? 2 : b ? 4 - first[p % W / 5] : first[p % W / 5];
}

typedef struct intervals {
    float low[3 * P], high[3 * P], heavy[P];
    uint64_t count;
} intervals;

static intervals of(const ec_film *film)
{
    static intervals i;
    static ec_pixel pixels[P];
    ec_film_look(film, 0, P, pixels);
    i.count = ec_intervals(pixels, W, H, 0, H, &(ec_intervals_of){i.low, i.high, i.heavy});
    return i;
}

/* Share of the intervals, and of plain t-intervals, that contain the true mean 1, 2 or 3, over pixels that are not heavy. */
static void coverage(int replicates, draw_fn draw, double *ours, double *plain, double *kept)
{
    double values = 0, held = 0, plain_held = 0, t = ec_student_t_quantile(0.975, replicates - 1);
    for (uint64_t seed = 0; seed < 150; seed++) {
        ec_film film = filled(replicates, draw, seed);
        static float rgb[3 * P], se[3 * P];
        ec_film_resolve(&film, rgb, se);
        intervals i = of(&film);
        for (uint32_t p = 0; p < P; p++)
            if (!i.heavy[p]) {
                values++;
                held += i.low[3 * p + 1] <= 2 && 2 <= i.high[3 * p + 1];
                plain_held += fabs(rgb[3 * p + 1] - 2) <= t * se[3 * p + 1];
            }
        ec_film_destroy(&film);
    }
    *ours = held / values;
    *plain = plain_held / values;
    *kept = values / (150.0 * P);
    printf("%2d replicates: %.2f %% hold the truth (t-interval %.2f %%), %.1f %% of pixels not heavy\n", replicates, 100 * *ours, 100 * *plain,
           100 * *kept);
}

static void normal_noise_gives_the_t_interval(void)
{
    double ours, plain, kept;
    for (int replicates = 4; replicates <= 16; replicates *= 2) {
        coverage(replicates, draw_normal, &ours, &plain, &kept);
        /* 72 000 values: +- 0.08 %. With 4 replicates some pixels look calmer than they are and are flagged, which leaves 95.8 %. */
        CHECK_MSG(fabs(ours - 0.95) < (replicates < 16 ? 0.01 : 0.004) && kept > 0.96, "%d replicates", replicates);
    }
    ec_film film = filled(16, draw_normal, 1);
    intervals i = of(&film);
    static float rgb[3 * P], se[3 * P];
    ec_film_resolve(&film, rgb, se);
    double t = ec_student_t_quantile(0.975, 15), wider = 0;
    for (uint32_t k = 0; k < 3 * P; k++) {
        CHECK(i.low[k] <= rgb[k] && rgb[k] <= i.high[k]);
        wider += (i.high[k] - i.low[k]) / (2 * t * se[k]) / (3 * P);
    }
    CHECK_NEAR(wider, 1, 0.02);
    ec_film_destroy(&film);
}

static void skewed_noise_moves_the_interval(void)
{
    double ours, plain, kept;
    coverage(16, draw_skewed, &ours, &plain, &kept);
    CHECK_MSG(ours > 0.945 && ours < 0.956 && plain < ours - 0.004, "%.4f against %.4f", ours, plain);
    ec_film film = filled(16, draw_skewed, 1);
    intervals i = of(&film);
    double up = 0, down = 0;
    for (uint32_t p = 0; p < P; p++) up += i.high[3 * p] - films_pixel(&film, p).mean[0], down += films_pixel(&film, p).mean[0] - i.low[3 * p];
    CHECK_MSG(up > 1.3 * down, "up %g, down %g", up, down); /* the missed light is bright */
    ec_film_destroy(&film);
}

static void a_firefly_is_flagged_and_its_neighbours_are(void)
{
    ec_film film = filled(16, draw_firefly, 2);
    intervals i = of(&film);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            int apart = abs(x - 7) > abs(y - 5) ? abs(x - 7) : abs(y - 5);
            if (apart <= 1 || apart > EC_INTERVAL_REACH) CHECK_MSG((i.heavy[y * W + x] != 0) == (apart <= 1), "(%d, %d)", x, y);
        }
    CHECK(i.count >= 9 && i.count <= (2 * EC_INTERVAL_REACH + 1) * (2 * EC_INTERVAL_REACH + 1));
    ec_film_destroy(&film);
}

static void exact_pixels_are_points(void)
{
    ec_film film = filled(8, draw_exact, 0);
    intervals i = of(&film);
    for (uint32_t k = 0; k < 3 * P; k++) CHECK(i.low[k] == films_pixel(&film, k / 3).mean[k % 3] && i.high[k] == i.low[k]);
    CHECK(i.count == 0);
    ec_film_destroy(&film);
}

/* Each of two samples should have half; more than 70 % is a fifth more than that. */
static void few_samples_are_judged_by_their_fair_share(void)
{
    ec_film film = filled(2, draw_two, 0);
    intervals i = of(&film);
    for (uint32_t k = 0; k < 5; k++)
        CHECK_MSG((i.heavy[7 * W + 5 * k + 2] != 0) == (k == 2 || k == 3), "pixel %u", k);
    ec_film_destroy(&film);
}

static void without_replicates_nothing_is_known(void)
{
    for (int replicates = 0; replicates < 2; replicates++) {
        ec_film film = filled(replicates, draw_normal, 0);
        intervals i = of(&film);
        CHECK(i.count == P && i.low[0] == 0 && isinf(i.high[0]) && i.heavy[3] == 1);
        ec_film_destroy(&film);
    }
}

int main(void)
{
    normal_noise_gives_the_t_interval();
    skewed_noise_moves_the_interval();
    a_firefly_is_flagged_and_its_neighbours_are();
    exact_pixels_are_points();
    few_samples_are_judged_by_their_fair_share();
    without_replicates_nothing_is_known();
    TEST_END();
}
