/* Writes JPEG XL with libjxl, lossless. */
#include <jxl/encode.h>
#include <stdlib.h>

#include "image/gather.h"

static const char *settle(JxlEncoder *encoder, const ec_raster *of, JxlEncoderFrameSettings **frame)
{
    JxlBasicInfo info;
    JxlColorEncoding srgb;
    JxlEncoderInitBasicInfo(&info);
    info.xsize = of->width;
    info.ysize = of->height;
    info.bits_per_sample = of->bits;
    info.num_color_channels = 3;
    info.uses_original_profile = JXL_TRUE;
    if (of->channels == 4) info.num_extra_channels = 1, info.alpha_bits = of->bits;
    JxlColorEncodingSetToSRGB(&srgb, JXL_FALSE);
    *frame = JxlEncoderFrameSettingsCreate(encoder, NULL);
    const bool is_taken = *frame && JxlEncoderSetBasicInfo(encoder, &info) == JXL_ENC_SUCCESS && JxlEncoderSetColorEncoding(encoder, &srgb) == JXL_ENC_SUCCESS &&
                          JxlEncoderSetFrameLossless(*frame, JXL_TRUE) == JXL_ENC_SUCCESS;
    return is_taken ? NULL : "libjxl does not support such a picture";
}

/* Collects what libjxl has encoded, doubling the buffer until all of it fits. */
static const char *drain(JxlEncoder *encoder, uint8_t **bytes, size_t *size)
{
    size_t room = 0;
    JxlEncoderStatus status = JXL_ENC_NEED_MORE_OUTPUT;
    while (status == JXL_ENC_NEED_MORE_OUTPUT) {
        room = room ? 2 * room : 1 << 16;
        uint8_t *more = realloc(*bytes, room);
        if (!more) return "out of memory";
        *bytes = more;
        uint8_t *next = more + *size;
        size_t left = room - *size;
        status = JxlEncoderProcessOutput(encoder, &next, &left);
        *size = (size_t)(next - more);
    }
    return status == JXL_ENC_SUCCESS ? NULL : "libjxl failed";
}

static const char *encode(const ec_raster *of, const uint8_t *pixels, uint8_t **bytes, size_t *size)
{
    const JxlPixelFormat format = {of->channels, of->bits == 16 ? JXL_TYPE_UINT16 : JXL_TYPE_UINT8, JXL_BIG_ENDIAN, 0};
    const size_t length = (size_t)of->width * of->height * ec_raster_pixel_bytes(of);
    JxlEncoder *encoder = JxlEncoderCreate(NULL);
    JxlEncoderFrameSettings *frame;
    if (!encoder) return "out of memory";
    const char *why = settle(encoder, of, &frame);
    if (!why && JxlEncoderAddImageFrame(frame, &format, pixels, length) != JXL_ENC_SUCCESS) why = "libjxl rejects its pixels";
    JxlEncoderCloseInput(encoder);
    if (!why) why = drain(encoder, bytes, size);
    JxlEncoderDestroy(encoder);
    return why;
}

ec_encode *const ec_encode_jxl = encode;
