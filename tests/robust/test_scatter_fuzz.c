/* tier: full */
/* Materials that nobody would render on purpose. */
#include <stdlib.h>

#include "robust/cases.h"
#include "robust/scatter.h"

/* Random materials, directions and numbers, often at the ends of their ranges. */
static ec_result fuzz(ec_selftest *t, const char *more, uint32_t rounds, int judged, ec_error *err)
{
    static const char *const names[EC_FUZZ_COUNTS] = {
        "not finite", "negative", "direction not unit", "through what is opaque", "weight over 138.6",
    };
    ec_scatter_run run;
    uint64_t sums[EC_FUZZ_COUNTS] = {0};
    uint32_t n = EC_SCATTER_N, seed = 1, items = n / t->lanes;
    EC_TRY(ec_scatter_open_with(t, more, &run, err));
    uint32_t *counts = calloc((size_t)items * EC_FUZZ_COUNTS, sizeof *counts);
    const ec_array arrays[] = {EC_SCALAR(n), EC_SCALAR(rounds), EC_SCALAR(seed), EC_OUT(counts, (size_t)items * EC_FUZZ_COUNTS)};
    ec_result result = counts ? EC_OK : ec_fail(err, "out of memory for counts");
    if (result == EC_OK) result = ec_kernel_call(t->cl, run.program, "ec_scatter_fuzz", items, 64, arrays, 4, err);
    for (uint32_t i = 0; i < items * EC_FUZZ_COUNTS && result == EC_OK; i++) sums[i % EC_FUZZ_COUNTS] += counts[i];
    for (int k = 0; k < judged && result == EC_OK; k++)
        result = ec_selftest_none(t, names[k], sums[k], (uint64_t)n * rounds, NULL, err);
    free(counts);
    ec_scatter_close(&run);
    return result;
}

static ec_result fuzz_case(ec_selftest *t, ec_error *err) { return fuzz(t, "", 3072, EC_FUZZ_COUNTS, err); }

/* With all layers over the surface too. A coat and fibres are chosen by their reflectance at this angle, and their weights have no bound. */
static ec_result fuzz_layers_case(ec_selftest *t, ec_error *err)
{
    return fuzz(t, "+EC_FEATURE_ANISOTROPY+EC_FEATURE_CLEARCOAT+EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE+EC_FEATURE_SHEEN+EC_FEATURE_IRIDESCENCE"
                    "+EC_FEATURE_DIFFUSE_TRANSMISSION+EC_FEATURE_MULTISCATTER", 1024, EC_FUZZ_HEAVY, err);
}

int main(void)
{
    static const ec_selftest_case cases[] = {
        {"scatter/fuzz", false, fuzz_case, "NaN and fireflies"},
        {"scatter/fuzz, layers", false, fuzz_layers_case, "NaN and fireflies where effects meet"},
    };
    return RUN_CASES(cases);
}
