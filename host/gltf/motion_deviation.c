/* Measures how far straight lines from key to key depart from the true motion. */
#include <float.h>
#include <math.h>

#include "gltf/motion.h"

/* Returns the largest distance, over all moments, of numbers first … first + count - 1 from what the adjacent keys interpolate to. NaN does not
 * count. */
static double distance_of(const ec_tracks *t, numbers_at *at, uint32_t thing, int first, int count)
{
    const uint32_t stride = EC_MOMENTS / t->segments;
    double most = 0;
    for (uint32_t m = 0; m < EC_MOMENTS; m += t->step) {
        uint32_t key = m / stride * stride;
        double f = (double)(m - key) / stride, sum = 0;
        if (m == key) continue;
        const float *a = at(t, key, thing), *b = at(t, key + stride, thing), *v = at(t, m, thing);
        for (int k = first; k < first + count; k++) {
            double d = v[k] - (a[k] + f * ((double)b[k] - a[k]));
            sum += d * d;
        }
        most = fmax(most, sum);
    }
    return sqrt(most);
}

/* Grows the box by a thing's positions at all moments examined. */
static void sweep(const ec_tracks *t, numbers_at *at, uint32_t thing, float low[3], float high[3])
{
    for (uint32_t m = 0; m <= EC_MOMENTS; m += t->step)
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], at(t, m, thing)[k]);
            high[k] = fmaxf(high[k], at(t, m, thing)[k]);
        }
}

static double share_of(double distance, const float low[3], const float high[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += ((double)high[k] - low[k]) * ((double)high[k] - low[k]);
    return distance > 0 && sum > 0 ? distance / sqrt(sum) : 0;
}

/* Measures all vertices of one placement, as the list is in the order of placements; advances *i behind them. */
static double mesh_deviation(const ec_tracks *t, uint32_t *i)
{
    float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    uint32_t node = t->base->sources[t->vertex[*i]].placement;
    double most = 0;
    for (; *i < t->count && t->base->sources[t->vertex[*i]].placement == node; ++*i) {
        sweep(t, vertex_at, *i, low, high);
        most = fmax(most, distance_of(t, vertex_at, *i, 0, 3));
    }
    return share_of(most, low, high);
}

static double path_deviation(const ec_tracks *t, numbers_at *at, uint32_t thing)
{
    float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    sweep(t, at, thing, low, high);
    return share_of(distance_of(t, at, thing, 0, 3), low, high);
}

double ec_tracks_deviation(const ec_tracks *t)
{
    double most = 0;
    for (uint32_t i = 0; i < t->count;) most = fmax(most, mesh_deviation(t, &i));
    for (uint32_t i = 0; i < t->scene->camera_count; i++) {
        most = fmax(most, path_deviation(t, camera_place, i));
        for (int axis = 1; axis <= 3; axis++) most = fmax(most, distance_of(t, camera_place, i, 3 * axis, 3));
        most = fmax(most, distance_of(t, camera_view, i, 0, 1));
    }
    for (uint32_t i = 0; i < t->scene->light_count; i++) {
        most = fmax(most, path_deviation(t, light_place, i));
        most = fmax(most, distance_of(t, light_place, i, 3, 3));
    }
    return most;
}
