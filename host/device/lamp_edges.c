#include "device/lamp_edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/luminance.h"
#include "device/adaptive.h"
#include "device/lamp_tiles.h"
#include "film/schedule.h"

#define SEED 0x7f4a7c15u /* the same for all pictures */
#define DARK 16.0f       /* lamps that are so many times darker than the brightest in sight have no edges … */
#define LIT 4.0f         /* … nor have those that are not so many times brighter than the environment, which surfaces may be as bright as */

/* Luminance of the lamps that each pixel's ray meets, in row order; and the greatest of all. */
typedef struct sight {
    float *seen, most;
} sight;

static ec_result send_params(ec_pipeline *p, ec_error *err)
{
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err);
}

static ec_result make_room(ec_pipeline *p, uint32_t entries, ec_error *err)
{
    const uint64_t bytes = 4ull * EC_LIST_WORDS * entries, slack = 64 * 4 * EC_LIST_WORDS; /* lanes past the last sample read too */
    if (entries <= p->edges.room) return EC_OK;
    free(p->edges.list);
    ec_buffer_release(p->cl, &p->buffers[EC_ARG_EDGE_LIST]);
    p->edges.room = 0;
    p->edges.list = malloc(bytes);
    if (!p->edges.list) return ec_fail(err, "out of memory for the edges of lamps");
    EC_TRY(ec_buffer_create(p->cl, "edges of lamps in a wave", bytes + slack, NULL, &p->buffers[EC_ARG_EDGE_LIST], err));
    p->edges.room = entries;
    return EC_OK;
}

/* The list may change once the wave, or the rays, have been waited for. */
static ec_result send_list(ec_pipeline *p, uint32_t entries, ec_error *err)
{
    return ec_buffer_write_later(p->cl, p->buffers[EC_ARG_EDGE_LIST], 4ull * EC_LIST_WORDS * entries, p->edges.list, err);
}

/* Traces the rays of the list's first entries. rgb: room for what they see. */
static ec_result look(ec_pipeline *p, uint32_t count, float *rgb, sight *of, ec_error *err)
{
    EC_TRY(send_list(p, count, err));
    EC_TRY(ec_pipeline_run_edge_rays(p, SEED, count, err));
    for (uint64_t c = 0; c < 3; c++) EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_RADIANCE], 4 * c * p->wave, 4ull * count, rgb + c * count, err));
    for (uint32_t i = 0; i < count; i++) {
        const float y = (float)ec_luminance_of_floats((float[3]){rgb[i], rgb[count + i], rgb[2 * (size_t)count + i]});
        if (!isfinite(y)) continue;
        of->seen[ec_pixel_place(&p->params, p->edges.list[EC_LIST_WORDS * (size_t)i] - p->params.edge_numbers)] = y;
        of->most = fmaxf(of->most, y);
    }
    return EC_OK;
}

/* Traces one camera ray through each pixel of the tiles. */
static ec_result look_at_tiles(ec_pipeline *p, const ec_lamp_tiles *tiles, sight *of, ec_error *err)
{
    EC_FREED float *rgb = malloc(3 * (size_t)p->wave * sizeof *rgb);
    uint32_t count = 0, first;
    if (!rgb) return ec_fail(err, "out of memory for the edges of lamps");
    EC_TRY(make_room(p, p->wave, err));
    for (uint32_t tile = 0; tile < tiles->columns * tiles->rows; tile++) {
        if (!tiles->may[tile]) continue;
        const uint32_t pixels = ec_lamp_tile_numbers(&p->params, tiles, tile, &first);
        if (count + pixels > p->wave) {
            EC_TRY(look(p, count, rgb, of, err));
            count = 0;
        }
        for (uint32_t i = 0; i < pixels; i++, count++) {
            p->edges.list[EC_LIST_WORDS * (size_t)count] = p->params.edge_numbers + first + i;
            p->edges.list[EC_LIST_WORDS * (size_t)count + 1] = 0;
        }
    }
    return count ? look(p, count, rgb, of, err) : EC_OK;
}

/* Returns whether lamps differ among the 3 x 3 pixels around one. */
static bool is_edge(const ec_params *params, const float *seen, uint32_t place, float least)
{
    const uint32_t width = params->width, x = place % width, y = place / width;
    float low = seen[place], high = low;
    for (uint32_t j = y ? y - 1 : 0; j <= y + 1 && j < params->height; j++)
        for (uint32_t i = x ? x - 1 : 0; i <= x + 1 && i < width; i++) {
            low = fminf(low, seen[(size_t)j * width + i]);
            high = fmaxf(high, seen[(size_t)j * width + i]);
        }
    return high - low > least && high > LIT * low;
}

/* Sets the bits of pixels with an edge; returns whether there is one. */
static bool mark(const ec_params *params, const ec_lamp_tiles *tiles, const float *seen, float least, uint32_t *marks)
{
    const uint32_t count = tiles->columns * tiles->rows;
    uint32_t first;
    bool any = false;
    for (uint32_t tile = 0; tile < count; tile++)
        for (uint32_t i = 0, pixels = tiles->may[tile] ? ec_lamp_tile_numbers(params, tiles, tile, &first) : 0; i < pixels; i++) {
            if (!is_edge(params, seen, ec_pixel_place(params, first + i), least)) continue;
            marks[(first + i) / 32] |= 1u << (first + i) % 32;
            any = true;
        }
    return any;
}

/* Finds edges by one sample a pixel, which does not count among the picture's rays. */
static ec_result find(ec_pipeline *p, const ec_lamp_tiles *tiles, float least, bool *any, ec_error *err)
{
    const uint32_t pixels = p->params.width * p->params.height, batch = p->params.batch, first_sample = p->params.first_sample;
    const uint64_t rays = p->rays, words = pixels / 32 + 1;
    EC_FREED float *seen = calloc(pixels, sizeof *seen);
    sight all = {seen, 0};
    p->edges.marks = calloc(words, sizeof *p->edges.marks);
    if (!seen || !p->edges.marks) return ec_fail(err, "out of memory for the edges of lamps");
    EC_TRY(ec_buffer_create(p->cl, "edges of lamps", 4 * words, p->edges.marks, &p->buffers[EC_ARG_EDGES], err));
    p->params.edge_numbers = EC_REPLICATES_MOST * pixels;
    p->params.batch = 1;
    p->params.first_sample = 0;
    EC_TRY(send_params(p, err));
    EC_TRY(look_at_tiles(p, tiles, &all, err));
    p->params.batch = batch;
    p->params.first_sample = first_sample;
    p->rays = rays;
    *any = mark(&p->params, tiles, seen, fmaxf(least, all.most / DARK), p->edges.marks);
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_EDGES], 0, 4 * words, p->edges.marks, err);
}

static void forget(ec_pipeline *p)
{
    free(p->edges.marks);
    p->edges.marks = NULL;
    p->edges.positions = p->params.edge_numbers = 0;
    ec_buffer_release(p->cl, &p->buffers[EC_ARG_EDGES]);
}

ec_result ec_lamp_edges_find(ec_pipeline *p, ec_error *err)
{
    const uint64_t pixels = (uint64_t)p->params.width * p->params.height;
    const float least = LIT * (float)ec_luminance_of_floats(p->params.environment_mean);
    ec_lamp_tiles tiles = {.may = NULL};
    bool any = false;
    forget(p);
    if (!ec_pipeline_edges_can_be(p) || 2 * EC_REPLICATES_MOST * pixels > UINT32_MAX) return EC_OK;
    ec_result result = ec_lamp_tiles_find(p, least, &tiles, err);
    if (result == EC_OK && memchr(tiles.may, 1, (size_t)tiles.columns * tiles.rows)) result = find(p, &tiles, least, &any, err);
    free(tiles.may);
    if (!any) forget(p);
    return result == EC_OK ? send_params(p, err) : result;
}

static bool is_marked(const ec_pipeline *p, uint32_t number)
{
    const uint32_t at = number % (p->params.width * p->params.height);
    return p->edges.marks[at / 32] >> at % 32 & 1;
}

/* Returns the list's entry for pixel i after `first` or, without a list, `own` with the pixel's number and 0. */
static const uint32_t *entry_of(const uint32_t *list, uint32_t first, uint32_t i, uint32_t own[EC_LIST_WORDS])
{
    if (list) return list + EC_LIST_WORDS * (size_t)(first + i);
    own[0] = first + i;
    own[1] = 0;
    return own;
}

/* Returns how many of the next `most` pixels a wave has room for, with their rays; *marked: how many of these have rays. */
static uint32_t fit(const ec_pipeline *p, const uint32_t *list, uint32_t first, uint32_t most, uint32_t *marked)
{
    const uint32_t room = p->wave / p->params.batch;
    uint32_t own[EC_LIST_WORDS], count = 0;
    for (*marked = 0; count < most; count++) {
        const uint32_t is = is_marked(p, entry_of(list, first, count, own)[0]);
        if (count + 1 + EC_EDGE_RAYS * (*marked + is) > room) break;
        *marked += is;
    }
    return count;
}

/* Fills the entries of a list: the wave's pixels, then EC_EDGE_RAYS positions for each marked one, then where in the wave that is. */
static void fill(ec_pipeline *p, const uint32_t *list, uint32_t first, uint32_t count)
{
    const ec_params *params = &p->params;
    uint32_t *at = p->edges.list, *rays = at + EC_LIST_WORDS * (size_t)count, *where = rays + EC_LIST_WORDS * (size_t)p->edges.positions, own[EC_LIST_WORDS];
    for (uint32_t i = 0; i < count; i++, at += EC_LIST_WORDS) {
        memcpy(at, entry_of(list, first, i, own), sizeof own);
        if (!is_marked(p, at[0])) continue;
        for (uint32_t k = 0; k < EC_EDGE_RAYS; k++, rays += EC_LIST_WORDS) {
            rays[0] = at[0] + params->edge_numbers;
            rays[1] = (at[1] + params->first_sample) * EC_EDGE_RAYS + k * params->batch - params->first_sample; /* kernels add first_sample again */
        }
        where[0] = i;
        where[1] = 0;
        where += EC_LIST_WORDS;
    }
}

ec_result ec_lamp_edges_prepare(ec_pipeline *p, const uint32_t *list, uint32_t first, uint32_t *count, ec_error *err)
{
    uint32_t marked;
    p->edges.positions = 0;
    if (!p->edges.marks) return EC_OK;
    *count = fit(p, list, first, *count, &marked);
    if (!marked) return EC_OK;
    const uint32_t entries = *count + (EC_EDGE_RAYS + 1) * marked;
    EC_TRY(make_room(p, entries, err));
    p->edges.positions = EC_EDGE_RAYS * marked;
    fill(p, list, first, *count);
    return send_list(p, entries, err);
}
