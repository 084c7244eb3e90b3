/* tier: quick */
/* Bits do not depend on who adds the batches, in which order, or in which slices; the figures are those of the definition. */
#include "support/film_batches.h"
#include "support/test.h"

enum { MOST = 5000 };

static test_random state = {7};

/* Batches 0 to count - 1; the last is one sample short. */
static ec_film cut_after(uint32_t count)
{
    ec_film film = slice(0, count - 1);
    ec_error err;
    CHECK_OK(add(&film, count - 1, 1, &err), err);
    return film;
}

static bool same(const ec_film *a, const ec_film *b)
{
    return films_same_bits(a, b) && films_same_features(a, b) && a->part_count == b->part_count && !memcmp(a->samples, b->samples, sizeof a->samples);
}

static void shuffle(uint32_t *order, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) order[i] = i;
    for (uint32_t i = count; i > 1; i--) {
        uint32_t k = (uint32_t)(test_uniform(&state) * i), kept = order[k];
        order[k] = order[i - 1];
        order[i - 1] = kept;
    }
}

static void any_order_of_batches(void)
{
    const uint32_t counts[] = {1, 2, 15, 16, 17, 48, 127, 128, 129, 255, 256, 257, 600, 2049};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        for (int trial = 0; trial < (counts[i] < 1000 ? 3 : 1); trial++) {
            uint32_t order[2049], n = counts[i];
            ec_film in_order = slice(0, n), mixed = empty();
            ec_error err;
            shuffle(order, n);
            for (uint32_t k = 0; k < n; k++) CHECK_OK(add(&mixed, order[k], 0, &err), err);
            CHECK_MSG(same(&in_order, &mixed), "%u batches", n);
            ec_film_destroy(&in_order);
            ec_film_destroy(&mixed);
        }
}

/* Cut anywhere, merged in any order, also through other merges. */
static void any_slices(void)
{
    const uint32_t counts[] = {5, 40, 300, 1000, MOST};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        uint32_t n = counts[i], cuts[8] = {0}, order[7];
        ec_film whole = slice(0, n), slices[7], halves[2] = {empty(), empty()}, all = empty();
        ec_error err;
        for (int k = 1; k < 7; k++) cuts[k] = cuts[k - 1] + (uint32_t)(test_uniform(&state) * (n - cuts[k - 1]) / 2);
        cuts[7] = n;
        for (int k = 0; k < 7; k++) slices[k] = slice(cuts[k], cuts[k + 1]);
        shuffle(order, 7);
        for (int k = 0; k < 7; k++) CHECK_OK(ec_film_take_parts(&halves[k % 2], &slices[order[k]], &err), err);
        for (int k = 1; k >= 0; k--) CHECK_OK(ec_film_take_parts(&all, &halves[k], &err), err);
        CHECK_MSG(same(&whole, &all), "%u batches", n);
        for (int k = 0; k < 7; k++) ec_film_destroy(&slices[k]);
        for (int k = 0; k < 2; k++) ec_film_destroy(&halves[k]);
        ec_film_destroy(&whole);
        ec_film_destroy(&all);
    }
}

/* The sums of these batches in double: a replicate's mean, its samples, and the tail of all. */
typedef struct reference {
    double mean[EC_REPLICATES_MOST][3], samples[EC_REPLICATES_MOST], all, largest, squares, fourths;
} reference;

static reference sum_up(const uint32_t *batches, uint32_t n, int p)
{
    reference sum = {0};
    for (uint32_t k = 0; k < n; k++) {
        const ec_batch_range range = ec_schedule_batch(replicates, batches[k]);
        const float *from = batch_of(batches[k]) + EC_BATCH_FIELDS * p;
        for (int c = 0; c < 3; c++) sum.mean[range.replicate][c] += (double)from[c] * range.samples;
        sum.samples[range.replicate] += range.samples;
        sum.all += range.samples;
        sum.largest = fmax(sum.largest, from[EC_BATCH_LARGEST]);
        sum.squares += from[EC_BATCH_SQUARES] * pow(from[EC_BATCH_LARGEST], 2);
        sum.fourths += from[EC_BATCH_FOURTHS] * pow(from[EC_BATCH_LARGEST], 4);
    }
    for (uint32_t r = 0; r < replicates; r++)
        for (int c = 0; c < 3 && sum.samples[r] > 0; c++) sum.mean[r][c] /= sum.samples[r];
    return sum;
}

/* A value is rounded at most 16 + 15 + 15 times by half an ulp, among values up to 10 i + 100. By chance the errors add up to less than a
 * tenth of that. */
static void figures_are_those_of_all_samples(const ec_film *film, const uint32_t *batches, uint32_t n)
{
    for (int p = 0; p < P; p++) {
        const ec_pixel pixel = films_pixel(film, (uint64_t)p);
        const reference sum = sum_up(batches, n, p);
        double mean[3] = {0}, m2[4] = {0}, m3 = 0, m4 = 0, has = 0;
        for (uint32_t r = 0; r < replicates; r++) has += sum.samples[r] > 0;
        for (uint32_t r = 0; r < replicates; r++)
            for (int c = 0; c < 3; c++) mean[c] += sum.samples[r] / sum.all * sum.mean[r][c];
        for (uint32_t r = 0; r < replicates; r++) {
            double d[3];
            for (int c = 0; c < 3; c++) d[c] = sqrt(has * sum.samples[r] / sum.all) * (sum.mean[r][c] - mean[c]), m2[c] += d[c] * d[c];
            m2[3] += pow(ec_luminance(d), 2);
            m3 += pow(ec_luminance(d), 3);
            m4 += pow(ec_luminance(d), 4);
        }
        const double rounding = 46 * 0x1p-24 * (mean[2] + 100) / 10;
        CHECK(pixel.n == has && pixel.samples == sum.all);
        for (int c = 0; c < 3; c++) CHECK_NEAR(pixel.mean[c], mean[c], rounding);
        for (int c = 0; c < 4; c++) CHECK_NEAR(sqrt(pixel.m2[c]), sqrt(m2[c]), 5 * rounding);
        CHECK_NEAR(pixel.m3, m3, 30 * rounding * m2[3]);
        CHECK_NEAR(pixel.m4, m4, 40 * rounding * pow(m2[3], 1.5));
        CHECK(pixel.tail[0] == (float)sum.largest);
        CHECK_NEAR(pixel.tail[1], sum.squares / pow(sum.largest, 2), 46 * 0x1p-23 * pixel.tail[1]);
        CHECK_NEAR(pixel.tail[2], sum.fourths / pow(sum.largest, 4), 46 * 0x1p-23 * pixel.tail[2]);
    }
}

static void features_are_those_of_all_samples(const ec_film *film, const uint32_t *batches, uint32_t n)
{
    double sum[3][EC_FILM_FEATURES * P] = {{0}}, samples[3] = {0};
    float own[EC_FILM_FEATURES * P];
    for (uint32_t k = 0; k < n; k++) {
        const ec_batch_range range = ec_schedule_batch(replicates, batches[k]);
        if (batches[k] >= feature_end) continue;
        for (uint32_t half = 0; half < 3; half++) {
            if (half < 2 && sets == 2 && range.replicate % 2 != half) continue;
            samples[half] += range.samples;
            for (uint32_t i = 0; i < EC_FILM_FEATURES * P; i++) sum[half][i] += (double)range.samples * feature(batches[k], i);
        }
    }
    CHECK(ec_film_feature_samples(film) == samples[EC_BOTH_HALVES]);
    for (uint32_t half = 0; half < 3; half++) {
        ec_film_features_of(film, half, 0, P, own);
        for (uint32_t i = 0; i < EC_FILM_FEATURES * P; i++) CHECK_NEAR(own[i], samples[half] > 0 ? sum[half][i] / samples[half] : 0, 46 * 0x1p-23);
    }
}

static void what_is_shown(void)
{
    static uint32_t all[MOST];
    for (uint32_t k = 0; k < MOST; k++) all[k] = k;
    const uint32_t ranges[][2] = {{0, 17}, {0, 700}, {5, 6}, {16, 17}, {3, 40}, {100, 900}, {128, 129}, {0, 4097}};
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        ec_film film = slice(ranges[i][0], ranges[i][1]);
        figures_are_those_of_all_samples(&film, all + ranges[i][0], ranges[i][1] - ranges[i][0]);
        if (sets) features_are_those_of_all_samples(&film, all + ranges[i][0], ranges[i][1] - ranges[i][0]);
        ec_film_destroy(&film);
    }
    ec_film gaps = slice(30, 70);
    ec_error err;
    const uint32_t list[] = {0, 1, 2, 16, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49, 50,
                             51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, 64, 65, 66, 67, 68, 69, 999};
    uint32_t n = sizeof list / sizeof *list;
    for (uint32_t k = 0; k < n; k++)
        if (list[k] < 30 || list[k] >= 70) CHECK_OK(add(&gaps, list[k], 0, &err), err);
    CHECK(gaps.batch_count == n && ec_film_end(&gaps) == 1000);
    figures_are_those_of_all_samples(&gaps, list, n);
    if (sets) features_are_those_of_all_samples(&gaps, list, n);
    ec_film_destroy(&gaps);
}

/* Sums of a block of batches that others have added up, sent a few pixels at a time. */
static void take_block(ec_film_part *part)
{
    enum { CUT = 4 };
    ec_error err;
    CHECK(ec_sums_create(&part->sums, replicates, sets, P));
    for (uint32_t first = 0, end; first < P; first = end) {
        ec_film piece;
        end = first ? P : CUT;
        CHECK_OK(ec_film_create(&piece, end - first, 1, replicates, &err), err);
        ec_film_want_features(&piece, sets, UINT32_MAX);
        for (uint32_t i = part->first; i < part->first + part->count; i++)
            CHECK_OK(ec_film_take(&piece, &(ec_film_batch){.index = i, .values = batch_of(i) + EC_BATCH_FIELDS * first, .features = features_of(i) + EC_FILM_FEATURES * first}, &err), err);
        ec_sums sums = ec_film_give_sums(&piece), here = ec_sums_from(&part->sums, first);
        float memory[(3 * EC_REPLICATES_MOST + 3 + 2 * EC_FILM_FEATURES) * P];
        const ec_sums sent = ec_sums_in(memory, replicates, sets, end - first);
        ec_sums_copy(&sent, &sums, end - first);
        ec_sums_copy(&here, &sent, end - first);
        ec_sums_destroy(&sums);
        ec_film_destroy(&piece);
    }
}

/* Blocks of EC_FILM_FIRST batches and of 16 times as many, among single batches. */
static void blocks_of_batches(void)
{
    enum { LARGE = EC_FILM_FIRST * EC_FILM_RADIX };
    ec_film in_order = slice(0, MOST), mixed = empty();
    ec_error err;
    for (uint32_t k = 0, count; k < MOST; k += count) {
        const uint32_t block = k == LARGE ? LARGE : EC_FILM_FIRST;
        count = k > 0 && k % block == 0 && k + block <= MOST ? block : 1;
        ec_film_part part = {.first = k, .count = count};
        if (count > 1) take_block(&part);
        if (count > 1) CHECK_OK(ec_film_insert(&mixed, &part, &err), err);
        else CHECK_OK(add(&mixed, k, 0, &err), err);
        CHECK(!part.sums.mean && bytes_of(&mixed) <= ec_film_bytes(replicates, sets, 0, k + count));
    }
    CHECK(same(&in_order, &mixed));
    ec_film_destroy(&in_order);
    ec_film_destroy(&mixed);
}

static void nothing_twice(void)
{
    ec_film film = slice(0, 40), other = slice(39, 60);
    ec_error err;
    CHECK(add(&film, 17, 0, &err) == EC_FAILED && strstr(err.text, "batches 17 to 17 occur twice"));
    CHECK(ec_film_take_parts(&film, &other, &err) == EC_FAILED && strstr(err.text, "batches 39 to 39 occur twice"));
    ec_film again = slice(0, 40);
    CHECK(same(&film, &again));
    ec_film_destroy(&film);
    ec_film_destroy(&other);
    ec_film_destroy(&again);
}

/* A picture that ended within its last batch, in any order and slices. No batch may follow it. */
static void a_cut_batch(void)
{
    const uint32_t ends[] = {20, 29, 130, 300}; /* all are beyond the strides of one sample */
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        const uint32_t n = ends[i];
        uint32_t order[300];
        ec_film in_order = cut_after(n), mixed = empty(), last = empty(), first = slice(0, n - 1), beyond = slice(n + 2, n + 4);
        ec_error err;
        shuffle(order, n);
        for (uint32_t k = 0; k < n; k++) {
            if (order[k] == n - 1) CHECK_OK(add(&mixed, n - 1, 1, &err), err);
            else CHECK_OK(add(&mixed, order[k], 0, &err), err);
        }
        CHECK_MSG(same(&in_order, &mixed) && mixed.cut == 1, "%u batches", n);
        CHECK(ec_film_samples_of_all(&mixed) == (double)ec_schedule_samples(replicates, n) - 1);
        CHECK_OK(add(&last, n - 1, 1, &err), err);
        CHECK_OK(ec_film_take_parts(&first, &last, &err), err);
        CHECK_MSG(same(&in_order, &first) && first.cut == 1, "%u batches", n);
        CHECK(ec_film_take_parts(&first, &beyond, &err) == EC_FAILED && strstr(err.text, "ended within batch"));
        CHECK(ec_film_take_parts(&beyond, &first, &err) == EC_FAILED && strstr(err.text, "ended within batch"));
        CHECK(same(&in_order, &first) && beyond.batch_count == 2 && !beyond.cut);
        CHECK(add(&beyond, n - 1, 1, &err) == EC_FAILED && strstr(err.text, "ended within batch"));
        ec_film_destroy(&in_order);
        ec_film_destroy(&mixed);
        ec_film_destroy(&last);
        ec_film_destroy(&first);
        ec_film_destroy(&beyond);
    }
}

/* One float is corrupted anywhere: in a single batch, or in a sum. Sums within the range of floats are kept. */
static void broken_and_huge_values(void)
{
    float broken[FIELDS] = {NAN, 1, INFINITY, INFINITY, 2, 2}, huge[FIELDS];
    ec_film film = empty(), far = empty();
    ec_error err;
    for (uint32_t k = 20; k > 0; k--) CHECK_OK(ec_film_add(&film, k - 1, broken, &err), err);
    ec_pixel pixel = films_pixel(&film, 0);
    CHECK(film.invalid_count == 20 * 2 && pixel.mean[0] == 0 && pixel.mean[1] == 1 && pixel.mean[2] == 0 && pixel.tail[0] == 0);
    for (uint32_t k = 300; k > 0; k--) {
        for (uint32_t i = 0; i < FIELDS; i++) huge[i] = i % EC_BATCH_FIELDS <= EC_BATCH_LARGEST ? k % 2 ? 1e38f : 3e38f : 1;
        CHECK_OK(ec_film_add(&far, k - 1, huge, &err), err);
    }
    pixel = films_pixel(&far, 1);
    CHECK(far.invalid_count == 0 && isfinite(pixel.mean[0]) && pixel.mean[0] >= (double)1e38f && pixel.mean[0] <= (double)3e38f);
    CHECK(pixel.tail[0] == 3e38f);
    CHECK_NEAR(pixel.tail[1], 150 + 150 / 9.0, 1e-3);
    CHECK_NEAR(pixel.tail[2], 150 + 150 / 81.0, 1e-3);
    ec_film_destroy(&film);
    ec_film_destroy(&far);
}

/* In any order and slices; pixels without features have zeros. */
static void features_of_the_first_batches(void)
{
    enum { END = 8, MANY = 300 };
    static uint32_t all[MANY], order[MANY];
    feature_end = END;
    for (uint32_t k = 0; k < MANY; k++) all[k] = k;
    ec_film in_order = slice(0, MANY), mixed = empty(), late = slice(64, 200), first = slice(0, 64), end = slice(200, MANY);
    ec_error err;
    shuffle(order, MANY);
    for (uint32_t k = 0; k < MANY; k++) CHECK_OK(add(&mixed, order[k], 0, &err), err);
    features_are_those_of_all_samples(&in_order, all, MANY);
    features_are_those_of_all_samples(&late, all + 64, 200 - 64);
    CHECK(same(&in_order, &mixed) && ec_film_features_at(&in_order, 1) && !ec_film_features_at(&late, 0));
    CHECK(!memcmp(ec_film_features_at(&in_order, 1), ec_film_features_at(&mixed, 0) + EC_FILM_FEATURES, (P - 1) * EC_FILM_FEATURES * sizeof(float)));
    CHECK_OK(ec_film_take_parts(&late, &end, &err), err);
    CHECK_OK(ec_film_take_parts(&late, &first, &err), err);
    CHECK(same(&in_order, &late));
    feature_end = UINT32_MAX;
    ec_film_destroy(&in_order);
    ec_film_destroy(&mixed);
    ec_film_destroy(&late);
    ec_film_destroy(&first);
    ec_film_destroy(&end);
}

int main(void)
{
    const uint32_t numbers[] = {EC_REPLICATES, 3, 1, EC_REPLICATES}; /* 3: no sum begins with the first replicate again */
    for (int i = 0; i < 4; i++) {
        replicates = numbers[i];
        sets = i % 3; /* sets of features; with two replicates or more there are halves */
        any_order_of_batches();
        any_slices();
        what_is_shown();
        blocks_of_batches();
        nothing_twice();
    }
    for (sets = 0; sets < 3; sets++) a_cut_batch();
    sets = 1;
    features_of_the_first_batches();
    sets = 0;
    broken_and_huge_values();
    TEST_END();
}
