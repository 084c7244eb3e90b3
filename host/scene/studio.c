/* A photographer's studio: soft boxes in front of grey walls. It is colourless, so that all colour comes from the subject. */
#include <math.h>

#include "scene/built_in.h"

#define RADIAN (3.14159265358979323846 / 180)
#define SOFT 0.06 /* half the width of a box's soft edge, in units of its size */

/* A rectangle on the plane at distance 1 in front of its direction. */
typedef struct soft_box {
    double azimuth, elevation; /* degrees: from +z towards +x, and up */
    double half_width, half_height, radiance;
} soft_box;

static const soft_box boxes[] = {
    {-42, 33, 0.45, 0.40, 9},   /* key light, from the viewer's left */
    {55, 12, 0.60, 0.70, 2.4},  /* fill light */
    {0, 90, 0.50, 0.34, 4},     /* top light */
    {-150, 18, 0.14, 0.70, 11}, /* rim lights, from behind */
    {145, 18, 0.14, 0.70, 11},
};

static double smooth(double from, double to, double x)
{
    const double t = fmin(fmax((x - from) / (to - from), 0), 1);
    return t * t * (3 - 2 * t);
}

static double radiance_of(const soft_box *box, const double d[3])
{
    const double a = box->azimuth * RADIAN, e = box->elevation * RADIAN;
    const double middle[3] = {sin(a) * cos(e), sin(e), cos(a) * cos(e)}, right[3] = {cos(a), 0, -sin(a)}, up[3] = {-sin(a) * sin(e), cos(e), -cos(a) * sin(e)};
    double ahead = 0, x = 0, y = 0;
    for (int k = 0; k < 3; k++) ahead += middle[k] * d[k], x += right[k] * d[k], y += up[k] * d[k];
    if (ahead <= 0) return 0;
    return box->radiance * (1 - smooth(box->half_width - SOFT, box->half_width + SOFT, fabs(x) / ahead)) *
           (1 - smooth(box->half_height - SOFT, box->half_height + SOFT, fabs(y) / ahead));
}

void ec_studio_fill(const ec_made_map *map)
{
    double mean = 0;
    for (uint32_t y = 0; y < map->height; y++)
        for (uint32_t x = 0; x < map->width; x++) {
            double d[3];
            ec_made_map_direction(map, x, y, d);
            double l = 0.18 + 0.32 * smooth(-0.6, 0.15, d[1]) - 0.15 * smooth(0.1, 0.9, d[1]); /* dark floor, light walls, ceiling in between */
            for (uint32_t i = 0; i < sizeof boxes / sizeof *boxes; i++) l += radiance_of(&boxes[i], d);
            float *rgb = map->rgb + 3 * ((uint64_t)y * map->width + x);
            rgb[0] = rgb[1] = rgb[2] = (float)l;
            mean += l * ec_made_map_solid_angle(map, y);
        }
    mean /= 4 * 180 * RADIAN;
    for (uint64_t i = 0; i < 3 * (uint64_t)map->width * map->height; i++) map->rgb[i] = (float)(map->rgb[i] / mean);
}
