/* tiers: full, long */
/* Random scenes, to find effects that the scan misses. A few tens of scenes with few sets of effects, half of them with multiple scattering
 * and a smooth terminator; test_effects_fuzz_many.c has more. */
#include "support/effect_fuzz.h"

int main(void)
{
    static const uint64_t sets[] = {
        EC_FEATURE_EMISSION | EC_FEATURE_SHEEN | EC_FEATURE_ALPHA | EC_FEATURE_VERTEX_COLORS | EC_FEATURE_BASE_COLOR_TEXTURE |
            EC_FEATURE_CULLING | EC_FEATURE_MOTION | EC_FEATURE_SMOOTH_NORMALS,
        EC_FEATURE_ENVIRONMENT_MAP | EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_TRANSMISSION | EC_FEATURE_SMOOTH |
            EC_FEATURE_SMOOTH_NORMALS | EC_FEATURE_UNLIT | EC_FEATURE_NORMAL_TEXTURE,
    };
    const int many = test_tier("long") ? 15 : 8;
    int lit = 0;
    for (uint64_t i = 0; i < 2; i++) lit += ef_run(1000 * i, many, EF_SHARED, EC_INTEGRATOR_PATH, (ec_scattering)i, sets[i]);
    for (uint64_t i = 0; i < 2; i++) /* only the scan decides here about panes and nested bodies */
        lit += ef_run(5000 + i, 1, EF_EXACT, EC_INTEGRATOR_PATH, (ec_scattering)i, ef_few(5000 + i) | (i ? EC_FEATURE_TRANSMISSION : 0));
    CHECK_MSG(lit == 2 * many + 2, "only %d of %d scenes are lit", lit, 2 * many + 2);
    TEST_END();
}
