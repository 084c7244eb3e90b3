/* Decodes KTX2 of KHR_texture_basisu, both ETC1S and UASTC, also compressed by Zstandard, with Basis Universal's transcoder. */
#include <basisu_transcoder.h>

#include <cstdlib>
#include <new>

extern "C" {
#include "gltf/codecs.h"
}

extern "C" const bool ec_has_basisu = true;

/* A picture of one colour takes some hundred bytes, whatever its size: only the longest side limits it. */
#define PIXELS_PER_BYTE (1 << 24)
/* A block of Zstandard takes at least four bytes, and holds at most 128 KiB. */
#define ZSTD_BYTES_PER_BYTE (1 << 15)

namespace {

/* Decodes the largest level. Returns nullptr, or a message if that fails. */
const char *transcode(const uint8_t *bytes, size_t length, ec_image *image, uint8_t *&pixels)
{
    static const bool is_ready = (basist::basisu_transcoder_init(), true);
    basist::ktx2_transcoder file;
    if (!is_ready || !file.init(bytes, uint32_t(length))) return "its KTX2 header is broken, or it is neither ETC1S nor UASTC";
    if (file.get_faces() != 1 || file.get_layers() > 1) return "it holds a cube or an array of pictures, not a single picture";
    if (const char *reason = ec_image_check_size(file.get_width(), file.get_height(), length, PIXELS_PER_BYTE)) return reason;
    const auto &level = file.get_level_index()[0]; /* the transcoder would clear as much memory as the level claims, up to 2 GiB */
    const bool claims_more = level.m_uncompressed_byte_length.get_uint64() / ZSTD_BYTES_PER_BYTE > level.m_byte_length.get_uint64();
    if (claims_more || !file.start_transcoding()) return "its KTX2 data are broken or truncated";
    const uint32_t count = file.get_width() * file.get_height();
    pixels = static_cast<uint8_t *>(malloc(4 * size_t(count)));
    if (!pixels) throw std::bad_alloc();
    if (!file.transcode_image_level(0, 0, 0, pixels, count, basist::transcoder_texture_format::cTFRGBA32)) return "its KTX2 data are broken or truncated";
    image->width = file.get_width();
    image->height = file.get_height();
    image->rgba8 = pixels;
    return nullptr;
}

} // namespace

extern "C" bool ec_image_decode_ktx2(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    uint8_t *pixels = nullptr;
    const char *wrong = nullptr;
    bool is_short = false;
    try {
        wrong = transcode(bytes, length, image, pixels);
    } catch (...) { /* thrown only for lack of memory */
        is_short = true;
    }
    if (!wrong && !is_short) return true;
    free(pixels);
    return is_short ? ec_decode_out_of_memory(err) : ec_decode_fail(err, wrong);
}
