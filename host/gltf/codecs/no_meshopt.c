/* Stands in for libmeshoptimizer in builds without it: files with a fallback use that; others are refused because of their extensionsRequired. */
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
