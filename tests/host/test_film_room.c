/* tier: quick */
/* A film that had room made for its first batch is the one that had not. */
#include "film/film.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 600, HEIGHT = 600, PIXELS = WIDTH * HEIGHT, REPLICATES = 4 };

static float *numbers(uint64_t count)
{
    float *values = malloc(count * sizeof *values);
    for (uint64_t i = 0; values && i < count; i++) values[i] = (float)(i % 1009) / 64;
    return values;
}

static bool is_alike(const float *a, const float *b, uint64_t count) { return a && b && !memcmp(a, b, count * sizeof *a); }

/* begun: so many pixels of the first batch, which is all; 0: it is whole, and others follow. */
static void check(uint32_t begun, bool by_halves)
{
    ec_film with, without;
    ec_error err = {0};
    float *batch = numbers((uint64_t)PIXELS * EC_BATCH_FIELDS), *features = numbers((uint64_t)PIXELS * EC_FILM_FEATURES);
    const uint32_t reached = begun ? begun : PIXELS, steps[] = {0, 1, 8191, 100000, reached};
    ec_film *films[2] = {&with, &without};
    CHECK(batch && features);
    for (int k = 0; k < 2; k++) {
        CHECK_OK(ec_film_create(films[k], WIDTH, HEIGHT, REPLICATES, &err), err);
    }
    for (int i = 0; i < 4; i++) ec_film_make_room(&with, steps[i], steps[i + 1], true, by_halves);
    CHECK(with.room.sums.mean && with.room.aov && !with.room.aov_even == !by_halves);
    CHECK(!with.aov && !with.part_count); /* nothing is there yet */
    for (int k = 0; k < 2; k++) {
        CHECK_OK(ec_film_add_features(films[k], features, reached, 0, by_halves, &err), err);
        if (begun) {
            CHECK_OK(ec_film_add_begun(films[k], batch, reached, &err), err);
        }
        for (uint32_t i = 0; !begun && i < 6; i++) {
            CHECK_OK(ec_film_add(films[k], i, batch, &err), err);
        }
    }
    CHECK(!with.room.sums.mean && !with.room.aov && !with.room.aov_even);
    CHECK(is_alike(with.aov, without.aov, (uint64_t)PIXELS * EC_FILM_FEATURES));
    if (by_halves) CHECK(is_alike(with.aov_even, without.aov_even, (uint64_t)PIXELS * EC_FILM_FEATURES));
    CHECK(with.part_count == 1 && without.part_count == 1);
    CHECK(is_alike(with.parts->sums.mean, without.parts->sums.mean, 3ull * REPLICATES * PIXELS));
    CHECK(is_alike(with.parts->sums.tail, without.parts->sums.tail, 3ull * PIXELS));
    for (int k = 0; k < 2; k++) ec_film_destroy(films[k]);
    free(batch);
    free(features);
}

/* A film that was to have a batch, and has none. */
static void check_unused(void)
{
    ec_film film;
    ec_error err = {0};
    CHECK_OK(ec_film_create(&film, WIDTH, HEIGHT, REPLICATES, &err), err);
    ec_film_make_room(&film, 0, PIXELS, true, true);
    CHECK(film.room.aov && !film.aov);
    ec_film_destroy(&film);
    CHECK(!film.room.sums.mean && !film.room.aov);
}

int main(void)
{
    check(0, false);
    check(0, true);
    check(WIDTH * 300, false);
    check(WIDTH * 300, true);
    check_unused();
    TEST_END();
}
