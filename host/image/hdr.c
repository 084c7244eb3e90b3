/* Reads Radiance .hdr. Format: G. Ward, "Real Pixels", Graphics Gems II (1991), and Radiance's "File Formats" (Ward, 1992). Values are mantissa *
 * 2^(exponent - 136), as in most readers (Radiance itself adds half a mantissa step). EXPOSURE lines are not applied, as in most readers;
 * ec_hdr_has_exposure tells of them. */
#include "image/hdr.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/freed.h"

/* SIDE_MAX in pixels: a header with more is taken for damaged. Only widths within the other range are run-length encoded. */
enum { SIDE_MAX = 1 << 17, RLE_WIDTH_MIN = 8, RLE_WIDTH_MAX = 0x7fff };

static const char cut_short[] = "it ends too early";

/* Reads header lines up to an empty one, then the size. Returns NULL, or what is wrong. */
static const char *read_header(FILE *file, uint32_t *width, uint32_t *height)
{
    char line[1024];
    bool format_known = false;
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

/* Reads without the library's locks, which would cost a call per byte, as only this thread uses the file. */
static bool read_bytes(FILE *file, uint8_t *bytes, size_t count) { return fread_unlocked(bytes, 1, count, file) == count; }

/* Reads a run-length encoded component of a scan line: a count above 128 repeats one byte, others precede as many bytes. */
static const char *read_runs(FILE *file, uint8_t *values, uint32_t width)
{
    for (uint32_t x = 0; x < width;) {
        int count = getc_unlocked(file);
        bool repeat = count > 128;
        if (repeat) count -= 128;
        if (count == EOF) return cut_short;
        if (count == 0 || (uint32_t)count > width - x) return "a run leaves its scan line";
        int value = repeat ? getc_unlocked(file) : 0;
        if (value == EOF) return cut_short;
        if (repeat) memset(values + x, value, (size_t)count);
        else if (!read_bytes(file, values + x, (size_t)count)) return cut_short;
        x += (uint32_t)count;
    }
    return NULL;
}

static void put(uint8_t *line, uint32_t width, uint32_t x, const uint8_t pixel[4])
{
    for (uint32_t k = 0; k < 4; k++) line[k * width + x] = pixel[k];
}

/* Reads plain pixels, beginning with `first`. A pixel with mantissas 1, 1, 1 repeats its predecessor, with a count of 8 more bits for each such pixel
 * in a row. */
static const char *read_plain(FILE *file, uint8_t *line, uint32_t width, const uint8_t first[4])
{
    int shift = 0;
    uint8_t pixel[4], last[4] = {0};
    memcpy(pixel, first, 4);
    for (uint32_t x = 0; x < width;) {
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            uint64_t count = shift < 32 ? (uint64_t)pixel[3] << shift : UINT64_MAX;
            if (x == 0 || count > width - x) return "a run leaves its scan line";
            for (; count > 0; count--) put(line, width, x++, last);
            shift += 8;
        } else {
            memcpy(last, pixel, 4);
            put(line, width, x++, pixel);
            shift = 0;
        }
        if (x < width && !read_bytes(file, pixel, 4)) return cut_short;
    }
    return NULL;
}

/* Reads a line; line: the four components, one after the other. */
static const char *read_line(FILE *file, uint8_t *line, uint32_t width)
{
    uint8_t start[4];
    if (!read_bytes(file, start, 4)) return cut_short;
    bool encoded = width >= RLE_WIDTH_MIN && width <= RLE_WIDTH_MAX && start[0] == 2 && start[1] == 2 && start[2] < 128;
    if (!encoded) return read_plain(file, line, width, start);
    if (((uint32_t)start[2] << 8 | start[3]) != width) return "a scan line has the wrong width";
    const char *problem = NULL;
    for (size_t component = 0; component < 4 && !problem; component++) problem = read_runs(file, line + component * width, width);
    return problem;
}

/* Converts a line. scale: by exponent. An 8-bit mantissa times a power of two from 2^-135 on is exact. */
static void to_floats(const uint8_t *line, uint32_t width, const float scale[256], float *rgb)
{
    const uint8_t *exponent = line + 3 * (size_t)width;
    for (uint32_t x = 0; x < width; x++)
        for (size_t c = 0; c < 3; c++) rgb[3 * (size_t)x + c] = line[c * width + x] * scale[exponent[x]];
}

static const char *read_pixels(FILE *file, uint32_t width, uint32_t height, float *rgb)
{
    float scale[256] = {0}; /* exponent 0 is black */
    EC_FREED uint8_t *line = malloc(4ul * width);
    const char *problem = line ? NULL : "out of memory";
    for (int e = 1; e < 256; e++) scale[e] = ldexpf(1, e - 136);
    for (uint32_t y = 0; y < height && !problem; y++) {
        problem = read_line(file, line, width);
        if (!problem) to_floats(line, width, scale, rgb + 3 * (size_t)y * width);
    }
    return problem;
}

bool ec_hdr_has_exposure(const char *path)
{
    char line[1024];
    FILE *file = fopen(path, "rb");
    double product = 1;
    bool is_radiance = file && fgets(line, sizeof line, file) && !strncmp(line, "#?", 2);
    while (is_radiance && fgets(line, sizeof line, file) && line[0] != '\n' && line[0] != '\r')
        if (!strncmp(line, "EXPOSURE=", 9)) product *= strtod(line + 9, NULL);
    if (file) fclose(file);
    return product != 1;
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
