/* Decodes meshopt data with libmeshoptimizer, which checks what it reads and returns non-zero if that is broken. */
#include <math.h>
#include <meshoptimizer.h>

#include "gltf/codecs.h"

const bool ec_has_meshopt = true;

/* Decodes the filter COLOR, which libmeshoptimizer has only from version 0.25 on: K bits each of Y, Co and Cg, and alpha below a bit that marks K.
 * `component` reads component i of an element with `bytes` bytes per component. */
static int component(const uint8_t *element, int i, int bytes)
{
    return bytes == 1 ? element[i] : element[2 * i] | element[2 * i + 1] << 8;
}

static void decode_color(uint8_t *element, int bytes)
{
    const int most = bytes == 1 ? 255 : 65535, stored = component(element, 3, bytes);
    int scale = 1;
    while (scale < stored) scale = 2 * scale + 1;
    const int y = component(element, 0, bytes), alpha = stored & scale >> 1;
    const int co = bytes == 1 ? (int8_t)component(element, 1, bytes) : (int16_t)component(element, 1, bytes);
    const int cg = bytes == 1 ? (int8_t)component(element, 2, bytes) : (int16_t)component(element, 2, bytes);
    const int rgba[4] = {y + co - cg, y + cg, y - co - cg, alpha << 1 | (alpha & 1)};
    for (int i = 0; i < 4; i++) {
        const float value = roundf((float)rgba[i] * ((float)most / (float)scale));
        const int whole = value < 0 ? 0 : value > (float)most ? most : (int)value;
        element[bytes * i] = (uint8_t)whole;
        if (bytes == 2) element[2 * i + 1] = (uint8_t)(whole >> 8);
    }
}

/* Recognises the format's version by the first byte. */
const char *ec_meshopt_hint(const ec_gltf_meshopt *p, const uint8_t *bytes)
{
    return p->mode == EC_MESHOPT_ATTRIBUTES && bytes[0] == 0xa1 && MESHOPTIMIZER_VERSION < 230
               ? ", or in version 2 of the format, which needs libmeshoptimizer 0.23 or later; build eclat with that, or export the file with EXT_meshopt_compression"
               : "";
}

bool ec_meshopt_decode(const ec_gltf_meshopt *p, const uint8_t *bytes, uint8_t *out)
{
    int failed = p->mode == EC_MESHOPT_ATTRIBUTES  ? meshopt_decodeVertexBuffer(out, p->count, p->stride, bytes, p->length)
                 : p->mode == EC_MESHOPT_TRIANGLES ? meshopt_decodeIndexBuffer(out, p->count, p->stride, bytes, p->length)
                                                   : meshopt_decodeIndexSequence(out, p->count, p->stride, bytes, p->length);
    if (failed) return false;
    if (p->filter == EC_MESHOPT_OCTAHEDRAL) meshopt_decodeFilterOct(out, p->count, p->stride);
    if (p->filter == EC_MESHOPT_QUATERNION) meshopt_decodeFilterQuat(out, p->count, p->stride);
    if (p->filter == EC_MESHOPT_EXPONENTIAL) meshopt_decodeFilterExp(out, p->count, p->stride);
    for (uint64_t i = 0; p->filter == EC_MESHOPT_COLOR && i < p->count; i++) decode_color(out + i * p->stride, p->stride == 4 ? 1 : 2);
    return true;
}
