/* Films of some of a picture's rows, one after the other, come to the bits of the whole: sums of its error, intervals. */
#include "film/interval.h"
#include "support/random.h"
#include "support/test.h"

enum { W = 19, H = 45, P = W * H };

/* Fireflies in the right half: its pixels are heavy. */
static float batch_value(test_random *random, int x)
{
    return (float)(test_uniform(random) < 0.05 && x > W / 2 ? 40 * test_uniform(random) : 1 + test_uniform(random));
}

/* Rows [first, first + rows) of the same batches. */
static ec_film filled(uint32_t first, uint32_t rows, int batches)
{
    static float batch[3 * P];
    test_random random = {7};
    ec_film film;
    ec_error err;
    CHECK_OK(ec_film_create(&film, W, rows, 2, &err), err);
    for (int b = 0; b < batches; b++) {
        for (int i = 0; i < 3 * P; i++) batch[i] = batch_value(&random, i / 3 % W);
        CHECK_OK(ec_film_add_batch(&film, batch + 3 * W * first, &err), err);
    }
    return film;
}

static void check_same_error(const ec_film_error *a, const ec_film_error *b)
{
    CHECK(a->mean_luminance == b->mean_luminance && a->error == b->error && a->error_bound == b->error_bound);
    CHECK(a->noisy_pixels == b->noisy_pixels && a->spread == b->spread && a->relmse == b->relmse);
}

static void sums_of_strips_are_those_of_the_whole(void)
{
    static const uint32_t cuts[] = {0, 16, 32, H};
    for (int batches = 1; batches <= 40; batches += 13) {
        ec_film whole = filled(0, H, batches);
        ec_error_sums sums = {0};
        for (int i = 0; i < 3; i++) {
            ec_film strip = filled(cuts[i], cuts[i + 1] - cuts[i], batches);
            ec_film_sum_errors(&strip, &sums);
            ec_film_destroy(&strip);
        }
        ec_film_error a = ec_film_estimate_error(&whole), b = ec_film_error_of(&sums, P, (uint32_t)batches, false);
        check_same_error(&a, &b);
        ec_film_destroy(&whole);
    }
}

typedef struct intervals {
    float low[3 * P], high[3 * P], heavy[P];
} intervals;

static void intervals_of_rows_are_those_of_the_whole(void)
{
    static intervals all, some;
    ec_film whole = filled(0, H, 16);
    uint64_t heavy = ec_film_interval_rows(&whole, 0, whole.height, all.low, all.high, all.heavy), sum = 0;
    for (uint32_t first = 0, rows; first < H; first += rows) {
        rows = H - first < 7 ? H - first : 7;
        uint64_t p = (uint64_t)first * W;
        sum += ec_film_interval_rows(&whole, first, rows, some.low + 3 * p, some.high + 3 * p, some.heavy + p);
    }
    CHECK(heavy == sum && heavy > 10 && heavy < P && !memcmp(&all, &some, sizeof all));
    ec_film_destroy(&whole);
}

/* Rows 18 to 26 of a film of their own, copied from two others with the rows that their intervals reach. */
static void rows_may_come_from_two_films(void)
{
    enum { FIRST = 18, ROWS = 8, SEAM = 22, REACH = EC_INTERVAL_REACH, N = ROWS * W };
    static intervals all, some;
    ec_film whole = filled(0, H, 16), above = filled(0, SEAM, 16), below = filled(SEAM, H - SEAM, 16), around;
    ec_error err;
    CHECK_OK(ec_film_create(&around, W, ROWS + 2 * REACH, 2, &err), err);
    ec_film_copy_rows(&around, 0, &above, FIRST - REACH, SEAM - FIRST + REACH);
    ec_film_copy_rows(&around, SEAM - FIRST + REACH, &below, 0, FIRST + ROWS + REACH - SEAM);
    ec_film_interval_rows(&whole, FIRST, ROWS, all.low, all.high, all.heavy);
    ec_film_interval_rows(&around, REACH, ROWS, some.low, some.high, some.heavy);
    CHECK(!memcmp(&all, &some, sizeof all));
    static float rgb[3 * P], se[3 * P], here[3 * N], here_se[3 * N];
    const ec_film seen = ec_film_rows(&around, REACH, ROWS);
    ec_film_resolve(&whole, rgb, se);
    ec_film_resolve(&seen, here, here_se);
    CHECK(!memcmp(here, rgb + 3 * FIRST * W, sizeof here) && !memcmp(here_se, se + 3 * FIRST * W, sizeof here_se));
    ec_film_destroy(&whole);
    ec_film_destroy(&above);
    ec_film_destroy(&below);
    ec_film_destroy(&around);
}

int main(void)
{
    sums_of_strips_are_those_of_the_whole();
    intervals_of_rows_are_those_of_the_whole();
    rows_may_come_from_two_films();
    TEST_END();
}
