/* The same bits, whoever adds the batches, in whatever order, in whatever slices; and the moments are those of the definition. */
#include "film/film.h"
#include "support/random.h"
#include "support/test.h"

enum { W = 3, H = 2, P = W * H, MOST = 5000 };

static test_random state = {7};

/* Batch k of every film here. Heavy-tailed, and far from 0, where sums in another order do not round alike. */
static const float *batch_of(uint32_t k)
{
    static float rgb[3 * P];
    for (uint32_t i = 0; i < 3 * P; i++) {
        test_random own = {k * 1000003ull + i};
        test_uniform(&own);
        rgb[i] = (float)(10 * i + 1 / (0.01 + test_uniform(&own)));
    }
    return rgb;
}

static ec_film empty(void)
{
    ec_film film;
    ec_error err;
    CHECK_OK(ec_film_create(&film, W, H, 4, &err), err);
    return film;
}

static ec_film slice(uint32_t first, uint32_t end)
{
    ec_film film = empty();
    ec_error err;
    for (uint32_t k = first; k < end; k++) CHECK_OK(ec_film_add_at(&film, k, batch_of(k), &err), err);
    return film;
}

static int same(const ec_film *a, const ec_film *b)
{
    return a->batch_count == b->batch_count && !memcmp(a->mean, b->mean, 3 * P * sizeof(double)) &&
           !memcmp(a->m2, b->m2, 4 * P * sizeof(double)) && !memcmp(a->m34, b->m34, 2 * P * sizeof(float)) &&
           !memcmp(a->largest, b->largest, P * sizeof(float));
}

static void shuffle(uint32_t *order, uint32_t count)
{
    for (uint32_t i = count; i > 1; i--) {
        uint32_t k = (uint32_t)(test_uniform(&state) * i), kept = order[k];
        order[k] = order[i - 1];
        order[i - 1] = kept;
    }
}

static void any_order_of_batches(void)
{
    const uint32_t counts[] = {1, 2, 15, 16, 17, 31, 32, 33, 48, 255, 256, 257, 273, 600};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        for (int trial = 0; trial < 3; trial++) {
            uint32_t order[600], n = counts[i];
            ec_film in_order = slice(0, n), mixed = empty();
            ec_error err;
            for (uint32_t k = 0; k < n; k++) order[k] = k;
            shuffle(order, n);
            for (uint32_t k = 0; k < n; k++) CHECK_OK(ec_film_add_at(&mixed, order[k], batch_of(order[k]), &err), err);
            CHECK_MSG(same(&in_order, &mixed), "%u batches", n);
            CHECK(in_order.part_count == mixed.part_count);
            ec_film_destroy(&in_order);
            ec_film_destroy(&mixed);
        }
}

/* Cut anywhere, merged in any order, also by way of other merges. */
static void any_slices(void)
{
    const uint32_t counts[] = {5, 40, 300, 1000, MOST};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        uint32_t n = counts[i], cuts[8] = {0}, order[7] = {0, 1, 2, 3, 4, 5, 6};
        ec_film whole = slice(0, n), slices[7], halves[2] = {empty(), empty()}, all = empty();
        ec_error err;
        for (int k = 1; k < 7; k++) cuts[k] = cuts[k - 1] + (uint32_t)(test_uniform(&state) * (n - cuts[k - 1]) / 2);
        cuts[7] = n;
        for (int k = 0; k < 7; k++) slices[k] = slice(cuts[k], cuts[k + 1]);
        shuffle(order, 7);
        for (int k = 0; k < 7; k++) CHECK_OK(ec_film_take_parts(&halves[k % 2], &slices[order[k]], &err), err);
        for (int k = 1; k >= 0; k--) CHECK_OK(ec_film_take_parts(&all, &halves[k], &err), err);
        CHECK_MSG(same(&whole, &all), "%u batches", n);
        CHECK(all.part_count == whole.part_count);
        for (int k = 0; k < 7; k++) ec_film_destroy(&slices[k]);
        for (int k = 0; k < 2; k++) ec_film_destroy(&halves[k]);
        ec_film_destroy(&whole);
        ec_film_destroy(&all);
    }
}

/* Sums that are joined are those of two passes over all values: so is what a slice or a film with gaps shows. */
static void moments_are_those_of_two_passes(const ec_film *film, const uint32_t *batches, uint32_t n)
{
    for (int p = 0; p < P; p++)
        for (int c = 0; c < 4; c++) {
            double mean = 0, power[5] = {0}, largest = 0;
            static double x[MOST];
            for (uint32_t k = 0; k < n; k++) {
                const float *rgb = batch_of(batches[k]) + 3 * p;
                x[k] = c < 3 ? (double)rgb[c] : ec_luminance((double[3]){rgb[0], rgb[1], rgb[2]});
                mean += x[k] / n;
                largest = fmax(largest, x[k]);
            }
            for (uint32_t k = 0; k < n; k++)
                for (int e = 2; e <= 4; e++) power[e] += pow(x[k] - mean, e);
            if (c < 3) CHECK_NEAR(film->mean[3 * p + c], mean, 1e-12 * mean);
            CHECK_NEAR(film->m2[4 * p + c], power[2], 1e-11 * power[2]);
            if (c < 3) continue;
            CHECK(film->largest[p] == (float)largest);
            CHECK_NEAR(film->m34[2 * p], power[3], 1e-5 * pow(power[4], 0.75));
            CHECK_NEAR(film->m34[2 * p + 1], power[4], 1e-5 * power[4]);
        }
}

static void what_is_shown(void)
{
    static uint32_t all[MOST];
    for (uint32_t k = 0; k < MOST; k++) all[k] = k;
    const uint32_t ranges[][2] = {{0, 17}, {0, 700}, {5, 6}, {16, 17}, {3, 40}, {100, 900}, {0, 4097}};
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        ec_film film = slice(ranges[i][0], ranges[i][1]);
        moments_are_those_of_two_passes(&film, all + ranges[i][0], ranges[i][1] - ranges[i][0]);
        ec_film_destroy(&film);
    }
    ec_film gaps = slice(30, 70);
    ec_error err;
    const uint32_t list[] = {0, 1, 2, 16, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49, 50,
                             51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, 64, 65, 66, 67, 68, 69, 999};
    uint32_t n = sizeof list / sizeof *list;
    for (uint32_t k = 0; k < n; k++)
        if (list[k] < 30 || list[k] >= 70) CHECK_OK(ec_film_add_at(&gaps, list[k], batch_of(list[k]), &err), err);
    CHECK(gaps.batch_count == n && ec_film_end(&gaps) == 1000);
    moments_are_those_of_two_passes(&gaps, list, n);
    ec_film_destroy(&gaps);
}

/* Blocks of 16 and 256 that others have added up, a few pixels each (as ranks do), among batches one by one. */
static void blocks_of_batches(void)
{
    enum { N = 700, CUT = 4 };
    ec_film in_order = slice(0, N), mixed = empty();
    ec_error err;
    mixed.shows_late = true;
    for (uint32_t k = 0, count; k < N; k += count) {
        count = k >= 16 && k + 16 <= N ? k == 256 ? 256 : 16 : 1;
        if (count == 1) {
            CHECK_OK(ec_film_add_at(&mixed, k, batch_of(k), &err), err);
            continue;
        }
        ec_film_part part = {.first = k, .count = count};
        CHECK(ec_moments_create(&part.sums, P));
        for (uint32_t first = 0, end; first < P; first = end) {
            ec_film piece;
            end = first ? P : CUT;
            CHECK_OK(ec_film_create(&piece, end - first, 1, 4, &err), err);
            piece.shows_late = true;
            for (uint32_t i = 0; i < count; i++) CHECK_OK(ec_film_add_at(&piece, k + i, batch_of(k + i) + 3 * first, &err), err);
            ec_moments sums = ec_film_give_sums(&piece), here = ec_moments_from(&part.sums, first);
            double memory[EC_MOMENTS_BYTES * P / sizeof(double) + 1]; /* as it is sent */
            const ec_moments sent = ec_moments_in(memory, end - first);
            ec_moments_copy(&sent, &sums, end - first);
            ec_moments_copy(&here, &sent, end - first);
            ec_moments_destroy(&sums);
            ec_film_destroy(&piece);
        }
        CHECK_OK(ec_film_insert(&mixed, &part, &err), err);
        CHECK(!part.sums.mean && mixed.part_count + (mixed.part_count > 1) <= ec_film_copies(k + count));
    }
    ec_film_show(&mixed);
    CHECK(same(&in_order, &mixed) && in_order.part_count == mixed.part_count);
    ec_film_destroy(&in_order);
    ec_film_destroy(&mixed);
}

static void nothing_twice(void)
{
    ec_film film = slice(0, 40), other = slice(39, 60);
    ec_error err;
    CHECK(ec_film_add_at(&film, 17, batch_of(17), &err) == EC_FAILED && strstr(err.text, "batches 17 to 17 are there twice"));
    CHECK(ec_film_take_parts(&film, &other, &err) == EC_FAILED && strstr(err.text, "batches 39 to 39 are there twice"));
    ec_film again = slice(0, 40);
    CHECK(same(&film, &again));
    ec_film_destroy(&film);
    ec_film_destroy(&other);
    ec_film_destroy(&again);
}

/* As many sums as parts.h promises, at every number of batches on the way. */
static void memory_is_bounded(void)
{
    CHECK(ec_film_copies(1) == 1 && ec_film_copies(16) == 1 && ec_film_copies(17) == 3 && ec_film_copies(256) == 3 && ec_film_copies(257) == 4 &&
          ec_film_copies(65536) == 5);
    ec_film film = empty();
    ec_error err;
    for (uint32_t k = 0; k < MOST; k++) {
        CHECK_OK(ec_film_add_batch(&film, batch_of(k), &err), err);
        CHECK(film.part_count + (film.part_count > 1) <= ec_film_copies(k + 1));
        for (uint32_t i = 0; i < film.part_count; i++) CHECK(!film.parts[i].batch && ec_film_part_is_sound(film.parts[i].first, film.parts[i].count));
    }
    ec_film_destroy(&film);
    CHECK(!ec_film_part_is_sound(0, 0) && !ec_film_part_is_sound(1, 2) && !ec_film_part_is_sound(0, 17) && !ec_film_part_is_sound(16, 32) &&
          !ec_film_part_is_sound(UINT32_MAX, 1) && ec_film_part_is_sound(5, 1) && ec_film_part_is_sound(0, 240) && ec_film_part_is_sound(16, 16));
}

/* Late or at once, and through the glass. */
static void shown_late_is_the_same(void)
{
    ec_film at_once = slice(0, 300), late = empty();
    ec_error err;
    late.shows_late = true;
    for (uint32_t k = 0; k < 300; k++) CHECK_OK(ec_film_add_batch(&late, batch_of(k), &err), err);
    ec_film_error a = ec_film_estimate_error(&at_once), b = ec_film_estimate_error(&late);
    CHECK(late.is_behind && !same(&at_once, &late));
    CHECK(a.error == b.error && a.error_bound == b.error_bound && a.relmse == b.relmse);
    ec_film_show(&late);
    CHECK(!late.is_behind && same(&at_once, &late));
    ec_film_destroy(&at_once);
    ec_film_destroy(&late);
}

/* Within the bound at any moment, and not far below it. */
static void memory_of_slices_is_bounded(void)
{
    const uint32_t firsts[] = {0, 1, 5, 15, 16, 17, 32, 200, 240, 256, 257, 300, 512, 4095, 4096};
    for (size_t i = 0; i < sizeof firsts / sizeof *firsts; i++) {
        ec_film film = empty();
        ec_error err;
        uint64_t worst = 0;
        for (uint32_t k = firsts[i]; k < firsts[i] + 600; k++) {
            CHECK_OK(ec_film_add_at(&film, k, batch_of(k), &err), err);
            uint64_t now = film.part_count == 1 && !film.parts[0].batch ? 0 : EC_MOMENTS_BYTES;
            for (uint32_t p = 0; p < film.part_count; p++) now += film.parts[p].batch ? 12 : EC_MOMENTS_BYTES;
            worst = now > worst ? now : worst;
            const uint64_t most = ec_film_bytes(firsts[i], k + 1);
            CHECK(worst <= most && most <= worst + 2 * EC_MOMENTS_BYTES);
        }
        ec_film_destroy(&film);
    }
}

static void broken_values_are_counted_once(void)
{
    const float broken[3 * P] = {NAN, 1, INFINITY};
    ec_film film = empty();
    ec_error err;
    for (uint32_t k = 20; k > 0; k--) CHECK_OK(ec_film_add_at(&film, k - 1, broken, &err), err);
    CHECK(film.invalid_count == 20 * 2 && film.mean[0] == 0 && film.mean[1] == 1);
    ec_film_destroy(&film);
}

int main(void)
{
    any_order_of_batches();
    any_slices();
    what_is_shown();
    blocks_of_batches();
    nothing_twice();
    memory_is_bounded();
    memory_of_slices_is_bounded();
    shown_late_is_the_same();
    broken_values_are_counted_once();
    TEST_END();
}
