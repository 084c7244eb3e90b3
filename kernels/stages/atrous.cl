/* One pass of an edge-avoiding filter over a picture (Dammertz et al. 2010), with weights by the remaining variance as in SVGF (Schied et al. 2017):
 * 5 x 5 taps of a B3 spline, `apart` pixels from one another. Weights are Tukey's biweights, so that nothing but exact arithmetic is used.
 * Reads: 4 floats a pixel, colour and the variance of its luminance; EC_AOV_FIELDS features a pixel. Writes: 4 floats a pixel. */
#include "../lib/lanes.h"
#include "../shared/path_state.h"

#if LANES != 1
#error "one work-item a pixel: build with LANES 1"
#endif

#define ATROUS_LUMINANCE 64.0f /* 8^2: the weight is 0 from a difference of 8 standard deviations on, … */
#define ATROUS_DEPTH 9.0f      /* 3^2: … of 3 times the slope of the depth over the distance, … */
#define ATROUS_DEPTH_LEAST 1e-6f      /* 0.001^2: … or a thousandth of the depth, … */
#define ATROUS_NORMAL 16.0f    /* 1 / 0.25^2: … of a quarter between unit normals, … */
#define ATROUS_ALBEDO 16.0f    /* … and between albedos */
#define ATROUS_TINY 1e-30f

/* square: over the one at which the weight is 0. */
EC_FN float biweight(float square)
{
    float t = max(1.0f - square, 0.0f);
    return t * t;
}

EC_FN float rgb_luminance(float4 colour) { return 0.2126f * colour.x + 0.7152f * colour.y + 0.0722f * colour.z; }

EC_FN float square_between(global const float *a, global const float *b)
{
    float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* The variance, smoothed over 3 x 3 pixels: an estimate from few replicates is noisy itself. */
EC_FN float smooth_variance(global const float4 *from, int2 at, int2 size)
{
    const float tap[2] = {0.5f, 0.25f};
    float sum = 0.0f;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            int x = clamp(at.x + dx, 0, size.x - 1), y = clamp(at.y + dy, 0, size.y - 1);
            sum += tap[dx != 0] * tap[dy != 0] * from[(size_t)y * size.x + x].w;
        }
    return sum;
}

/* Returns by how much the depth changes from pixel to pixel. */
EC_FN float depth_slope(global const float *features, int2 at, int2 size)
{
    int left = max(at.x - 1, 0), right = min(at.x + 1, size.x - 1), up = max(at.y - 1, 0), down = min(at.y + 1, size.y - 1);
    float across = features[EC_AOV_FIELDS * ((size_t)at.y * size.x + left) + 6] - features[EC_AOV_FIELDS * ((size_t)at.y * size.x + right) + 6];
    float along = features[EC_AOV_FIELDS * ((size_t)up * size.x + at.x) + 6] - features[EC_AOV_FIELDS * ((size_t)down * size.x + at.x) + 6];
    return 0.5f * max(fabs(across), fabs(along));
}

kernel void ec_atrous(global const float4 *from, global const float *features, global float4 *to, int width, int height, int apart)
{
    const float tap[3] = {0.375f, 0.25f, 0.0625f};
    size_t i = get_global_id(0);
    if (i >= (size_t)width * height) return;
    int2 size = (int2)(width, height), at = (int2)((int)(i % width), (int)(i / width));
    global const float *own = features + EC_AOV_FIELDS * i;
    float4 middle = from[i];
    float y0 = rgb_luminance(middle), sharpness = 1.0f / (ATROUS_LUMINANCE * smooth_variance(from, at, size) + ATROUS_TINY), slope = depth_slope(features, at, size);
    float weights = 0.0f;
    float4 sum = (float4)(0.0f);
    for (int dy = -2; dy <= 2; dy++)
        for (int dx = -2; dx <= 2; dx++) {
            int x = clamp(at.x + dx * apart, 0, width - 1), y = clamp(at.y + dy * apart, 0, height - 1);
            size_t j = (size_t)y * width + x;
            global const float *other = features + EC_AOV_FIELDS * j;
            float4 colour = from[j];
            float brighter = rgb_luminance(colour) - y0, deeper = other[6] - own[6], distance = (float)((dx * dx + dy * dy) * apart * apart);
            float weight = tap[dx < 0 ? -dx : dx] * tap[dy < 0 ? -dy : dy];
            if (dx != 0 || dy != 0)
                weight *= biweight(brighter * brighter * sharpness) * biweight(ATROUS_NORMAL * square_between(own + 3, other + 3)) *
                          biweight(ATROUS_ALBEDO * square_between(own, other)) *
                          biweight(deeper * deeper / (ATROUS_DEPTH * slope * slope * distance + ATROUS_DEPTH_LEAST * own[6] * own[6] + ATROUS_TINY));
            sum.xyz += weight * colour.xyz;
            sum.w += weight * weight * colour.w;
            weights += weight;
        }
    sum.xyz /= weights;
    sum.w /= weights * weights;
    to[i] = sum;
}
