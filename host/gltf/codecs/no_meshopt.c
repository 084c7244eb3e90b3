/* Built without libmeshoptimizer: files with a fallback show that; others are refused by their extensionsRequired. */
#include "gltf/codecs.h"

const bool ec_has_meshopt = false;

const char *ec_meshopt_hint(const ec_gltf_meshopt *packed, const uint8_t *bytes)
{
    (void)packed, (void)bytes;
    return "";
}

bool ec_meshopt_decode(const ec_gltf_meshopt *packed, const uint8_t *bytes, uint8_t *out)
{
    (void)packed, (void)bytes, (void)out;
    return false;
}
