#include "rare/leave.h"

#include <math.h>

#include "base/random.h"

#define PI 3.14159265358979323846

void ec_rare_frame(const float normal[3], double u[3], double v[3])
{
    const int k = fabsf(normal[0]) < 0.6f ? 0 : 1;
    double square = 0;
    for (int c = 0; c < 3; c++) u[c] = (c == k) - (double)normal[k] * normal[c], square += u[c] * u[c];
    for (int c = 0; c < 3; c++) u[c] /= sqrt(square);
    for (int c = 0; c < 3; c++) v[c] = normal[(c + 1) % 3] * u[(c + 2) % 3] - normal[(c + 2) % 3] * u[(c + 1) % 3];
}

void ec_rare_leave_lamp(const ec_rare_lamp *lamp, uint64_t *random, ec_chain *ray)
{
    const double root = sqrt(ec_random_unit(random)), b = ec_random_unit(random) * root, sine2 = ec_random_unit(random);
    const double angle = 2 * PI * ec_random_unit(random), side = lamp->two_sided && ec_random_unit(random) < 0.5 ? -1 : 1;
    double u[3], v[3];
    ec_rare_frame(lamp->normal, u, v);
    for (int c = 0; c < 3; c++) {
        ray->origin[c] = (float)(lamp->corner[c] + (root - b) * lamp->edges[0][c] + b * lamp->edges[1][c]);
        ray->direction[c] = (float)(sqrt(sine2) * (cos(angle) * u[c] + sin(angle) * v[c]) + side * sqrt(1 - sine2) * lamp->normal[c]);
    }
    ray->prim = lamp->prim;
}

double ec_rare_leave_point(const ec_rare_source *source, uint32_t number, uint32_t count, ec_chain *ray)
{
    const bool is_spot = source->cos_inner >= -1;
    const double height = is_spot ? 1 - source->cos_outer : 2, turn = PI * (3 - sqrt(5)) * number; /* height: of the cap of the unit sphere that is lit */
    const double below = height * (number + 0.5) / count, sine = sqrt(fmax(below * (2 - below), 0));
    double u[3], v[3];
    ec_rare_frame(source->direction, u, v);
    *ray = (ec_chain){.prim = EC_NO_ID, .beta = 1};
    for (int c = 0; c < 3; c++) {
        ray->origin[c] = source->middle[c];
        ray->direction[c] = (float)((1 - below) * source->direction[c] + sine * (cos(turn) * u[c] + sin(turn) * v[c]));
    }
    return 2 * PI * height / count;
}
