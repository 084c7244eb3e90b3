/* tier: long */
/* Hundreds of random scenes with all the effects that they nearly need, in each integrator, and with kernels of their own. */
#include "support/effect_fuzz.h"

int main(void)
{
    const ec_integrator integrators[] = {EC_INTEGRATOR_PATH, EC_INTEGRATOR_WHITTED, EC_INTEGRATOR_PATH, EC_INTEGRATOR_RASTER};
    int lit = 0;
    for (uint64_t i = 0; i < 8; i++) {
        uint64_t set = ec_random_mix(2 * i + 1) & ec_random_mix(2 * i + 2) & EC_FEATURE_ALL; /* a quarter of the effects, and those that these need */
        lit += ef_run(10000 + 1000 * i, 25, EF_SHARED, integrators[i % 4], i % 4 ? EC_SCATTERING_MULTIPLE : EC_SCATTERING_SINGLE, set);
    }
    for (uint64_t seed = 50000; seed < 50100; seed++)
        lit += ef_run(seed, 1, EF_EXACT, EC_INTEGRATOR_PATH, (ec_scattering)(seed % 2), ef_few(seed));
    CHECK_MSG(lit >= 290, "only %d of 300 scenes are lit", lit);
    TEST_END();
}
