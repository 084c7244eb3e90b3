/* Decoders of optional libraries: each is a file in codecs/, which is replaced by one that only fails if its library was not found. Inside host/gltf/
 * only. */
#ifndef EC_GLTF_CODECS_H
#define EC_GLTF_CODECS_H

#include "gltf/gltf.h"
#include "gltf/image_decode.h"

extern const bool ec_has_avif, ec_has_basisu, ec_has_draco, ec_has_meshopt, ec_has_webp;

/* KHR_draco_mesh_compression: fills the accessors of a primitive, which then need no view. `where` names the primitive in messages. */
ec_result ec_draco_decode(ec_gltf *gltf, ec_gltf_primitive *primitive, const uint8_t *bytes, uint64_t length,
                          const char *where, ec_error *err);

/* EXT_meshopt_compression and KHR_meshopt_compression: decodes packed->count elements of packed->stride bytes to `out`, which has room for them.
 * Returns false if the data are broken or too new for the library; the hint, "" or text to append to the message, tells the latter. */
bool ec_meshopt_decode(const ec_gltf_meshopt *packed, const uint8_t *bytes, uint8_t *out);
const char *ec_meshopt_hint(const ec_gltf_meshopt *packed, const uint8_t *bytes);

/* EXT_texture_avif, KHR_texture_basisu and EXT_texture_webp; see ec_image_decode. */
bool ec_image_decode_ktx2(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err);
bool ec_image_decode_avif(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err);
bool ec_image_decode_webp(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err);

#endif
