#include "pack/brightness.h"

#include <math.h>
#include <stdlib.h>

#include "base/luminance.h"
#include "image/srgb.h"

#define SIDE 4.0 /* approximate number of squares across a large triangle */
#define SMALL 1.0 /* texels: smaller triangles are sampled at points */
enum { POINTS = 4 }; /* parts into which an edge is divided for that */

static uint32_t wrapped(int64_t i, uint32_t size, ec_wrap wrap)
{
    const int64_t last = (int64_t)size - 1;
    if (i >= 0 && i <= last) return (uint32_t)i; /* the usual case, without a division */
    if (wrap == EC_WRAP_REPEAT) return (uint32_t)((i % size + size) % size);
    return (uint32_t)(i < 0 ? 0 : i > last ? last : i);
}

/* Returns the luminance of the material's radiance at a texel. */
static float texel_at(const ec_brightness *b, uint32_t x, uint32_t y)
{
    const size_t i = 4 * ((size_t)y * b->width + x);
    const uint8_t *bytes = b->image->rgba8 ? b->image->rgba8 + i : NULL;
    const uint16_t *words = bytes ? NULL : b->image->rgba16 + i;
    double luminance = 0;
    for (int k = 0; k < 3; k++) luminance += b->shares[k * b->stored + (bytes ? bytes[k] : words[k])];
    return (float)luminance;
}

/* Returns the means over a patch, where radiance is bilinear between the values of four corners. */
static ec_bright between(double p, double q, double r, double s)
{
    const double squares = p * p + q * q + r * r + s * s, edges = p * q + r * s + p * r + q * s, diagonals = p * s + q * r;
    return (ec_bright){(float)((p + q + r + s) / 4), (float)((squares + edges + diagonals / 2) / 9)};
}

static ec_bright patch_of(const ec_brightness *b, float p, float q, float r, float s)
{
    return b->nearest ? (ec_bright){p, (float)((double)p * (double)p)} : between((double)p, (double)q, (double)r, (double)s);
}

static ec_bright patch(const ec_brightness *b, uint32_t x, uint32_t y)
{
    const uint32_t right = wrapped((int64_t)x + 1, b->width, b->wrap[0]), below = wrapped((int64_t)y + 1, b->height, b->wrap[1]);
    return patch_of(b, texel_at(b, x, y), texel_at(b, right, y), texel_at(b, x, below), texel_at(b, right, below));
}

static ec_bright square_of(const ec_brightness *b, uint32_t level, uint32_t x, uint32_t y)
{
    return level ? b->levels[level][(size_t)y * b->columns[level] + x] : patch(b, x, y);
}

/* Averages up to four squares each, of a row and the one below, which may be NULL. */
static void join(const ec_bright *above, const ec_bright *below, uint32_t count, ec_bright *out)
{
    const uint32_t whole = below ? count / 2 : 0;
    for (uint32_t i = 0; i < whole; i++) {
        const ec_bright *a = above + 2 * i, *b = below + 2 * i;
        out[i].mean = (float)(((double)a[0].mean + (double)a[1].mean + (double)b[0].mean + (double)b[1].mean) / 4);
        out[i].square = (float)(((double)a[0].square + (double)a[1].square + (double)b[0].square + (double)b[1].square) / 4);
    }
    for (uint32_t i = whole; i < (count + 1) / 2; i++) {
        double mean = 0, square = 0;
        int n = 0;
        for (uint32_t k = 2 * i; k < 2 * i + 2 && k < count; k++, n++) mean += above[k].mean, square += above[k].square;
        for (uint32_t k = 2 * i; below && k < 2 * i + 2 && k < count; k++, n++) mean += below[k].mean, square += below[k].square;
        out[i] = (ec_bright){(float)(mean / n), (float)(square / n)};
    }
}

/* Fills row y of the first level. Each row of texels is looked up once for the patches on both sides of it. */
static void join_patches(const ec_brightness *b, uint32_t y, ec_bright *out)
{
    enum { SOME = 256 };
    float texels[3][SOME + 1];
    ec_bright rows[2][SOME];
    const uint32_t row_count = 2 * y + 1 < b->height ? 2 : 1;
    for (uint32_t x = 0; x < b->width; x += SOME) {
        const uint32_t count = b->width - x < SOME ? b->width - x : SOME;
        for (uint32_t r = 0; r <= row_count; r++)
            for (uint32_t i = 0; i <= count; i++)
                texels[r][i] = texel_at(b, wrapped((int64_t)x + i, b->width, b->wrap[0]), wrapped(2 * (int64_t)y + r, b->height, b->wrap[1]));
        for (uint32_t r = 0; r < row_count; r++)
            for (uint32_t i = 0; i < count; i++) rows[r][i] = patch_of(b, texels[r][i], texels[r][i + 1], texels[r + 1][i], texels[r + 1][i + 1]);
        join(rows[0], row_count == 2 ? rows[1] : NULL, count, out + x / 2);
    }
}

static ec_result add_level(ec_brightness *b, uint32_t level, ec_error *err)
{
    const uint32_t columns = b->columns[level] = (b->columns[level - 1] + 1) / 2, rows = b->rows[level] = (b->rows[level - 1] + 1) / 2;
    b->levels[level] = malloc((size_t)columns * rows * sizeof **b->levels);
    if (!b->levels[level]) return ec_fail(err, "out of memory for the brightness of a texture of %u x %u", b->width, b->height);
#pragma omp parallel for if (rows > 64)
    for (uint32_t y = 0; y < rows; y++) {
        ec_bright *out = b->levels[level] + (size_t)y * columns;
        if (level == 1) {
            join_patches(b, y, out);
            continue;
        }
        const uint32_t before = b->columns[level - 1];
        const ec_bright *above = b->levels[level - 1] + 2 * (size_t)y * before;
        join(above, 2 * y + 1 < b->rows[level - 1] ? above + before : NULL, before, out);
    }
    return EC_OK;
}

/* Tabulates luminance by stored value: there are few values and many texels, and a power takes as long as twenty look-ups. */
static void fill_shares(const ec_material *m, ec_brightness *b)
{
    for (uint32_t i = 0; i < b->stored; i++) {
        const double linear = b->stored == 256 ? ec_srgb_bytes()[i] : ec_srgb_to_linear(i / 65535.0);
        for (int k = 0; k < 3; k++) {
            double rgb[3] = {0};
            rgb[k] = (double)m->emission[k] * linear;
            b->shares[k * b->stored + i] = ec_luminance(rgb);
        }
    }
}

ec_result ec_brightness_make(const ec_scene *scene, const ec_material *m, ec_brightness *b, ec_error *err)
{
    const ec_texture *texture = &scene->textures[m->textures[EC_SLOT_EMISSION].texture];
    const ec_image *image = &scene->images[texture->image];
    *b = (ec_brightness){.width = image->width, .height = image->height, .wrap = {texture->wrap_s, texture->wrap_t}, .nearest = texture->nearest,
                         .image = image, .stored = image->rgba8 ? 256 : 65536};
    b->shares = malloc(3 * (size_t)b->stored * sizeof *b->shares);
    if (!b->shares) return ec_fail(err, "out of memory for the brightness of a texture of %u x %u", b->width, b->height);
    fill_shares(m, b);
    b->columns[0] = b->width, b->rows[0] = b->height;
    for (uint32_t level = 1; b->columns[level - 1] > 1 || b->rows[level - 1] > 1; level++) EC_TRY(add_level(b, level, err));
    return EC_OK;
}

void ec_brightness_free(ec_brightness *b)
{
    free(b->shares);
    for (int level = 0; level < EC_BRIGHT_LEVELS; level++) free(b->levels[level]);
    *b = (ec_brightness){0};
}

/* Maps u into [0, 1] by mirroring. */
static double mirrored(double u)
{
    return 1 - fabs(2 * (u / 2 - floor(u / 2)) - 1);
}

/* Finds the texels between two coordinates, in units where the first texel's centre is 0 (with nearest, its edge). */
static void range_on_axis(const ec_brightness *b, int axis, double low, double high, int64_t *first, int64_t *last)
{
    const uint32_t size = axis ? b->height : b->width;
    if (b->wrap[axis] == EC_WRAP_CLAMP) low = fmin(fmax(low, 0), 1), high = fmin(fmax(high, 0), 1);
    if (b->wrap[axis] == EC_WRAP_MIRROR) {
        const double p = mirrored(low), q = mirrored(high);
        const bool turns = floor(low) != floor(high), is_odd = fmod(floor(low), 2) != 0; /* reflects at 1 where the part before it rises */
        const bool is_all = high - low >= 1;
        low = is_all || (turns && is_odd) ? 0 : fmin(p, q);
        high = is_all || (turns && !is_odd) ? 1 : fmax(p, q);
    }
    if (b->wrap[axis] == EC_WRAP_REPEAT) {
        high -= floor(low), low -= floor(low);
        if (high - low >= 1) low = 0, high = 1;
    }
    *first = (int64_t)floor(low * size - (b->nearest ? 0 : 0.5));
    *last = (int64_t)floor(high * size - (b->nearest ? 0 : 0.5));
    if (*last - *first >= size) *first = 0, *last = size - 1;
}

/* Sums over squares of a level. */
typedef struct squares {
    double mean, square;
    uint64_t count;
} squares;

static void add_squares(const ec_brightness *b, uint32_t level, const uint32_t x[2], const uint32_t y[2], squares *sum)
{
    for (uint32_t j = y[0] >> level; j <= y[1] >> level; j++)
        for (uint32_t i = x[0] >> level; i <= x[1] >> level; i++) {
            const ec_bright one = square_of(b, level, i, j);
            sum->mean += one.mean, sum->square += one.square, sum->count++;
        }
}

/* Splits a range of patches along an axis at the seam; returns the number of runs, 1 or 2. */
static int split_at_seam(const ec_brightness *b, int axis, int64_t first, int64_t last, uint32_t runs[2][2])
{
    const uint32_t size = axis ? b->height : b->width;
    runs[0][0] = wrapped(first, size, b->wrap[axis]), runs[0][1] = wrapped(last, size, b->wrap[axis]);
    if (runs[0][0] <= runs[0][1]) return 1;
    runs[1][0] = 0, runs[1][1] = runs[0][1], runs[0][1] = size - 1;
    return 2;
}

static ec_bright over_box(const ec_brightness *b, const int64_t first[2], const int64_t last[2])
{
    const double extent = fmax((double)(last[0] - first[0] + 1), (double)(last[1] - first[1] + 1));
    const uint32_t level = extent > SIDE ? (uint32_t)ceil(log2(extent / SIDE)) : 0;
    uint32_t x[2][2], y[2][2];
    const int columns = split_at_seam(b, 0, first[0], last[0], x), rows = split_at_seam(b, 1, first[1], last[1], y);
    squares sum = {0};
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++) add_squares(b, level, x[i], y[j], &sum);
    return (ec_bright){(float)(sum.mean / (double)sum.count), (float)(sum.square / (double)sum.count)};
}

/* Interpolates as the kernels do. */
static double at_point(const ec_brightness *b, const double p[2])
{
    uint32_t first[2], second[2];
    double weight[2];
    for (int k = 0; k < 2; k++) {
        const uint32_t size = k ? b->height : b->width;
        const double u = b->wrap[k] == EC_WRAP_REPEAT ? p[k] - floor(p[k]) : b->wrap[k] == EC_WRAP_MIRROR ? mirrored(p[k]) : fmin(fmax(p[k], 0), 1);
        const double x = u * size - (b->nearest ? 0 : 0.5), low = floor(x);
        first[k] = wrapped((int64_t)low, size, b->wrap[k]);
        second[k] = b->nearest ? first[k] : wrapped((int64_t)low + 1, size, b->wrap[k]);
        weight[k] = x - low;
    }
    const double above = (1 - weight[0]) * texel_at(b, first[0], first[1]) + weight[0] * texel_at(b, second[0], first[1]);
    const double below = (1 - weight[0]) * texel_at(b, first[0], second[1]) + weight[0] * texel_at(b, second[0], second[1]);
    return (1 - weight[1]) * above + weight[1] * below;
}

/* Averages over a grid of points with the corners and edges, where a bilinear function is largest unless a texel's centre lies inside. */
static ec_bright over_points(const ec_brightness *b, const double corners[3][2])
{
    double mean = 0, square = 0;
    int count = 0;
    for (int i = 0; i <= POINTS; i++)
        for (int j = 0; i + j <= POINTS; j++, count++) {
            double p[2];
            for (int k = 0; k < 2; k++) p[k] = (corners[0][k] * (POINTS - i - j) + corners[1][k] * i + corners[2][k] * j) / POINTS;
            const double bright = at_point(b, p);
            mean += bright, square += bright * bright;
        }
    return (ec_bright){(float)(mean / count), (float)(square / count)};
}

ec_bright ec_brightness_over(const ec_brightness *b, const double corners[3][2], double *texels)
{
    int64_t first[2], last[2];
    *texels = 0;
    for (int k = 0; k < 2; k++) {
        const double low = fmin(corners[0][k], fmin(corners[1][k], corners[2][k])), high = fmax(corners[0][k], fmax(corners[1][k], corners[2][k]));
        *texels = fmax(*texels, (high - low) * (k ? b->height : b->width));
        range_on_axis(b, k, low, high, &first[k], &last[k]);
    }
    return *texels < SMALL ? over_points(b, corners) : over_box(b, first, last);
}
