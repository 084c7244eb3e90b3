/* Writes AVIF with libavif. */
#include <avif/avif.h>
#include <stdlib.h>
#include <string.h>

#include "image/gather.h"

enum { QUANTIZER = 12, SPEED = 6 }; /* of 63, 0 being lossless; of 10, the fastest */

static const char *encode(const ec_raster *of, const uint8_t *pixels, uint8_t **bytes, size_t *size)
{
    avifRWData data = AVIF_DATA_EMPTY;
    avifImage *image = avifImageCreate(of->width, of->height, 8, AVIF_PIXEL_FORMAT_YUV444);
    avifEncoder *encoder = avifEncoderCreate();
    avifResult result = image && encoder ? AVIF_RESULT_OK : AVIF_RESULT_OUT_OF_MEMORY;
    if (result == AVIF_RESULT_OK) {
        avifRGBImage rgb;
        image->colorPrimaries = AVIF_COLOR_PRIMARIES_BT709;
        image->transferCharacteristics = AVIF_TRANSFER_CHARACTERISTICS_SRGB;
        image->matrixCoefficients = AVIF_MATRIX_COEFFICIENTS_BT601;
        image->yuvRange = AVIF_RANGE_FULL;
        avifRGBImageSetDefaults(&rgb, image);
        rgb.format = of->channels == 4 ? AVIF_RGB_FORMAT_RGBA : AVIF_RGB_FORMAT_RGB;
        rgb.depth = 8;
        rgb.rowBytes = of->width * of->channels;
        rgb.pixels = (uint8_t *)(uintptr_t)pixels; /* only read */
        encoder->minQuantizer = encoder->maxQuantizer = QUANTIZER;
        encoder->minQuantizerAlpha = encoder->maxQuantizerAlpha = AVIF_QUANTIZER_LOSSLESS;
        encoder->speed = SPEED;
        encoder->maxThreads = 1; /* so that the bytes are the same on all machines */
        result = avifImageRGBToYUV(image, &rgb);
    }
    if (result == AVIF_RESULT_OK) result = avifEncoderWrite(encoder, image, &data);
    if (result == AVIF_RESULT_OK) *bytes = malloc(data.size), *size = data.size;
    if (*bytes) memcpy(*bytes, data.data, data.size);
    avifRWDataFree(&data);
    if (image) avifImageDestroy(image);
    if (encoder) avifEncoderDestroy(encoder);
    return *bytes ? NULL : result == AVIF_RESULT_OK ? "out of memory" : avifResultToString(result);
}

ec_encode *const ec_encode_avif = encode;
