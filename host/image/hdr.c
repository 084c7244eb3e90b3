/* Radiance .hdr in. Format: G. Ward, "Real Pixels", Graphics Gems II (1991), and Radiance's "File Formats" (Ward, 1992).
 * Values are mantissa * 2^(exponent - 136), as most readers have it (Radiance itself adds half a mantissa step);
 * EXPOSURE lines are not applied, as in most readers. */
#include "image/hdr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* SIDE_MAX in pixels: beyond it a header is taken for damaged. Only widths in the other range are run-length encoded. */
enum { SIDE_MAX = 1 << 17, RLE_WIDTH_MIN = 8, RLE_WIDTH_MAX = 0x7fff };

static const char cut_short[] = "it ends too early";

/* Header lines up to an empty one, then the picture's size. NULL or what is wrong. */
static const char *read_header(FILE *file, uint32_t *width, uint32_t *height)
{
    char line[1024];
    int format_known = 0;
    while (fgets(line, sizeof line, file) && line[0] != '\n' && line[0] != '\r') {
        if (strncmp(line, "FORMAT=", 7) != 0) continue;
        format_known = strncmp(line + 7, "32-bit_rle_rgbe", 15) == 0;
        if (!format_known) return "its FORMAT is not 32-bit_rle_rgbe";
    }
    unsigned long w = 0, h = 0;
    if (!format_known) return "its header names no FORMAT";
    if (!fgets(line, sizeof line, file)) return cut_short;
    if (sscanf(line, "-Y %7lu +X %7lu", &h, &w) != 2) return "its size is not given as '-Y height +X width'";
    if (w < 1 || h < 1 || w > SIDE_MAX || h > SIDE_MAX) return "its size is not usable";
    *width = (uint32_t)w;
    *height = (uint32_t)h;
    return NULL;
}

/* One component of a scan line, run-length encoded: a count above 128 repeats one byte, others precede as many bytes. */
static const char *read_runs(FILE *file, uint8_t *rgbe, uint32_t width)
{
    for (uint32_t x = 0; x < width;) {
        int count = getc(file);
        int repeat = count > 128;
        if (repeat) count -= 128;
        if (count == EOF) return cut_short;
        if (count == 0 || (uint32_t)count > width - x) return "a run leaves its scan line";
        int value = 0;
        for (int i = 0; i < count; i++) {
            if (i == 0 || !repeat) value = getc(file);
            if (value == EOF) return cut_short;
            rgbe[4 * x++] = (uint8_t)value;
        }
    }
    return NULL;
}

/* Plain pixels from `first` on; a pixel of mantissas 1, 1, 1 repeats its predecessor, by 8 more bits each time in a row. */
static const char *read_plain(FILE *file, uint8_t *rgbe, uint32_t width, const uint8_t first[4])
{
    int shift = 0;
    uint8_t pixel[4];
    memcpy(pixel, first, 4);
    for (uint32_t x = 0; x < width;) {
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            uint64_t count = shift < 32 ? (uint64_t)pixel[3] << shift : UINT64_MAX;
            if (x == 0 || count > width - x) return "a run leaves its scan line";
            for (; count > 0; count--, x++) memcpy(rgbe + 4 * x, rgbe + 4 * (x - 1), 4);
            shift += 8;
        } else {
            memcpy(rgbe + 4 * x++, pixel, 4);
            shift = 0;
        }
        if (x < width && fread(pixel, 1, 4, file) != 4) return cut_short;
    }
    return NULL;
}

static const char *read_line(FILE *file, uint8_t *rgbe, uint32_t width)
{
    uint8_t start[4];
    if (fread(start, 1, 4, file) != 4) return cut_short;
    int encoded = width >= RLE_WIDTH_MIN && width <= RLE_WIDTH_MAX && start[0] == 2 && start[1] == 2 && start[2] < 128;
    if (!encoded) return read_plain(file, rgbe, width, start);
    if (((uint32_t)start[2] << 8 | start[3]) != width) return "a scan line has the wrong width";
    const char *problem = NULL;
    for (int component = 0; component < 4 && !problem; component++) problem = read_runs(file, rgbe + component, width);
    return problem;
}

static const char *read_pixels(FILE *file, uint32_t width, uint32_t height, float *rgb)
{
    uint8_t *rgbe = malloc(4ul * width);
    const char *problem = rgbe ? NULL : "out of memory";
    for (uint32_t y = 0; y < height && !problem; y++) {
        problem = read_line(file, rgbe, width);
        for (uint32_t x = 0; x < width && !problem; x++, rgb += 3)
            for (int c = 0; c < 3; c++) rgb[c] = rgbe[4 * x + 3] ? ldexpf(rgbe[4 * x + c], rgbe[4 * x + 3] - 136) : 0;
    }
    free(rgbe);
    return problem;
}

ec_result ec_hdr_read(FILE *file, const char *path, uint32_t *width, uint32_t *height, float **rgb, ec_error *err)
{
    *rgb = NULL;
    const char *problem = read_header(file, width, height);
    if (!problem) {
        *rgb = malloc(3 * sizeof(float) * *width * *height);
        problem = *rgb ? read_pixels(file, *width, *height, *rgb) : "out of memory";
    }
    if (!problem) return EC_OK;
    free(*rgb);
    *rgb = NULL;
    return ec_fail(err, "cannot read '%s': %s; replace the file or convert it to OpenEXR", path, problem);
}
