/* tier: quick */
/* The samples of each batch: every sample of every replicate once; rounds, at which limits are checked; and the conversion of samples to
 * batches. */
#include "film/schedule.h"
#include "support/test.h"

enum { STRIDES = 400 }; /* of up to 24320 samples */

/* Ends of rounds by the text of schedule.h: 1, 2, 4, 8, then 10, 12, 14, 16, 20, … */
static bool is_end_of_a_round(uint64_t samples)
{
    uint64_t power = 8;
    while (2 * power <= samples) power *= 2;
    return samples < 8 ? samples == 1 || samples == 2 || samples == 4 : samples % (power / 4) == 0;
}

static bool is_end_of_a_stride(uint64_t samples) { return samples < 512 ? is_end_of_a_round(samples) : samples % 64 == 0; }

static void every_sample_once(uint32_t replicates)
{
    uint64_t has[EC_REPLICATES_MOST] = {0}, all = 0;
    for (uint32_t b = 0; b < STRIDES * replicates; b++) {
        const ec_batch_range range = ec_schedule_batch(replicates, b);
        CHECK(range.replicate == b % replicates && range.first == has[range.replicate]);
        CHECK(range.samples >= 1 && range.samples <= EC_BATCH_MOST && ec_schedule_step(range.first) == range.samples);
        CHECK(ec_schedule_samples(replicates, b) == all);
        const bool is_round = b > 0 && b % replicates == 0 && is_end_of_a_round(has[0]);
        CHECK_MSG(ec_schedule_is_round(replicates, b) == is_round, "%u batches of %u replicates", b, replicates);
        CHECK(ec_schedule_has_pilot(replicates, b) == (has[replicates - 1] >= 4 && has[replicates - 1] * replicates >= 32));
        for (uint32_t r = 0; r < replicates; r++) CHECK(ec_schedule_share(replicates, r, 0, b) == has[r]);
        has[range.replicate] += range.samples;
        all += range.samples;
        CHECK(is_end_of_a_stride(has[range.replicate]));
    }
}

/* A range of batches is the sum of its replicates' parts. */
static void shares_sum_up(uint32_t replicates)
{
    for (uint32_t first = 0; first < 300; first += 7)
        for (uint32_t end = first; end < 2000; end += 61) {
            uint64_t sum = 0;
            for (uint32_t r = 0; r < replicates; r++) sum += ec_schedule_share(replicates, r, first, end);
            CHECK(sum == ec_schedule_samples(replicates, end) - ec_schedule_samples(replicates, first));
        }
}

/* Any number of samples is a number of whole batches and a part of the next. */
static void samples_are_found(uint32_t replicates)
{
    for (uint64_t samples = 0; samples < 40000; samples += samples < 3000 ? 1 : 37) {
        uint32_t before, batch = ec_schedule_find(replicates, samples, &before);
        CHECK_MSG(ec_schedule_samples(replicates, batch) + before == samples && before < ec_schedule_batch(replicates, batch).samples,
                  "%llu samples of %u replicates: batch %u, %u before", (unsigned long long)samples, replicates, batch, before);
    }
    for (uint32_t b = 0; b < 3000; b++) {
        uint32_t before;
        CHECK(ec_schedule_find(replicates, ec_schedule_samples(replicates, b), &before) == b && before == 0);
    }
}

/* The next round is the first one after; between two rounds samples grow by at most a quarter, and at least a seventh. */
static void rounds_follow(uint32_t replicates)
{
    uint64_t rounds = 0;
    for (uint64_t n = 0, next; n < 3000 * replicates; n = next, rounds++) {
        next = ec_schedule_round(replicates, n);
        CHECK(next > n && ec_schedule_is_round(replicates, next));
        for (uint64_t k = n + 1; k < next && k < n + 100; k++) CHECK(!ec_schedule_is_round(replicates, k) && ec_schedule_round(replicates, k) == next);
        const double has = (double)ec_schedule_samples(replicates, (uint32_t)n), then = (double)ec_schedule_samples(replicates, (uint32_t)next);
        if (has >= 8 * replicates) CHECK_MSG(then <= 1.25 * has && then >= 8 / 7.0 * has, "%g samples after %g", then, has);
    }
    /* 2^17.5 samples in a replicate: 14.5 octaves from 8 on. */
    CHECK_MSG(rounds > 4 * 14 && rounds <= 4 + 4 * 15, "%llu rounds", (unsigned long long)rounds);
}

static void beginnings(void)
{
    const uint64_t starts[] = {0, 1, 2, 4, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40}, late[] = {384, 448, 512, 576, 640, 704};
    for (uint32_t i = 0; i < sizeof starts / sizeof *starts; i++) CHECK(ec_schedule_batch(8, 8 * i).first == starts[i]);
    for (uint32_t i = 0; i < sizeof late / sizeof *late; i++) CHECK(ec_schedule_batch(8, 8 * (26 + i)).first == late[i]);
    CHECK(!ec_schedule_is_round(8, 0) && ec_schedule_round(8, 0) == 8 && ec_schedule_round(8, 7) == 8 && ec_schedule_round(8, 8) == 16);
    CHECK(ec_schedule_is_round(8, 8 * 28) && !ec_schedule_is_round(8, 8 * 29) && ec_schedule_round(8, 8 * 28) == 8 * 30); /* 512, 576, 640 */
}

int main(void)
{
    const uint32_t replicates[] = {1, 3, EC_REPLICATES, EC_REPLICATES_MOST};
    beginnings();
    for (int i = 0; i < 4; i++) {
        every_sample_once(replicates[i]);
        shares_sum_up(replicates[i]);
        samples_are_found(replicates[i]);
        rounds_follow(replicates[i]);
    }
    TEST_END();
}
