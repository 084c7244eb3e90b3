#include "pack/texture_mean.h"

#include <math.h>
#include <pthread.h>

#include "pack/pack.h"

ec_texture_mean ec_texture_whole_mean(const ec_scene *scene, const ec_texture_use *use)
{
    ec_texture_mean mean = {{1.0, 1.0, 1.0}};
    if (use->texture < 0) return mean;
    const ec_image *image = &scene->images[scene->textures[use->texture].image];
    size_t count = (size_t)image->width * image->height, step = count / 65536 + 1;
    const double *bytes = ec_srgb_bytes();
    mean = (ec_texture_mean){{0.0, 0.0, 0.0}};
    for (int k = 0; k < 3; k++) {
        double most = 0.0;
        for (size_t i = 0; i < count; i += step) mean.rgb[k] += ec_texel_linear(image, bytes, i, k);
        for (size_t i = 0; i < count && mean.rgb[k] == 0.0 && most == 0.0; i++) most = ec_texel_linear(image, bytes, i, k);
        mean.rgb[k] = (mean.rgb[k] + most) / (double)((count + step - 1) / step); /* 0 only if every texel is */
    }
    return mean;
}

/* Replaces floor(), which is a library call. */
static double whole(double u)
{
    if (!(fabs(u) < 4e15)) return floor(u);
    const double cut = (double)(int64_t)u;
    return cut > u ? cut - 1.0 : cut;
}

/* Maps a coordinate into the picture, 0 to 1. */
static double fold(double u, ec_wrap mode)
{
    if (!isfinite(u)) return 0.0;
    if (mode == EC_WRAP_CLAMP) return fmin(fmax(u, 0.0), 1.0);
    return mode == EC_WRAP_MIRROR ? 1.0 - fabs(2.0 * (0.5 * u - whole(0.5 * u)) - 1.0) : u - whole(u);
}

static inline uint32_t wrap(double u, uint32_t size, ec_wrap mode)
{
    const bool is_inside = u >= 0.0 && u < 1.0 && mode != EC_WRAP_MIRROR; /* the usual case: neither repeating nor clamping changes it */
    const uint32_t i = (uint32_t)(int64_t)((is_inside ? u : fold(u, mode)) * size);
    return i < size ? i : size - 1;
}

/* Barycentric coordinates of the points that represent a triangle. */
enum { POINTS = 64 };
static double points[POINTS][3];

static void spread_points(void)
{
    for (int n = 0; n < POINTS; n++) {
        double root = sqrt((n / 8 + 0.5) / 8.0), b1 = root * ((n % 8 + 0.5) / 8.0), b0 = 1.0 - root;
        points[n][0] = b0;
        points[n][1] = b1;
        points[n][2] = 1.0 - b0 - b1;
    }
}

void ec_texture_triangle_mean(const ec_scene *scene, const ec_texture_use *use, uint32_t prim, double rgb[3])
{
    const ec_texture *texture = &scene->textures[use->texture];
    const ec_image *image = &scene->images[texture->image];
    const float *uv = scene->uv[use->uv_set ? 1 : 0], *m = use->transform;
    const uint32_t *i = scene->indices + 3 * (size_t)prim;
    const double *bytes = ec_srgb_bytes();
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, spread_points);
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    for (int n = 0; n < POINTS; n++) {
        const double b0 = points[n][0], b1 = points[n][1], b2 = points[n][2];
        double p[2] = {0.0, 0.0};
        for (int k = 0; uv && k < 2; k++)
            p[k] = b0 * uv[2 * (size_t)i[0] + k] + b1 * uv[2 * (size_t)i[1] + k] + b2 * uv[2 * (size_t)i[2] + k];
        uint32_t x = wrap(m[0] * p[0] + m[1] * p[1] + m[2], image->width, texture->wrap_s);
        uint32_t y = wrap(m[3] * p[0] + m[4] * p[1] + m[5], image->height, texture->wrap_t);
        for (int k = 0; k < 3; k++) rgb[k] += ec_texel_linear(image, bytes, (size_t)y * image->width + x, k) / POINTS;
    }
}
