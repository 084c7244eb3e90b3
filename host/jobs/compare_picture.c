/* Reads a picture made for a screen: values of 8 or 16 bits, taken as sRGB, since colour profiles are not read. */
#include <stdlib.h>
#include <string.h>

#include "base/read_file.h"
#include "gltf/image_decode.h"
#include "jobs/compare_input.h"

/* Values may be off by this share of a step, as graphics cards may round so (Direct3D 11.3, section 3.2.3.6). */
static const double rounded = 0.6;

/* Names the format of a file. Only lossless WebP begins with the chunk VP8L. */
static void name_format(const uint8_t *bytes, size_t size, bool is_deep, ec_compare_input *input)
{
    const bool is_png = bytes[0] == 0x89, is_jpeg = bytes[0] == 0xff, is_webp = bytes[0] == 'R', is_kept = is_webp && size >= 16 && !memcmp(bytes + 12, "VP8L", 4);
    input->format = is_png ? is_deep ? "16-bit PNG" : "8-bit PNG" : is_jpeg ? "JPEG" : is_kept ? "lossless WebP" : is_webp ? "WebP" : is_deep ? "deep AVIF" : "8-bit AVIF";
    input->is_lossy = !is_png && !is_kept;
}

/* Excludes pixels that are not opaque, as they show what is behind them. */
static void take_alpha(const ec_image *image, uint64_t pixels, uint8_t *mask)
{
    for (uint64_t p = 0; p < pixels; p++) mask[p] = image->rgba8 ? image->rgba8[4 * p + 3] == 255 : image->rgba16[4 * p + 3] == 65535;
}

static ec_result take_pixels(const char *path, const ec_image *image, ec_compare_input *input, ec_error *err)
{
    const uint64_t pixels = (uint64_t)image->width * image->height;
    const float most = image->rgba8 ? 255 : 65535;
    input->rgb = malloc(3 * pixels * sizeof(float));
    input->slack = malloc(3 * pixels * sizeof(float));
    input->mask = malloc(pixels);
    if (!input->rgb || !input->slack || !input->mask)
        return ec_fail(err, "cannot compare '%s': %u x %u pixels do not fit into memory", path, image->width, image->height);
    for (uint64_t i = 0; i < 3 * pixels; i++) {
        uint64_t at = i / 3 * 4 + i % 3;
        input->rgb[i] = (float)(image->rgba8 ? image->rgba8[at] : image->rgba16[at]) / most;
        input->slack[i] = (float)rounded / most;
    }
    take_alpha(image, pixels, input->mask);
    if (!memchr(input->mask, 0, pixels)) {
        free(input->mask);
        input->mask = NULL;
    }
    input->measured = (ec_measured){.width = image->width, .height = image->height, .rgb = input->rgb, .slack = input->slack, .mask = input->mask,
                                    .replicates = INFINITY, .peak = 1};
    return EC_OK;
}

ec_result ec_compare_read_picture(const char *path, ec_compare_input *input, ec_error *err)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    ec_image image = {0};
    ec_decode_error why = {{0}, false};
    ec_result result;
    input->path = path;
    EC_TRY_CLEANUP(ec_read_file(path, &bytes, &size, err));
    if (!ec_image_decode(bytes, size, &image, &why)) {
        result = ec_fail(err, "cannot read '%s': %s", path, why.text);
        goto cleanup;
    }
    if (why.text[0]) {
        result = ec_fail(err, "cannot compare '%s': it is damaged: %s; save it again", path, why.text);
        goto cleanup;
    }
    name_format(bytes, size, image.rgba16 != NULL, input);
    EC_TRY_CLEANUP(take_pixels(path, &image, input, err));
cleanup:
    ec_image_free(&image);
    free(bytes);
    return result;
}
