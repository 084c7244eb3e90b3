/* Symbols and constants are as in the paper, section 4; filters are separable, or sums of two separable ones. */
#include "image/flip.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"

enum { RADIUS_MOST = 16, TAPS = 2 * RADIUS_MOST + 1 };
static const double qc = 0.7, pc = 0.4, pt = 0.95, qf = 0.5, w = 0.082, pi = 3.14159265358979323846;
static const double white[3] = {0.950428545, 1, 1.088900371};
static const double to_xyz[3][3] = {{10135552 / 24577794., 8788810 / 24577794., 4435075 / 24577794.},
                                    {2613072 / 12288897., 8788810 / 12288897., 887015 / 12288897.},
                                    {1425312 / 73733382., 8788810 / 73733382., 70074185 / 73733382.}};
static const double to_rgb[3][3] = {{3.241003275, -1.537398934, -0.498615861}, {-0.969224334, 1.875930071, 0.041554224},
                                    {0.055639423, -0.204011202, 1.057148933}};

/* One-dimensional kernels. In each, the positive weights add up to 1, and so do the negative ones in size. */
enum { SMOOTH_Y, SMOOTH_RG, SMOOTH_BY, SMOOTH_BY2, SMOOTH_FEATURE, EDGE, POINT, KERNELS };
typedef struct filters {
    int radius, feature_radius;
    double kernel[KERNELS][TAPS];
    double by_share;             /* weight of the first of BY's two Gaussians */
    double colour_most;          /* the largest colour difference, between green and blue */
} filters;

static void transform(const double m[3][3], const double in[3], double out[3])
{
    for (int r = 0; r < 3; r++) out[r] = m[r][0] * in[0] + m[r][1] * in[1] + m[r][2] * in[2];
}

static void normalise(double *kernel, int radius)
{
    double sums[2] = {0};
    for (int i = 0; i <= 2 * radius; i++) sums[kernel[i] < 0] += fabs(kernel[i]);
    for (int i = 0; i <= 2 * radius; i++)
        if (kernel[i] != 0) kernel[i] /= sums[kernel[i] < 0];
}

/* Makes a Gaussian of the contrast sensitivity functions; returns the sum of its weights. */
static double gaussian(double b, int radius, double *kernel)
{
    double sum = 0;
    for (int i = -radius; i <= radius; i++) sum += kernel[i + radius] = exp(-pi * pi * i * i / (EC_FLIP_PPD * EC_FLIP_PPD * b));
    normalise(kernel, radius);
    return sum;
}

static double hyab(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

/* Converts linear RGB to CIELAB with the Hunt effect: colours count less in the dark. */
static void hunt_lab(const double rgb[3], double lab[3])
{
    const double delta = 6 / 29.;
    double xyz[3], f[3];
    transform(to_xyz, rgb, xyz);
    for (int c = 0; c < 3; c++) {
        double t = xyz[c] / white[c];
        f[c] = t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4 / 29.;
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 0.01 * lab[0] * 500 * (f[0] - f[1]);
    lab[2] = 0.01 * lab[0] * 200 * (f[1] - f[2]);
}

static void make_filters(filters *f)
{
    const double by1 = 34.1 * sqrt(pi / 0.04), by2 = 13.5 * sqrt(pi / 0.025), sd = 0.5 * w * EC_FLIP_PPD;
    double green[3], blue[3];
    f->radius = (int)ceil(3 * sqrt(0.04 / (2 * pi * pi)) * EC_FLIP_PPD);
    f->feature_radius = (int)ceil(3 * sd);
    gaussian(0.0047, f->radius, f->kernel[SMOOTH_Y]);
    gaussian(0.0053, f->radius, f->kernel[SMOOTH_RG]);
    double s1 = gaussian(0.04, f->radius, f->kernel[SMOOTH_BY]), s2 = gaussian(0.025, f->radius, f->kernel[SMOOTH_BY2]);
    f->by_share = by1 * s1 * s1 / (by1 * s1 * s1 + by2 * s2 * s2);
    for (int i = -f->feature_radius; i <= f->feature_radius; i++) {
        double g = exp(-i * i / (2 * sd * sd));
        f->kernel[SMOOTH_FEATURE][i + f->feature_radius] = g;
        f->kernel[EDGE][i + f->feature_radius] = -i * g;
        f->kernel[POINT][i + f->feature_radius] = (i * i / (sd * sd) - 1) * g;
    }
    for (int k = SMOOTH_FEATURE; k < KERNELS; k++) normalise(f->kernel[k], f->feature_radius);
    hunt_lab((double[3]){0, 1, 0}, green);
    hunt_lab((double[3]){0, 0, 1}, blue);
    f->colour_most = pow(hyab(green, blue), qc);
}

/* Adds a row, weighted; shifting the pointers adds values to their neighbours. */
static void add_row(const float *in, double weight, uint32_t width, float *out)
{
    const float by = (float)weight;
    for (uint32_t x = 0; x < width; x++) out[x] += by * in[x];
}

static int radius_of(const filters *f, int kernel) { return kernel < SMOOTH_FEATURE ? f->radius : f->feature_radius; }

/* Converts a row to the opponent colours YCxCz, each extended at both ends for the widest filter. */
static void to_opponent(const float *in, uint32_t width, float *out)
{
    const uint32_t row = width + 2 * RADIUS_MOST;
    for (uint32_t i = 0; i < row; i++) {
        const uint32_t x = i < RADIUS_MOST ? 0 : i - RADIUS_MOST < width ? i - RADIUS_MOST : width - 1;
        double rgb[3], t[3];
        for (uint32_t c = 0; c < 3; c++) rgb[c] = ec_srgb_to_linear(in[3 * x + c]);
        transform(to_xyz, rgb, t);
        for (int c = 0; c < 3; c++) t[c] /= white[c];
        out[i] = (float)(116 * t[1] - 16);
        out[row + i] = (float)(500 * (t[0] - t[1]));
        out[2 * row + i] = (float)(200 * (t[1] - t[2]));
    }
}

static void filter_across(const filters *f, const float *in, uint32_t width, float *opponent, float *out)
{
    static const uint32_t channel[KERNELS] = {0, 1, 2, 2, 0, 0, 0};
    to_opponent(in, width, opponent);
    memset(out, 0, KERNELS * sizeof *out * width);
    for (int k = 0; k < KERNELS; k++)
        for (int i = -radius_of(f, k); i <= radius_of(f, k); i++)
            add_row(opponent + channel[k] * (width + 2 * RADIUS_MOST) + RADIUS_MOST + i, f->kernel[k][i + radius_of(f, k)], width, out + (uint32_t)k * width);
}

/* The second passes of the filters: which row, filtered horizontally, by which kernel. */
enum { Y, RG, BY, BY2, EDGE_X, EDGE_Y, POINT_X, POINT_Y, DOWN };
static const int halves[DOWN][2] = {{SMOOTH_Y, SMOOTH_Y}, {SMOOTH_RG, SMOOTH_RG}, {SMOOTH_BY, SMOOTH_BY}, {SMOOTH_BY2, SMOOTH_BY2}, {EDGE, SMOOTH_FEATURE},
                                    {SMOOTH_FEATURE, EDGE}, {POINT, SMOOTH_FEATURE}, {SMOOTH_FEATURE, POINT}};

/* Filters row y vertically. across: rows of KERNELS * width; out: DOWN * width. */
static void filter_down(const filters *f, const float *across, uint32_t width, uint32_t height, uint32_t y, float *out)
{
    memset(out, 0, DOWN * sizeof *out * width);
    for (int k = 0; k < DOWN; k++)
        for (int i = -radius_of(f, halves[k][1]); i <= radius_of(f, halves[k][1]); i++) {
            int64_t from = (int64_t)y + i;
            from = from < 0 ? 0 : from < height ? from : height - 1;
            add_row(across + (uint64_t)from * KERNELS * width + (uint64_t)halves[k][0] * width, f->kernel[halves[k][1]][i + radius_of(f, halves[k][1])], width,
                    out + (uint32_t)k * width);
        }
}

typedef struct seen {
    double lab[3], edge, point;
} seen;

static seen look_at(const filters *f, const float *filtered, uint32_t width, uint32_t x)
{
    double v[DOWN], xyz[3], rgb[3];
    for (uint32_t k = 0; k < DOWN; k++) v[k] = filtered[k * width + x];
    double y = (v[Y] + 16) / 116, by = f->by_share * v[BY] + (1 - f->by_share) * v[BY2];
    xyz[0] = (y + v[RG] / 500) * white[0];
    xyz[1] = y * white[1];
    xyz[2] = (y - by / 200) * white[2];
    transform(to_rgb, xyz, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = fmin(fmax(rgb[c], 0), 1);
    seen out = {.edge = hypot(v[EDGE_X], v[EDGE_Y]) / 116, .point = hypot(v[POINT_X], v[POINT_Y]) / 116}; /* Y' + 16 and Y' have the same derivatives */
    hunt_lab(rgb, out.lab);
    return out;
}

static float difference(const filters *f, const seen *a, const seen *b)
{
    double colour = pow(hyab(a->lab, b->lab), qc), knee = pc * f->colour_most;
    colour = colour < knee ? pt / knee * colour : pt + (colour - knee) / (f->colour_most - knee) * (1 - pt);
    double feature = pow(fmax(fabs(a->edge - b->edge), fabs(a->point - b->point)) / sqrt(2), qf);
    return (float)pow(colour, 1 - fmin(feature, 1));
}

ec_result ec_flip(const float *a, const float *b, uint32_t width, uint32_t height, float *map, ec_error *err)
{
    filters f = {0};
    const float *pictures[2] = {a, b};
    const uint64_t row = (uint64_t)KERNELS * width, line = (uint64_t)2 * DOWN * width + 3 * 2 * RADIUS_MOST; /* per thread: what either pass needs */
    const int threads = omp_get_max_threads();
    float *across = malloc((2 * height * row + (uint64_t)threads * line) * sizeof *across);
    if (!across) return ec_fail(err, "out of memory for FLIP of two pictures of %ux%u pixels", width, height);
    make_filters(&f);
#pragma omp parallel num_threads(threads)
    {
        float *own = across + 2 * height * row + (uint64_t)omp_get_thread_num() * line;
#pragma omp for schedule(static)
        for (uint32_t k = 0; k < 2 * height; k++) filter_across(&f, pictures[k / height] + 3ull * width * (k % height), width, own, across + row * k);
#pragma omp for schedule(static)
        for (uint32_t y = 0; y < height; y++) {
            filter_down(&f, across, width, height, y, own);
            filter_down(&f, across + height * row, width, height, y, own + (uint64_t)DOWN * width);
            for (uint32_t x = 0; x < width; x++) {
                seen one = look_at(&f, own, width, x), other = look_at(&f, own + (uint64_t)DOWN * width, width, x);
                map[(uint64_t)y * width + x] = difference(&f, &one, &other);
            }
        }
    }
    free(across);
    return EC_OK;
}
