/* Seeds of kernels. Seeds that differ in one bit must give numbers that differ in every bit. */
#include "base/random.h"
#include "device/options.h"

uint32_t ec_render_seed(uint64_t seed) { return (uint32_t)(ec_random_mix(seed * EC_RANDOM_STEP + 1) >> 16); }

uint32_t ec_light_path_seed(uint32_t seed, uint32_t replicate) { return ec_render_seed(ec_random_mix(seed + EC_RANDOM_STEP) + replicate); }
