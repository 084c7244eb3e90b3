/* Stands in for libdraco in builds without it: files that also hold the uncompressed mesh use that; others are refused because of their
 * extensionsRequired. */
#include "gltf/codecs.h"

const bool ec_has_draco = false;

ec_result ec_draco_decode(ec_gltf *g, ec_gltf_primitive *p, const uint8_t *bytes, uint64_t length, const char *where, ec_error *err)
{
    (void)p, (void)bytes, (void)length;
    return ec_fail(err, "%s: %s: built without libdraco", g->path, where);
}
