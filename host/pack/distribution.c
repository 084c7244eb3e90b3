#include "pack/distribution.h"

/* Gives every positive weight one number, and its part of the others. */
void ec_distribution_share(const double *weights, uint32_t n, uint64_t first, uint64_t end_of_all, ec_distribution_entry *table, double *pmf)
{
    double sum = 0.0, before = 0.0;
    uint32_t positive = 0, seen = 0;
    for (uint32_t i = 0; i < n; i++) {
        sum += weights[i];
        positive += weights[i] > 0.0;
    }
    const uint64_t begin = first, others = end_of_all - begin - positive;
    for (uint32_t i = 0; i < n; i++) {
        before += weights[i];
        seen += weights[i] > 0.0;
        uint64_t end = begin + seen + (uint64_t)(before / sum * (double)others);
        if (seen == positive) end = end_of_all;
        table[i].first = (uint32_t)first; /* 2^32, behind the last positive weight, becomes 0: it is never looked at */
        pmf[i] = (double)(end - first) * 0x1p-32;
        first = end;
    }
}

void ec_distribution_build(const double *weights, uint32_t n, ec_distribution_entry *table, double *pmf)
{
    ec_distribution_share(weights, n, 0, (uint64_t)1 << 32, table, pmf);
    double end = pmf[0]; /* of entry i's share; exact */
    for (uint32_t bucket = 0, i = 0; bucket < n; bucket++) {
        uint64_t last = ((((uint64_t)bucket + 1) << 32) + n - 1) / n - 1; /* last number in the bucket r * n >> 32 */
        while (end * 0x1p32 <= (double)last) end += pmf[++i];
        table[bucket].guide = i;
    }
}

void ec_distribution_guide(uint32_t n, ec_distribution_entry *table)
{
    for (uint32_t bucket = 0, i = 0; bucket < n; bucket++) {
        const uint64_t last = ((((uint64_t)bucket + 1) << 32) + n - 1) / n - 1; /* last number in the bucket r * n >> 32 */
        while (i + 1 < n && table[i + 1].first <= last) i++;
        table[bucket].guide = i;
    }
}

uint64_t ec_distribution_stretch(uint64_t share)
{
    return share > 1 ? UINT64_MAX / share + (UINT64_MAX % share == share - 1) : UINT64_MAX;
}
