#include "pipeline/strips.h"

#include "base/memory.h"
#include "film/moments.h"
#include "film/parts.h"
#include "pipeline/team.h"

ec_strip_need ec_strip_needs(const ec_render_options *o)
{
    const uint64_t batch = ec_render_batch(o), batches = o->spp ? (o->spp + batch - 1) / batch : EC_FILM_RADIX;
    const uint64_t rows = 20 + 20, planes = 16 * (64 + 3), coded = 3 * 16 * 25 * 4; /* that wait, a band, and one being compressed: write_rows.c */
    const uint64_t film = o->slice_end ? ec_film_bytes(o->slice_first, o->slice_end) : ec_film_bytes(0, batches);
    return (ec_strip_need){.host = film + 12 + 32, .device = 12 + 32,
                           .column = rows * (EC_MOMENTS_BYTES + 32) + planes + coded};
}

uint64_t ec_strip_whole(const ec_render_options *o, bool shared)
{
    const ec_strip_need n = ec_strip_needs(o);
    return (uint64_t)o->width * o->height * (n.host + (shared ? n.device : 0)) + o->width * n.column;
}

uint64_t ec_strip_whole_for(const ec_render_options *o, const ec_device_info *devices, uint32_t count, uint32_t allies)
{
    const uint64_t pixels = (uint64_t)o->width * o->height;
    uint64_t bytes = ec_strip_whole(o, false);
    for (uint32_t i = 0; i < count; i++) bytes += devices[i].type & CL_DEVICE_TYPE_CPU ? pixels * ec_strip_needs(o).device : 0;
    return count + allies > 1 ? bytes + ec_team_bytes(count + allies, pixels, allies > 0) : bytes;
}

static uint64_t rows_in(uint64_t bytes, uint64_t width, uint64_t per_pixel) { return bytes / (width * per_pixel); }

uint32_t ec_strip_rows(const ec_render_options *o, bool shared, int64_t host, uint64_t device, uint64_t largest)
{
    const ec_strip_need n = ec_strip_needs(o);
    const uint64_t aside = o->width * n.column, left = host > (int64_t)aside ? (uint64_t)host - aside : 0;
    uint64_t rows = rows_in(left, o->width, n.host + (shared ? n.device : 0)), other = shared ? rows : rows_in(device, o->width, n.device);
    if (other < rows) rows = other;
    other = rows_in(largest, o->width, 32);
    if (other < rows) rows = other;
    return rows >= o->height ? o->height : (uint32_t)(rows / EC_STRIP_STEP * EC_STRIP_STEP);
}

int64_t ec_strip_budget(const ec_render_options *o, uint64_t coming)
{
    if (o->memory) return (int64_t)o->memory - (int64_t)(ec_memory_resident() + coming);
    const uint64_t unused = ec_memory_free();
    return unused >= INT64_MAX ? INT64_MAX : (int64_t)unused - (int64_t)coming;
}

uint64_t ec_strip_least(const ec_render_options *o, bool shared)
{
    ec_render_options one = *o;
    one.height = o->height < EC_STRIP_STEP ? o->height : EC_STRIP_STEP;
    return ec_strip_whole(&one, shared);
}

ec_result ec_strip_refuse(const ec_render_options *o, uint64_t whole, int64_t budget, const char *whole_for,
                          const char *instead, ec_error *err)
{
    return ec_fail(err, "%ux%u pixels take %.0f MB and there are %.0f: they would be rendered in strips, one after the other, but %s is for pictures that "
                        "are rendered whole; %s, or give more --memory or a smaller --size", o->width, o->height, (double)whole / 1e6,
                   budget > 0 ? (double)budget / 1e6 : 0.0, whole_for ? whole_for : "this", instead);
}
