/* tier: quick */
/* A film whose memory was allocated before its first batch equals one without. */
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

/* begun: only so many pixels of the first batch are done; 0: it is complete, and others follow. */
static void check(uint32_t begun, uint32_t sets)
{
    ec_film with, without;
    ec_error err = {0};
    float *batch = numbers((uint64_t)PIXELS * EC_BATCH_FIELDS), *features = numbers((uint64_t)PIXELS * EC_FILM_FEATURES);
    const uint32_t reached = begun ? begun : PIXELS, steps[] = {0, 1, 8191, 100000, reached};
    ec_film *films[2] = {&with, &without};
    CHECK(batch && features);
    for (int k = 0; k < 2; k++) {
        CHECK_OK(ec_film_create(films[k], WIDTH, HEIGHT, REPLICATES, &err), err);
        ec_film_want_features(films[k], sets, UINT32_MAX);
    }
    for (int i = 0; i < 4; i++) ec_film_make_room(&with, steps[i], steps[i + 1]);
    CHECK(with.room.mean && with.room.sets == sets && !with.part_count); /* nothing is there yet */
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < (begun ? 1 : 6); i++) {
            const ec_film_batch own = {.index = i, .values = batch, .features = features, .missing = PIXELS - reached};
            CHECK_OK(ec_film_take(films[k], &own, &err), err);
        }
    CHECK(!with.room.mean);
    CHECK(with.part_count == 1 && without.part_count == 1);
    CHECK(is_alike(with.parts->sums.mean, without.parts->sums.mean, 3ull * REPLICATES * PIXELS));
    CHECK(is_alike(with.parts->sums.tail, without.parts->sums.tail, 3ull * PIXELS));
    if (sets) CHECK(is_alike(with.parts->sums.features, without.parts->sums.features, (uint64_t)EC_FILM_FEATURES * sets * PIXELS));
    for (int k = 0; k < 2; k++) ec_film_destroy(films[k]);
    free(batch);
    free(features);
}

/* A film that was to get a batch, and got none. */
static void check_unused(void)
{
    ec_film film;
    ec_error err = {0};
    CHECK_OK(ec_film_create(&film, WIDTH, HEIGHT, REPLICATES, &err), err);
    ec_film_want_features(&film, 2, UINT32_MAX);
    ec_film_make_room(&film, 0, PIXELS);
    CHECK(film.room.features && !film.part_count);
    ec_film_destroy(&film);
    CHECK(!film.room.mean && !film.room.features);
}

int main(void)
{
    for (uint32_t sets = 0; sets < 3; sets++) check(0, sets), check(WIDTH * 300, sets);
    check_unused();
    TEST_END();
}
