/* Decodes AVIF with libavif. */
#include <avif/avif.h>
#include <stdlib.h>

#include "gltf/codecs.h"

const bool ec_has_avif = true;

/* A picture of one colour takes some hundred bytes, whatever its size: only the longest side limits it. */
#define PIXELS_PER_BYTE (1 << 24)

static bool convert(const avifImage *in, size_t length, ec_image *image, ec_decode_error *err)
{
    const char *reason = ec_image_check_size(in->width, in->height, length, PIXELS_PER_BYTE);
    if (reason) return ec_decode_fail(err, reason);
    avifRGBImage rgb;
    avifRGBImageSetDefaults(&rgb, in);
    const bool deep = in->depth > 8;
    rgb.format = AVIF_RGB_FORMAT_RGBA;
    rgb.depth = deep ? 16 : 8;
    rgb.rowBytes = rgb.width * (deep ? 8 : 4);
    rgb.pixels = malloc((size_t)rgb.rowBytes * rgb.height);
    if (!rgb.pixels) return ec_decode_out_of_memory(err);
    const avifResult result = avifImageYUVToRGB(in, &rgb);
    if (result != AVIF_RESULT_OK) {
        free(rgb.pixels);
        return ec_decode_fail(err, avifResultToString(result));
    }
    image->width = rgb.width;
    image->height = rgb.height;
    if (deep) image->rgba16 = (uint16_t *)(void *)rgb.pixels; /* malloc'ed, so aligned */
    else image->rgba8 = rgb.pixels;
    return true;
}

/* Decodes the first picture. The decoder's own limit of pixels is kept, since ec_image_check_size gets the size only after decoding. */
bool ec_image_decode_avif(const uint8_t *bytes, size_t length, ec_image *image, ec_decode_error *err)
{
    avifDecoder *decoder = avifDecoderCreate();
    if (!decoder) return ec_decode_out_of_memory(err);
    decoder->ignoreExif = decoder->ignoreXMP = AVIF_TRUE;
    decoder->maxThreads = 1;
    avifResult result = avifDecoderSetIOMemory(decoder, bytes, length);
    if (result == AVIF_RESULT_OK) result = avifDecoderParse(decoder);
    if (result == AVIF_RESULT_OK) result = avifDecoderNextImage(decoder);
    bool ok = result == AVIF_RESULT_OK && convert(decoder->image, length, image, err);
    if (result == AVIF_RESULT_OUT_OF_MEMORY) ec_decode_out_of_memory(err);
    else if (result != AVIF_RESULT_OK) ec_decode_fail(err, avifResultToString(result));
    avifDecoderDestroy(decoder);
    return ok;
}
