/* Alias tables: the probabilities are those of the kernels' 2^32 random numbers, exactly. */
#include <stdbool.h>

#include "pack/alias.h"
#include "support/random.h"
#include "support/test.h"

static test_random numbers = {1};

/* What light_sample_one does with a random number. */
static uint32_t picked(const ec_alias *table, uint32_t n, uint32_t r)
{
    uint32_t column = (uint32_t)((uint64_t)r * n >> 32), rest = r * n;
    return rest < table[column].threshold ? column : table[column].other;
}

static void check_alias(uint32_t n, int kind)
{
    double *weights = malloc(n * sizeof *weights), *pmf = malloc(n * sizeof *pmf), sum = 0, total = 0, worst = 0;
    uint64_t *count = calloc(n, sizeof *count);
    ec_alias *table = malloc(n * sizeof *table);
    for (uint32_t i = 0; i < n; i++) {
        weights[i] = kind == 0 ? 1 : pow(10, 9 * test_uniform(&numbers) - 6);
        if (kind == 2 && i % 3 == 1) weights[i] = 0;
        sum += weights[i];
    }
    ec_error err = {0};
    CHECK_OK(ec_alias_build(weights, n, table, pmf, &err), err);
    for (uint32_t c = 0; c < n; c++) {
        uint64_t first = (((uint64_t)c << 32) + n - 1) / n, end = (((uint64_t)(c + 1) << 32) + n - 1) / n, low = first, high = end;
        while (low < high) { /* the column's numbers below its threshold come first */
            uint64_t middle = (low + high) / 2;
            if ((uint32_t)((uint32_t)middle * n) < table[c].threshold) low = middle + 1;
            else high = middle;
        }
        count[c] += low - first;
        count[table[c].other] += end - low;
        for (uint64_t r = first; r < end && r < first + 3; r++) CHECK(weights[picked(table, n, (uint32_t)r)] > 0);
        CHECK(end > first && weights[picked(table, n, (uint32_t)(end - 1))] > 0);
    }
    for (uint32_t i = 0; i < n; i++) {
        total += pmf[i];
        worst = fmax(worst, fabs(pmf[i] - weights[i] / sum));
        if ((double)count[i] * 0x1p-32 != pmf[i]) {
            CHECK_MSG(false, "alias table of %u: entry %u is picked %llu times in 2^32, not %.17g", n, i, (unsigned long long)count[i], pmf[i] * 0x1p32);
            break;
        }
        CHECK(weights[i] > 0 ? pmf[i] > 0 : pmf[i] == 0);
    }
    CHECK_MSG(total == 1.0, "alias table of %u: probabilities sum to %.17g", n, total);
    CHECK_MSG(worst <= 1e-9 + 4 * n * 0x1p-32, "alias table of %u: a probability is off by %g", n, worst);
    free(weights);
    free(pmf);
    free(count);
    free(table);
}

int main(void)
{
    for (int kind = 0; kind < 3; kind++)
        for (uint32_t n = 1; n <= 100000; n *= 10) check_alias(n + (uint32_t)kind * 2, kind);
    TEST_END();
}
