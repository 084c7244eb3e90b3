#include <stdlib.h>
#include <string.h>

#include "cost/cost.h"

enum { WIDTH_MOST = 192 };

ec_cost_thumbnail ec_cost_thumbnail_of(const ec_render_options *o)
{
    uint32_t step = (o->width + WIDTH_MOST - 1) / WIDTH_MOST;
    return (ec_cost_thumbnail){(o->width + step - 1) / step, (o->height + step - 1) / step, step};
}

float *ec_cost_shrink(const ec_render_options *o, const float *rgb)
{
    ec_cost_thumbnail t = ec_cost_thumbnail_of(o);
    float *small = malloc(3 * sizeof *small * t.width * t.height);
    for (uint32_t y = 0; small && y < t.height; y++)
        for (uint32_t x = 0; x < t.width; x++)
            memcpy(small + 3 * ((size_t)y * t.width + x),
                   rgb + 3 * ((size_t)y * t.step * o->width + (size_t)x * t.step), 3 * sizeof *rgb);
    return small;
}
