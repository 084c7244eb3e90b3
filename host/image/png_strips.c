#include "image/png_strips.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "image/deflate.h"

enum { FILTERS = 5 };

const uint8_t ec_png_stream_head[2] = {0x78, 0x9c}; /* zlib: deflate, window of 32 KiB, default level */

void ec_png_stream_tail(const ec_png_strips *strips, uint8_t tail[4])
{
    for (int k = 0; k < 4; k++) tail[k] = (uint8_t)(strips->adler >> (24 - 8 * k));
}

static uint8_t paeth(int left, int up, int corner)
{
    const int p = left + up - corner, a = abs(p - left), b = abs(p - up), c = abs(p - corner);
    return (uint8_t)(a <= b && a <= c ? left : b <= c ? up : corner);
}

/* Filters a row: PNG specification (ISO/IEC 15948), 9.2. `above` is zeros for the first row. */
static void filter_row(int type, const uint8_t *row, const uint8_t *above, size_t bytes, size_t pixel, uint8_t *to)
{
    for (size_t i = 0; i < pixel; i++)
        to[i] = (uint8_t)(row[i] - (type == 2 || type == 4 ? above[i] : type == 3 ? above[i] / 2 : 0));
    switch (type) {
    case 0: memcpy(to, row, bytes); break;
    case 1: for (size_t i = pixel; i < bytes; i++) to[i] = (uint8_t)(row[i] - row[i - pixel]); break;
    case 2: for (size_t i = pixel; i < bytes; i++) to[i] = (uint8_t)(row[i] - above[i]); break;
    case 3: for (size_t i = pixel; i < bytes; i++) to[i] = (uint8_t)(row[i] - (row[i - pixel] + above[i]) / 2); break;
    default: for (size_t i = pixel; i < bytes; i++) to[i] = (uint8_t)(row[i] - paeth(row[i - pixel], above[i], above[i - pixel]));
    }
}

static uint64_t size_of_values(const uint8_t *bytes, size_t count)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < count; i++) sum += bytes[i] < 128 ? bytes[i] : 256u - bytes[i];
    return sum;
}

/* Filters with the type whose values, taken as signed, have the least sum of magnitudes: the heuristic of the specification, 12.8. `room`: a row. */
static void choose_filter(const uint8_t *row, const uint8_t *above, size_t bytes, size_t pixel, uint8_t *to, uint8_t *room)
{
    uint64_t least = UINT64_MAX;
    for (int type = 0; type < FILTERS; type++) {
        filter_row(type, row, above, bytes, pixel, room);
        const uint64_t sum = size_of_values(room, bytes);
        if (sum >= least) continue;
        least = sum;
        to[0] = (uint8_t)type;
        memcpy(to + 1, room, bytes);
    }
}

static bool make_room(ec_png_strip *strip, size_t bytes)
{
    if (!strip->deflate) strip->deflate = ec_deflate_create();
    if (strip->room >= bytes) return strip->deflate != NULL;
    free(strip->packed);
    strip->packed = malloc(bytes);
    strip->room = strip->packed ? bytes : 0;
    return strip->packed != NULL && strip->deflate != NULL;
}

static void pack(const ec_png_strips *s, ec_png_strip *strip, const uint8_t *first, uint32_t rows, bool is_last)
{
    const size_t line = s->row_bytes + 1;
    uint8_t *filtered = malloc(line * (rows + 1u) + EC_DEFLATE_PAST);
    strip->is_packed = false;
    if (filtered && make_room(strip, ec_deflate_bound(line * rows))) {
        for (uint32_t y = 0; y < rows; y++)
            choose_filter(first + y * s->row_bytes, first + y * s->row_bytes - s->row_bytes, s->row_bytes, s->pixel_bytes,
                          filtered + y * line, filtered + rows * line);
        strip->adler = adler32_z(adler32_z(0, NULL, 0), filtered, line * rows);
        strip->size = ec_deflate_pack(strip->deflate, is_last ? EC_DEFLATE_LAST : EC_DEFLATE_PART, filtered, line * rows, strip->packed, strip->room);
        strip->is_packed = strip->size > 0;
    }
    free(filtered);
}

bool ec_png_strips_create(ec_png_strips *s, uint32_t width, uint32_t height, uint32_t pixel_bytes)
{
    *s = (ec_png_strips){.row_bytes = (size_t)width * pixel_bytes, .pixel_bytes = pixel_bytes, .height = height, .strip_count = (uint32_t)omp_get_max_threads()};
    s->strip_rows = s->row_bytes < EC_PNG_STRIP_BYTES ? (uint32_t)(EC_PNG_STRIP_BYTES / s->row_bytes) : 1;
    if (s->strip_rows > height) s->strip_rows = height;
    s->adler = adler32_z(0, NULL, 0);
    s->strip = calloc(s->strip_count, sizeof *s->strip);
    s->rows = calloc(1u + (size_t)s->strip_rows * s->strip_count, s->row_bytes);
    if (s->strip && s->rows) return true;
    ec_png_strips_free(s);
    return false;
}

void ec_png_strips_free(ec_png_strips *s)
{
    for (uint32_t k = 0; s->strip && k < s->strip_count; k++) {
        ec_deflate_free(s->strip[k].deflate);
        free(s->strip[k].packed);
    }
    free(s->strip);
    free(s->rows);
    *s = (ec_png_strips){0};
}

static void pack_waiting(ec_png_strips *s)
{
    const uint8_t *first = s->rows + s->row_bytes;
    const uint32_t strips = (s->waiting + s->strip_rows - 1) / s->strip_rows;
    const bool is_end = s->done + s->waiting == s->height;
#pragma omp parallel for schedule(static, 1) if (strips > 1)
    for (uint32_t k = 0; k < strips; k++) {
        const uint32_t from = k * s->strip_rows, rows = s->waiting - from < s->strip_rows ? s->waiting - from : s->strip_rows;
        pack(s, &s->strip[k], first + from * s->row_bytes, rows, is_end && k == strips - 1);
    }
    for (uint32_t k = 0; k < strips; k++) {
        const uint32_t from = k * s->strip_rows, rows = s->waiting - from < s->strip_rows ? s->waiting - from : s->strip_rows;
        s->adler = adler32_combine(s->adler, s->strip[k].adler, (z_off_t)((s->row_bytes + 1) * rows));
    }
    memcpy(s->rows, first + (s->waiting - 1) * s->row_bytes, s->row_bytes);
    s->packed = strips;
    s->done += s->waiting;
    s->waiting = 0;
}

uint32_t ec_png_strips_put(ec_png_strips *s, const uint8_t *pixels, uint32_t count)
{
    const uint32_t room = s->strip_rows * s->strip_count - s->waiting, taken = count < room ? count : room;
    memcpy(s->rows + (1u + (size_t)s->waiting) * s->row_bytes, pixels, taken * s->row_bytes);
    s->waiting += taken;
    s->packed = 0;
    if (s->waiting == s->strip_rows * s->strip_count || s->done + s->waiting == s->height) pack_waiting(s);
    return taken;
}
