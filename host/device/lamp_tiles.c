#include "device/lamp_tiles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/freed.h"
#include "base/luminance.h"
#include "device/batch_source.h"
#include "shared/scene_buffers.h"

#define ELSEWHERE (EC_FEATURE_INSTANCES | EC_FEATURE_MOTION | EC_FEATURE_LENS) /* lamps that the table does not have, or rays that start elsewhere */
#define TILE ((int64_t)EC_TILE_ROWS)
#define MARGIN 2.0 /* pixels: for the filter, and for a neighbour's */

/* Bounds of a lamp in the picture, in pixels; in_front: how many of its corners are before the camera. */
typedef struct extent {
    double low[2], high[2];
    uint32_t in_front;
} extent;

static double dot(const float *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void add_corner(const ec_params *params, const float *corner, extent *e)
{
    const float *axes[2] = {params->camera_right, params->camera_up};
    double way[3];
    for (int k = 0; k < 3; k++) way[k] = (double)corner[k] - params->camera_origin[k];
    const double depth = dot(params->camera_forward, way);
    if (!(depth > 0)) return;
    e->in_front++;
    for (int k = 0; k < 2; k++) {
        const double length2 = dot(axes[k], (const double[3]){axes[k][0], axes[k][1], axes[k][2]});
        const double at = (dot(axes[k], way) / length2 / (params->orthographic ? 1 : depth) - params->screen[k]) / params->screen[2 + k];
        e->low[k] = fmin(e->low[k], at);
        e->high[k] = fmax(e->high[k], at);
    }
}

static extent extent_of(const ec_params *params, const ec_light_data *light)
{
    extent e = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, 0};
    const float *corners[3] = {light->a, light->b, light->c};
    for (int k = 0; k < 3; k++) add_corner(params, corners[k], &e);
    for (int k = 0; k < 2 && e.in_front && e.in_front < 3; k++) e.low[k] = -INFINITY, e.high[k] = INFINITY;
    return e;
}

static int64_t tile_at(double pixel, uint32_t tiles) { return pixel <= 0 ? 0 : pixel >= (double)tiles * TILE ? tiles : (int64_t)pixel / TILE; }

static void mark(ec_lamp_tiles *t, const extent *e)
{
    const int64_t x0 = tile_at(e->low[0] - MARGIN, t->columns), x1 = tile_at(e->high[0] + MARGIN + TILE, t->columns);
    const int64_t y0 = tile_at(e->low[1] - MARGIN, t->rows), y1 = tile_at(e->high[1] + MARGIN + TILE, t->rows);
    for (int64_t y = y0; y < y1 && x0 < x1; y++) memset(t->may + y * t->columns + x0, 1, (size_t)(x1 - x0));
}

static bool is_seen(const ec_light_data *light, float least)
{
    return (light->kind & EC_LIGHT_KIND_MASK) == EC_KIND_TRIANGLE && ec_luminance_of_floats(light->emission) > least;
}

ec_result ec_lamp_tiles_find(ec_pipeline *p, float least, ec_lamp_tiles *t, ec_error *err)
{
    const ec_params *params = &p->params;
    const uint64_t bytes = (uint64_t)params->light_count * sizeof(ec_light_data);
    const bool is_known = bytes && p->buffers[EC_ARG_LIGHT_TABLE] && !(p->effects.called.bits & ELSEWHERE);
    *t = (ec_lamp_tiles){.columns = (params->width + EC_TILE_ROWS - 1) / EC_TILE_ROWS, .rows = (params->height + EC_TILE_ROWS - 1) / EC_TILE_ROWS};
    const size_t count = (size_t)t->columns * t->rows;
    EC_FREED ec_light_data *lights = malloc(bytes + 1);
    t->may = malloc(count);
    if (!t->may || !lights) return ec_fail(err, "out of memory for the edges of lamps");
    memset(t->may, !is_known, count);
    if (!is_known) return EC_OK;
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_LIGHT_TABLE], 0, bytes, lights, err));
    for (uint32_t i = 0; i < params->light_count; i++) {
        const extent e = extent_of(params, &lights[i]);
        if (is_seen(&lights[i], least) && e.in_front) mark(t, &e);
    }
    return EC_OK;
}

uint32_t ec_lamp_tile_numbers(const ec_params *params, const ec_lamp_tiles *t, uint32_t tile, uint32_t *first)
{
    const uint32_t x = tile % t->columns * EC_TILE_ROWS, y = tile / t->columns * EC_TILE_ROWS;
    const uint32_t rows = params->height - y < EC_TILE_ROWS ? params->height - y : EC_TILE_ROWS;
    const uint32_t columns = params->width - x < EC_TILE_ROWS ? params->width - x : EC_TILE_ROWS;
    *first = y * params->width + x * rows;
    return rows * columns;
}
