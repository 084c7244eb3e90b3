/* EXT_meshopt_compression through libmeshoptimizer, which checks what it reads and returns non-zero where that is broken. */
#include <meshoptimizer.h>

#include "gltf/codecs.h"

const bool ec_has_meshopt = true;

bool ec_meshopt_decode(const ec_gltf_meshopt *p, const uint8_t *bytes, uint8_t *out)
{
    int failed = p->mode == EC_MESHOPT_ATTRIBUTES  ? meshopt_decodeVertexBuffer(out, p->count, p->stride, bytes, p->length)
                 : p->mode == EC_MESHOPT_TRIANGLES ? meshopt_decodeIndexBuffer(out, p->count, p->stride, bytes, p->length)
                                                   : meshopt_decodeIndexSequence(out, p->count, p->stride, bytes, p->length);
    if (failed) return false;
    if (p->filter == EC_MESHOPT_OCTAHEDRAL) meshopt_decodeFilterOct(out, p->count, p->stride);
    if (p->filter == EC_MESHOPT_QUATERNION) meshopt_decodeFilterQuat(out, p->count, p->stride);
    if (p->filter == EC_MESHOPT_EXPONENTIAL) meshopt_decodeFilterExp(out, p->count, p->stride);
    return true;
}
