#include "film/schedule.h"

enum { DOUBLING = 4, QUARTERED = 28 }; /* the first strides, which double; the stride up to which octaves have four; then all are of EC_BATCH_MOST
                                        * samples */

static uint64_t start_of(uint64_t stride)
{
    if (stride < DOUBLING) return stride < 3 ? stride : 4;
    if (stride >= QUARTERED) return 512 + EC_BATCH_MOST * (stride - QUARTERED);
    const uint64_t octave = (stride - DOUBLING) / 4, quarter = (stride - DOUBLING) % 4;
    return (2ull << octave) * (4 + quarter);
}

static uint32_t length_of(uint64_t stride) { return (uint32_t)(start_of(stride + 1) - start_of(stride)); }

static uint32_t log2_of(uint64_t n) { return 63 - (uint32_t)__builtin_clzll(n); }

/* The last stride that starts at or before sample n. Adaptive renders ask for every pixel in every pass. */
static uint64_t stride_at(uint64_t n)
{
    if (n >= 512) return QUARTERED + (n - 512) / EC_BATCH_MOST;
    if (n < 8) return n ? log2_of(n) + 1 : 0;
    const uint64_t octave = log2_of(n) - 3;
    return DOUBLING + 4 * octave + (n >> (octave + 1)) - 4;
}

static bool is_quarter(uint64_t n)
{
    uint64_t unit = 1;
    while (n >= 16 * unit) unit *= 2; /* n is 8 to 15 units */
    return n < 8 ? (n & (n - 1)) == 0 && n > 0 : n % (2 * unit) == 0;
}

ec_batch_range ec_schedule_batch(uint32_t replicates, uint32_t index)
{
    const uint64_t stride = index / replicates;
    return (ec_batch_range){.replicate = index % replicates, .samples = length_of(stride), .first = start_of(stride)};
}

uint64_t ec_schedule_samples(uint32_t replicates, uint32_t index)
{
    const uint64_t stride = index / replicates;
    return replicates * start_of(stride) + (uint64_t)(index % replicates) * length_of(stride);
}

static uint64_t share_before(uint32_t replicates, uint32_t replicate, uint64_t index)
{
    const uint64_t stride = index / replicates;
    return start_of(stride) + (replicate < index % replicates ? length_of(stride) : 0);
}

uint64_t ec_schedule_share(uint32_t replicates, uint32_t replicate, uint64_t first, uint64_t end)
{
    return share_before(replicates, replicate, end) - share_before(replicates, replicate, first);
}

uint32_t ec_schedule_find(uint32_t replicates, uint64_t samples, uint32_t *before)
{
    const uint64_t stride = stride_at(samples / replicates), length = length_of(stride);
    const uint64_t rest = samples - replicates * start_of(stride);
    *before = (uint32_t)(rest % length);
    return (uint32_t)(replicates * stride + rest / length);
}

uint64_t ec_schedule_round(uint32_t replicates, uint64_t index)
{
    uint64_t stride = index / replicates + 1;
    while (!is_quarter(start_of(stride))) stride++;
    return stride * replicates;
}

bool ec_schedule_is_round(uint32_t replicates, uint64_t index)
{
    return index > 0 && index % replicates == 0 && is_quarter(start_of(index / replicates));
}

uint32_t ec_schedule_step(uint64_t has) { return length_of(stride_at(has)); }
