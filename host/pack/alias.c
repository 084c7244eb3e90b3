#include "pack/alias.h"

#include <stdlib.h>
#include <string.h>

/* Random numbers r < 2^32 with r * n >> 32 == column start at `first` and their low words at `rest`, n apart. */
typedef struct column_range {
    uint64_t first, count, rest;
} column_range;

static column_range column_of(uint64_t column, uint64_t n)
{
    const uint64_t full = UINT64_C(1) << 32;
    uint64_t first = (column * full + n - 1) / n, next = ((column + 1) * full + n - 1) / n;
    return (column_range){first, next - first, first * n - column * full};
}

/* How many of a column's low words are below threshold. */
static uint64_t count_below(column_range c, uint64_t threshold, uint64_t n)
{
    if (threshold <= c.rest) return 0;
    uint64_t below = (threshold - c.rest + n - 1) / n;
    return below < c.count ? below : c.count;
}

/* Vose's two work lists share one array: the small ones from the left, the large ones from the right. */
static void pair_up(double *scaled, uint32_t n, uint32_t *work, ec_alias *table)
{
    uint32_t small = 0, large = n;
    for (uint32_t i = 0; i < n; i++) {
        table[i] = (ec_alias){UINT32_MAX, i};
        if (scaled[i] < 1.0)
            work[small++] = i;
        else
            work[--large] = i;
    }
    while (small > 0 && large < n) {
        uint32_t s = work[--small], l = work[large];
        table[s].other = l;
        double threshold = scaled[s] * 4294967296.0;
        table[s].threshold = threshold >= 4294967295.0 ? UINT32_MAX : (uint32_t)threshold;
        scaled[l] -= 1.0 - scaled[s];
        if (scaled[l] < 1.0) {
            large++;
            work[small++] = l;
        }
    }
}

/* Columns that kept weight but would be picked by no random number get the smallest threshold that one meets; columns of
 * no weight give all they have away. */
static void repair(const double *weights, uint32_t n, uint32_t heaviest, ec_alias *table)
{
    for (uint32_t i = 0; i < n; i++) {
        if (weights[i] > 0.0) {
            column_range c = column_of(i, n);
            if (table[i].threshold <= c.rest) table[i].threshold = (uint32_t)c.rest + 1u;
        } else {
            table[i].threshold = 0;
            if (table[i].other == i) table[i].other = heaviest;
        }
        if (!(weights[table[i].other] > 0.0)) table[i].other = heaviest;
    }
}

ec_result ec_alias_build(const double *weights, uint32_t n, ec_alias *table, double *pmf, ec_error *err)
{
    double sum = 0.0;
    uint32_t heaviest = 0;
    for (uint32_t i = 0; i < n; i++) {
        sum += weights[i];
        if (weights[i] > weights[heaviest]) heaviest = i;
    }
    if (!(sum > 0.0)) return ec_fail(err, "a distribution of %u entries has no weight", n);
    double *scaled = malloc(n * sizeof *scaled);
    uint32_t *work = malloc(n * sizeof *work);
    if (!scaled || !work) {
        free(scaled);
        free(work);
        return ec_fail(err, "out of memory for a distribution of %u entries", n);
    }
    for (uint32_t i = 0; i < n; i++) scaled[i] = weights[i] / sum * n;
    pair_up(scaled, n, work, table);
    repair(weights, n, heaviest, table);

    memset(pmf, 0, n * sizeof *pmf);
    for (uint32_t i = 0; i < n; i++) {
        column_range c = column_of(i, n);
        uint64_t own = count_below(c, table[i].threshold, n);
        pmf[i] += (double)own * 0x1p-32;
        pmf[table[i].other] += (double)(c.count - own) * 0x1p-32;
    }
    free(scaled);
    free(work);
    return EC_OK;
}
