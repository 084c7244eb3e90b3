/* Computes directions and solid angles of an equirectangular map's texels, oriented as scene.h says. */
#include <math.h>

#include "scene/built_in.h"

#define PI 3.14159265358979323846

void ec_made_map_direction(const ec_made_map *map, uint32_t x, uint32_t y, double d[3])
{
    const double phi = 2 * PI * ((x + 0.5) / map->width - 0.5), theta = PI * (y + 0.5) / map->height;
    d[0] = cos(phi) * sin(theta);
    d[1] = cos(theta);
    d[2] = sin(phi) * sin(theta);
}

double ec_made_map_solid_angle(const ec_made_map *map, uint32_t y)
{
    return 2 * PI / map->width * (cos(PI * y / map->height) - cos(PI * (y + 1) / map->height));
}
