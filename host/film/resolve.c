#include "film/resolve.h"

#include <math.h>

#include "film/clamp.h"

static uint32_t least(uint32_t a, uint32_t b) { return a < b ? a : b; }

uint64_t ec_resolve_room(uint32_t width, uint32_t rows)
{
    return (uint64_t)width * (least(rows, EC_RESOLVE_ROWS) + 2 * EC_INTERVAL_REACH);
}

static void write_cut(const ec_film *film, uint64_t place, float clamped[2])
{
    const ec_cut cut = ec_film_cut(film, place);
    clamped[0] = (float)cut.mean;
    clamped[1] = (float)sqrt(cut.se2);
}

static void write(const ec_film *film, uint64_t place, const ec_pixel *pixel, uint64_t i, const ec_planes *planes)
{
    for (int c = 0; c < 3; c++) {
        if (planes->rgb) planes->rgb[3 * i + (uint64_t)c] = (float)pixel->mean[c];
        if (planes->stderr_rgb) planes->stderr_rgb[3 * i + (uint64_t)c] = (float)sqrt(ec_pixel_se2(pixel, c));
    }
    if (planes->stderr_y) planes->stderr_y[i] = (float)sqrt(ec_pixel_se2(pixel, 3));
    if (planes->clamped) write_cut(film, place, planes->clamped + 2 * i);
    const bool has_samples = !film->unsampled || !film->unsampled[place];
    if (planes->samples) planes->samples[i * planes->samples_stride] = has_samples ? (float)pixel->samples : 0.0f;
}

static ec_intervals_of intervals_from(const ec_intervals_of *all, uint64_t i)
{
    return (ec_intervals_of){all->low ? all->low + 3 * i : NULL, all->high ? all->high + 3 * i : NULL, all->heavy ? all->heavy + i : NULL};
}

/* Marks pixels as heavy, too, whose missing light may be more than their noise tells. Returns how many were not heavy before. */
static uint64_t mark_missing(const ec_film *film, uint32_t first, uint32_t rows, const ec_pixel *pixels, float *heavy)
{
    uint64_t count = 0, i = 0;
    for (uint32_t y = first; film->rare && y < first + rows; y++)
        for (uint32_t x = 0; x < film->width; x++, i++) {
            const double missing_light = ec_rare_missing_at(film->rare, pixels[i].samples, ec_luminance(pixels[i].mean), film->limit, x, y);
            if (heavy[i] != 0.0f || missing_light <= sqrt(ec_pixel_se2(&pixels[i], 3))) continue;
            heavy[i] = 1.0f;
            count++;
        }
    return count;
}

uint64_t ec_film_resolve_rows(const ec_film *film, uint32_t first, uint32_t rows, const ec_planes *planes, ec_pixel *room)
{
    const ec_intervals_of *all = &planes->intervals;
    const bool wants = all->low || all->high || all->heavy;
    const uint32_t width = film->width, reach = wants ? EC_INTERVAL_REACH : 0;
    uint64_t heavy = 0;
    for (uint32_t done = 0; done < rows; done += EC_RESOLVE_ROWS) {
        const uint32_t row = first + done, count = least(rows - done, EC_RESOLVE_ROWS);
        const uint32_t from = row < reach ? 0 : row - reach, to = least(row + count + reach, film->height);
        const uint64_t here = (uint64_t)(row - from) * width, before = (uint64_t)done * width;
        ec_film_look(film, (uint64_t)from * width, (uint64_t)(to - from) * width, room);
        for (uint64_t i = 0; i < (uint64_t)count * width; i++)
            write(film, (uint64_t)row * width + i, room + here + i, before + i, planes);
        const ec_intervals_of into = intervals_from(all, before);
        if (wants) heavy += ec_intervals(room, width, to - from, row - from, count, &into);
        if (all->heavy) heavy += mark_missing(film, row, count, room + here, into.heavy);
    }
    return heavy;
}

void ec_film_resolve(const ec_film *film, float *rgb, float *stderr_rgb)
{
    const uint64_t pixels = (uint64_t)film->width * film->height;
    ec_pixel piece[EC_PIXELS];
    for (uint64_t at = 0; at < pixels; at += EC_PIXELS) {
        const uint64_t count = pixels - at < EC_PIXELS ? pixels - at : EC_PIXELS;
        const ec_planes planes = {.rgb = rgb ? rgb + 3 * at : NULL, .stderr_rgb = stderr_rgb ? stderr_rgb + 3 * at : NULL};
        ec_film_look(film, at, count, piece);
        for (uint64_t i = 0; i < count; i++) write(film, at + i, piece + i, i, &planes);
    }
}
