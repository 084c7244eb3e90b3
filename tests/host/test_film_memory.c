/* tier: quick */
/* A film takes the memory that parts.h promises, with and without first-hit features. */
#include "support/film_batches.h"

enum { MOST = 5000 };

/* At every number of batches there are as many sums as parts.h promises, and no unsummed batch. */
static void memory_is_bounded(void)
{
    const uint64_t sum = ec_sums_bytes(replicates, sets);
    CHECK(ec_film_bytes(replicates, sets, 0, 1) == sum && ec_film_bytes(replicates, sets, 0, 128) == sum && ec_film_bytes(replicates, sets, 0, 129) == 2 * sum &&
          ec_film_bytes(replicates, sets, 0, 2048) == 2 * sum && ec_film_bytes(replicates, sets, 0, 2049) == 3 * sum && ec_film_bytes(replicates, sets, 9, 9) == 0);
    ec_film film = empty();
    ec_error err;
    for (uint32_t k = 0; k < MOST; k++) {
        CHECK_OK(add(&film, k, 0, &err), err);
        CHECK(bytes_of(&film) <= ec_film_bytes(replicates, sets, 0, k + 1));
        for (uint32_t i = 0; i < film.part_count; i++) CHECK(!film.parts[i].batch && ec_film_part_is_sound(film.parts[i].first, film.parts[i].count));
    }
    ec_film_destroy(&film);
    const uint32_t sound[][2] = {{5, 1}, {0, 1}, {0, 127}, {128, 128}, {128, 100}, {0, 256}, {0, 1920}, {2048, 2048}, {0, 6144}, {2048, 1024}};
    const uint32_t unsound[][2] = {{0, 0}, {1, 2}, {0, 129}, {64, 128}, {128, 256}, {128, 2048}, {0, 2049}, {UINT32_MAX, 1}};
    for (size_t i = 0; i < sizeof sound / sizeof *sound; i++) CHECK_MSG(ec_film_part_is_sound(sound[i][0], sound[i][1]), "%u, %u", sound[i][0], sound[i][1]);
    for (size_t i = 0; i < sizeof unsound / sizeof *unsound; i++)
        CHECK_MSG(!ec_film_part_is_sound(unsound[i][0], unsound[i][1]), "%u, %u", unsound[i][0], unsound[i][1]);
}

/* The memory is within the bound at any moment, and not far below it. */
static void memory_of_slices_is_bounded(void)
{
    const uint32_t firsts[] = {0, 1, 5, 15, 127, 128, 129, 200, 256, 257, 1900, 2040, 2048, 2049, 4095, 4096};
    for (size_t i = 0; i < sizeof firsts / sizeof *firsts; i++) {
        ec_film film = empty();
        ec_error err;
        uint64_t worst = 0;
        for (uint32_t k = firsts[i]; k < firsts[i] + 600; k++) {
            CHECK_OK(add(&film, k, 0, &err), err);
            worst = bytes_of(&film) > worst ? bytes_of(&film) : worst;
            const uint64_t most = ec_film_bytes(replicates, sets, firsts[i], k + 1);
            CHECK_MSG(worst <= most && most <= worst + 2 * ec_sums_bytes(replicates, sets), "batches %u to %u: %llu of %llu", firsts[i], k,
                      (unsigned long long)worst, (unsigned long long)most);
        }
        ec_film_destroy(&film);
    }
}

int main(void)
{
    const uint32_t numbers[] = {EC_REPLICATES, 3, 1, EC_REPLICATES};
    for (int i = 0; i < 4; i++) {
        replicates = numbers[i];
        sets = i % 3;
        memory_is_bounded();
        memory_of_slices_is_bounded();
    }
    TEST_END();
}
