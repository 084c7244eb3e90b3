/* Writes Radiance .hdr: linear radiance in 8 bits and an exponent shared by the channels (format: hdr.c), rounded to nearest. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/atomic_file.h"
#include "image/formats.h"

enum { WIDTH_LEAST = 8, WIDTH_MOST = 0x7fff, RUN_LEAST = 4, RUN_MOST = 127, PLAIN_MOST = 128 };

typedef struct hdr_rows {
    ec_atomic_file file;
    uint32_t width;
    uint8_t *line, *packed; /* a row by components, and encoded */
} hdr_rows;

static void pack_pixel(const float rgb[3], uint8_t out[4])
{
    double v[3], most = 0;
    int exponent;
    for (int c = 0; c < 3; c++) v[c] = isfinite(rgb[c]) && rgb[c] > 0 ? rgb[c] : 0, most = fmax(most, v[c]);
    memset(out, 0, 4);
    if (most < 0x1p-127) return;
    if (frexp(most, &exponent) * 256 >= 255.5) exponent++; /* it would round to 256 */
    if (exponent > 127) exponent = 127;
    for (int c = 0; c < 3; c++) out[c] = (uint8_t)fmin(rint(ldexp(v[c], 8 - exponent)), 255);
    out[3] = (uint8_t)(exponent + 128);
}

/* A count above 128 repeats one byte, others precede as many bytes. */
static uint8_t *pack_runs(const uint8_t *values, uint32_t width, uint8_t *to)
{
    for (uint32_t x = 0, plain = 0; x < width || plain;) {
        uint32_t run = 1;
        while (x < width && x + run < width && run < RUN_MOST && values[x + run] == values[x]) run++;
        if (plain && (x == width || run >= RUN_LEAST || plain == PLAIN_MOST)) {
            *to++ = (uint8_t)plain;
            memcpy(to, values + x - plain, plain);
            to += plain;
            plain = 0;
        } else if (run >= RUN_LEAST) {
            *to++ = (uint8_t)(128 + run);
            *to++ = values[x];
            x += run;
        } else {
            plain++;
            x++;
        }
    }
    return to;
}

ec_result ec_hdr_begin(void **made, const char *path, const ec_raster *of, const ec_png_text *text, ec_error *err)
{
    char head[128];
    hdr_rows *r = calloc(1, sizeof *r);
    (void)text;
    *made = NULL;
    if (!r) return ec_fail(err, "out of memory for '%s'", path);
    *r = (hdr_rows){.file.fd = -1, .width = of->width, .line = malloc((size_t)4 * of->width), .packed = malloc((size_t)5 * of->width + 16)};
    const int size = snprintf(head, sizeof head, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n", of->height, of->width);
    ec_result result = r->line && r->packed ? ec_atomic_open(&r->file, path, err) : ec_fail(err, "out of memory for '%s'", path);
    if (result == EC_OK) result = ec_atomic_append(&r->file, head, (size_t)size, err);
    if (result == EC_OK) *made = r;
    else ec_hdr_abort(r);
    return result;
}

ec_result ec_hdr_put(void *rows, const void *pixels, uint32_t count, ec_error *err)
{
    hdr_rows *r = rows;
    const bool is_packed = r->width >= WIDTH_LEAST && r->width <= WIDTH_MOST;
    for (uint32_t y = 0; y < count; y++) {
        const float *rgb = (const float *)pixels + (size_t)3 * r->width * y;
        uint8_t pixel[4], *end = r->packed;
        for (uint32_t x = 0; x < r->width; x++) {
            pack_pixel(rgb + (size_t)3 * x, pixel);
            for (uint32_t c = 0; c < 4; c++) r->line[is_packed ? c * r->width + x : 4 * x + c] = pixel[c];
        }
        if (is_packed) {
            const uint8_t mark[4] = {2, 2, (uint8_t)(r->width >> 8), (uint8_t)r->width};
            memcpy(end, mark, sizeof mark);
            end += sizeof mark;
            for (uint32_t c = 0; c < 4; c++) end = pack_runs(r->line + (size_t)c * r->width, r->width, end);
        }
        EC_TRY(is_packed ? ec_atomic_append(&r->file, r->packed, (size_t)(end - r->packed), err)
                         : ec_atomic_append(&r->file, r->line, (size_t)4 * r->width, err));
    }
    return EC_OK;
}

ec_result ec_hdr_end(void *rows, ec_error *err)
{
    const ec_result result = ec_atomic_commit(&((hdr_rows *)rows)->file, err);
    ec_hdr_abort(rows);
    return result;
}

void ec_hdr_abort(void *rows)
{
    hdr_rows *r = rows;
    if (!r) return;
    ec_atomic_abort(&r->file);
    free(r->line);
    free(r->packed);
    free(r);
}
