#include "render/strips.h"

#include <omp.h>

#include "base/memory.h"
#include "film/layer_films.h"
#include "film/resolve.h"
#include "render/team.h"

ec_strip_need ec_strip_needs(const ec_render_options *o)
{
    const uint32_t replicates = ec_render_replicates(o);
    uint32_t before;
    const uint64_t batches = o->spp ? ec_schedule_find(replicates, o->spp, &before) + 1ull : EC_FILM_FIRST;
    const uint64_t threads = (uint64_t)omp_get_max_threads(), around = EC_RESOLVE_ROWS + 2 * EC_INTERVAL_REACH;
    const uint64_t rows = 2 * around; /* rows that wait in write_rows.c; then a band, and what is being resolved and compressed of it: */
    const uint64_t planes = threads * 2 * 16 * (64 + 3 + 4 * EC_LAYER_PLANES * o->layers.count), coded = threads * 3 * 16 * 25 * 4, room = threads * around * sizeof(ec_pixel);
    const uint64_t first = o->slice_end ? o->slice_first : 0, end = o->slice_end ? o->slice_end : batches;
    const uint32_t sets = ec_render_feature_sets(o), all = ec_render_feature_end(o) == UINT32_MAX ? sets : 0; /* features of all batches; else of the first part */
    const uint64_t film = ec_film_bytes(replicates, 0, first, end), batch = 4 * EC_BATCH_FIELDS, features = 4 * EC_FILM_FEATURES;
    const uint64_t layers = o->layers.count, mattes = o->layers.mattes ? EC_MATTE_BYTES : 0;
    const uint64_t light = o->adaptive && o->light_paths > 0 ? film : 0; /* kept apart */
    const uint64_t pixel = film * layers + ec_film_bytes(replicates, all, first, end) + (all ? 0 : features * sets) + light, fresh = batch + features + layers * EC_LAYER_BYTES, beside = layers ? layers * EC_LAYER_BYTES + batch : 0;
    return (ec_strip_need){.host = pixel + fresh + beside + mattes, .device = fresh, .column = rows * pixel + room + planes + coded};
}

uint64_t ec_strip_whole(const ec_render_options *o)
{
    const ec_strip_need n = ec_strip_needs(o);
    return (uint64_t)o->width * o->height * n.host + o->width * n.column;
}

uint64_t ec_strip_whole_for(const ec_render_options *o, const ec_device_info *devices, uint32_t count, uint32_t peers)
{
    const uint64_t pixels = (uint64_t)o->width * o->height;
    uint64_t bytes = ec_strip_whole(o);
    if (count + peers == 1) return bytes;
    for (uint32_t i = 0; i < count; i++) bytes += devices[i].type & CL_DEVICE_TYPE_CPU ? pixels * ec_strip_needs(o).device : 0;
    return bytes + ec_team_bytes(count + peers, pixels, ec_render_replicates(o), ec_render_feature_sets(o), peers > 0);
}

static uint64_t rows_in(uint64_t bytes, uint64_t width, uint64_t per_pixel) { return bytes / (width * per_pixel); }

uint32_t ec_strip_rows(const ec_render_options *o, bool shared, int64_t host, uint64_t device, uint64_t largest)
{
    const ec_strip_need n = ec_strip_needs(o);
    const uint64_t aside = o->width * n.column, left = host > (int64_t)aside ? (uint64_t)host - aside : 0;
    uint64_t rows = rows_in(left, o->width, n.host), other = shared ? rows : rows_in(device, o->width, n.device);
    if (other < rows) rows = other;
    other = rows_in(largest, o->width, 32); /* 32 bytes a pixel: first-hit features, on the device */
    if (other < rows) rows = other;
    return rows >= o->height ? o->height : (uint32_t)(rows / EC_STRIP_STEP * EC_STRIP_STEP);
}

int64_t ec_strip_budget(const ec_render_options *o, uint64_t coming)
{
    if (o->memory) return (int64_t)o->memory - (int64_t)(ec_memory_resident() + coming);
    const uint64_t unused = ec_memory_free();
    return unused >= INT64_MAX ? INT64_MAX : (int64_t)unused - (int64_t)coming;
}

uint64_t ec_strip_least(const ec_render_options *o)
{
    ec_render_options one = *o;
    one.height = o->height < EC_STRIP_STEP ? o->height : EC_STRIP_STEP;
    return ec_strip_whole(&one);
}

ec_result ec_strip_refuse(const ec_render_options *o, uint64_t whole, int64_t budget, const char *whole_for,
                          const char *instead, ec_error *err)
{
    return ec_fail(err, "%ux%u pixels need %.0f MB, but %.0f MB are free, so they would be rendered in strips, "
                        "but %s needs the picture whole; %s, or give more --memory or a smaller --size", o->width, o->height, (double)whole / 1e6,
                   budget > 0 ? (double)budget / 1e6 : 0.0, whole_for ? whole_for : "this", instead);
}
