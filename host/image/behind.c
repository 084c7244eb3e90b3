#include "image/behind.h"

#include <math.h>

#define PI 3.14159265358979323846

void ec_behind_look(const ec_behind *b, uint32_t x, uint32_t y, double rgb[3])
{
    double seen[3], d[3];
    for (int k = 0; k < 3; k++) seen[k] = b->corner[k] + x * b->across[k] + y * b->down[k], rgb[k] = 0;
    if (!b->rgb) return;
    for (int k = 0; k < 3; k++) d[k] = b->turn[k] * seen[0] + b->turn[3 + k] * seen[1] + b->turn[6 + k] * seen[2];
    const double u = (0.5 + atan2(d[2], d[0]) / (2 * PI)) * b->width - 0.5, v = atan2(hypot(d[0], d[2]), d[1]) / PI * b->height - 0.5;
    const double left = floor(u), top = floor(v);
    for (int corner = 0; corner < 4; corner++) {
        const int64_t column = (int64_t)left + (corner & 1), row = (int64_t)top + (corner >> 1);
        const uint64_t i = (uint64_t)((column + b->width) % b->width), k = (uint64_t)(row < 0 ? 0 : row < b->height ? row : b->height - 1);
        const double weight = (corner & 1 ? u - left : 1 - u + left) * (corner >> 1 ? v - top : 1 - v + top);
        for (int c = 0; c < 3; c++) rgb[c] += weight * b->rgb[3 * (k * b->width + i) + (uint64_t)c];
    }
}
