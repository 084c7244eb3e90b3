/* tier: quick */
/* Films of some of a picture's rows, one after the other, give the bits of the whole: sums of its error, intervals. */
#include "film/resolve.h"
#include "support/films.h"
#include "support/random.h"
#include "support/test.h"

enum { W = 19, H = 45, P = W * H, REACH = EC_INTERVAL_REACH };

/* Fireflies in the right half, whose pixels are heavy. */
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
    CHECK_OK(ec_film_create(&film, W, rows, 16, &err), err);
    for (int b = 0; b < batches; b++) {
        for (int i = 0; i < 3 * P; i++) batch[i] = batch_value(&random, i / 3 % W);
        CHECK_OK(films_add(&film, (uint32_t)b, batch + 3 * W * first, &err), err);
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
        ec_film_error a = ec_film_estimate_error(&whole), b = ec_film_error_of(&sums, P, ec_film_replicates(&whole), NULL, 0);
        check_same_error(&a, &b);
        ec_film_destroy(&whole);
    }
}

typedef struct picture {
    float rgb[3 * P], se[3 * P], se_y[P], samples[P], low[3 * P], high[3 * P], heavy[P];
} picture;

/* Compares rows of the film with the same rows of the picture. */
static uint64_t resolve(const ec_film *film, uint32_t first, uint32_t rows, picture *out)
{
    static ec_pixel room[W * (EC_RESOLVE_ROWS + 2 * REACH)];
    const uint64_t p = (uint64_t)first * W;
    const ec_planes planes = {out->rgb + 3 * p, out->se + 3 * p, out->se_y + p, out->samples + p, 1,
                              {out->low + 3 * p, out->high + 3 * p, out->heavy + p}};
    CHECK(ec_resolve_room(W, rows) <= sizeof room / sizeof *room);
    return ec_film_resolve_rows(film, first, rows, &planes, room);
}

static void intervals_of_rows_are_those_of_the_whole(void)
{
    static picture all, some;
    ec_film whole = filled(0, H, 16);
    uint64_t heavy = resolve(&whole, 0, H, &all), sum = 0;
    for (uint32_t first = 0, rows; first < H; first += rows) {
        rows = H - first < 7 ? H - first : 7;
        sum += resolve(&whole, first, rows, &some);
    }
    CHECK(heavy == sum && heavy > 10 && heavy < P && !memcmp(&all, &some, sizeof all));
    ec_film_destroy(&whole);
}

/* Rows 18 to 26 as a film of their own, copied from two others with the neighbouring rows that their intervals need. Features are copied
 * too, and an unsummed batch. */
static void rows_may_come_from_two_films(void)
{
    enum { FIRST = 18, ROWS = 8, SEAM = 22, N = ROWS * W, ALL = ROWS + 2 * REACH };
    static picture all;
    static float low[3 * N], high[3 * N], heavy[N], batch[3 * P], features[EC_FILM_FEATURES * P];
    static ec_pixel pixels[ALL * W];
    ec_film whole = filled(0, H, 16), above = filled(0, SEAM, 16), below = filled(SEAM, H - SEAM, 16), around;
    ec_film *films[] = {&whole, &above, &below};
    const uint32_t from[] = {0, 0, SEAM};
    ec_error err;
    for (int i = 0; i < 3 * P; i++) batch[i] = (float)i;
    for (int i = 0; i < EC_FILM_FEATURES * P; i++) features[i] = (float)(i % 1000);
    for (int i = 0; i < 3; i++) {
        ec_film_want_features(films[i], 1, UINT32_MAX);
        CHECK_OK(films_add_with(films[i], 40, 0, batch + 3 * W * from[i], features + EC_FILM_FEATURES * W * from[i], &err), err); /* with nothing between it and the others */
    }
    CHECK_OK(ec_film_create_like(&around, &above, ALL, &err), err);
    ec_film_copy_rows(&around, 0, &above, FIRST - REACH, SEAM - FIRST + REACH);
    ec_film_copy_rows(&around, SEAM - FIRST + REACH, &below, 0, FIRST + ROWS + REACH - SEAM);
    resolve(&whole, 0, H, &all);
    ec_film_look(&around, 0, ALL * W, pixels);
    ec_intervals(pixels, W, ALL, REACH, ROWS, &(ec_intervals_of){low, high, heavy});
    CHECK(!memcmp(low, all.low + 3 * FIRST * W, sizeof low) && !memcmp(high, all.high + 3 * FIRST * W, sizeof high));
    CHECK(!memcmp(heavy, all.heavy + FIRST * W, sizeof heavy));
    for (int i = 0; i < N; i++) {
        const ec_pixel *pixel = &pixels[REACH * W + i];
        for (int c = 0; c < 3; c++)
            CHECK((float)pixel->mean[c] == all.rgb[3 * (FIRST * W + i) + c] && (float)sqrt(ec_pixel_se2(pixel, c)) == all.se[3 * (FIRST * W + i) + c]);
    }
    CHECK(around.part_count == 2 && !memcmp(ec_film_features_at(&around, 0), features + EC_FILM_FEATURES * W * (FIRST - REACH), EC_FILM_FEATURES * ALL * W * sizeof(float)));
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
