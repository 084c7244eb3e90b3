#include "film/moments.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/film.h"

bool ec_moments_create(ec_moments *m, uint64_t pixels)
{
    *m = (ec_moments){calloc(pixels, 3 * sizeof(double)), calloc(pixels, 4 * sizeof(double)), calloc(pixels, 2 * sizeof(float)),
                      calloc(pixels, sizeof(float))};
    if (m->mean && m->m2 && m->m34 && m->largest) return true;
    ec_moments_destroy(m);
    return false;
}

void ec_moments_destroy(ec_moments *m)
{
    free(m->mean);
    free(m->m2);
    free(m->m34);
    free(m->largest);
    *m = (ec_moments){0};
}

ec_moments ec_moments_in(void *memory, uint64_t pixels)
{
    double *mean = memory, *m2 = mean + 3 * pixels;
    float *m34 = (float *)(m2 + 4 * pixels);
    return (ec_moments){mean, m2, m34, m34 + 2 * pixels};
}

static inline void add_channel(double *mean, double *m2, double x, double n)
{
    double delta = x - *mean;
    *mean += delta / n;
    *m2 += delta * (x - *mean);
}

/* Pebay, eqs. 1.6 and 1.7 with one new value. delta = x - old mean. */
static inline void add_luminance(double *m2, float *m34, double delta, double n)
{
    double step = delta / n, added = delta * step * (n - 1); /* what M2 grows by */
    double m3 = m34[0], m4 = m34[1];
    m34[1] = (float)(m4 + step * step * (added * (n * n - 3 * n + 3) + 6 * *m2) - 4 * step * m3);
    m34[0] = (float)(m3 + step * (added * (n - 2) - 3 * *m2));
    *m2 += added;
}

static inline uint32_t add_pixel(const ec_moments *m, uint64_t p, const float *rgb, double n)
{
    double *mean = m->mean + 3 * p, *m2 = m->m2 + 4 * p, x[3];
    uint32_t invalid = 0;
    for (int c = 0; c < 3; c++) {
        x[c] = rgb[c];
        if (!isfinite(x[c])) x[c] = 0, invalid++;
    }
    double luminance = ec_luminance(x);
    m->largest[p] = (float)fmax(m->largest[p], luminance);
    add_luminance(m2 + 3, m->m34 + 2 * p, luminance - ec_luminance(mean), n);
    for (int c = 0; c < 3; c++) add_channel(mean + c, m2 + c, x[c], n);
    return invalid;
}

uint64_t ec_moments_add(const ec_moments *m, const float *colours, double n, uint64_t pixels)
{
    uint64_t invalid = 0;
    for (uint64_t p = 0; p < pixels; p++) invalid += add_pixel(m, p, colours + 3 * p, n);
    return invalid;
}

uint64_t ec_moments_add_some(const ec_moments *m, const float *colours, const uint32_t *places, uint32_t *counts, uint32_t pixels)
{
    uint64_t invalid = 0;
    for (uint32_t i = 0; i < pixels; i++) invalid += add_pixel(m, places[i], colours + 3 * (uint64_t)i, ++counts[places[i]]);
    return invalid;
}

/* Pebay, eqs. 1.5 to 1.7. */
static inline void join_luminance(const ec_moments *a, double n, const ec_moments *b, double m, uint64_t p)
{
    double *m2a = a->m2 + 4 * p + 3, m2b = b->m2[4 * p + 3];
    double m3a = a->m34[2 * p], m3b = b->m34[2 * p], m4a = a->m34[2 * p + 1], m4b = b->m34[2 * p + 1];
    double delta = ec_luminance(b->mean + 3 * p) - ec_luminance(a->mean + 3 * p), step = delta * (1 / (n + m));
    double added = delta * step * n * m; /* what M2 grows by beyond both */
    a->m34[2 * p + 1] = (float)(m4a + m4b + added * step * step * (n * n - n * m + m * m) +
                                6 * step * step * (n * n * m2b + m * m * *m2a) + 4 * step * (n * m3b - m * m3a));
    a->m34[2 * p] = (float)(m3a + m3b + added * step * (n - m) + 3 * step * (n * m2b - m * *m2a));
    *m2a += m2b + added;
}

void ec_moments_join(const ec_moments *a, double n, const ec_moments *b, double m, uint64_t pixels)
{
    double share = m / (n + m);
    for (uint64_t p = 0; p < pixels; p++) {
        a->largest[p] = a->largest[p] < b->largest[p] ? b->largest[p] : a->largest[p];
        join_luminance(a, n, b, m, p);
        for (uint64_t c = 0; c < 3; c++) {
            double delta = b->mean[3 * p + c] - a->mean[3 * p + c], step = delta * share;
            a->mean[3 * p + c] += step;
            a->m2[4 * p + c] += b->m2[4 * p + c] + delta * step * n;
        }
    }
}

void ec_moments_copy(const ec_moments *to, const ec_moments *from, uint64_t pixels)
{
    memcpy(to->mean, from->mean, 3 * pixels * sizeof(double));
    memcpy(to->m2, from->m2, 4 * pixels * sizeof(double));
    memcpy(to->m34, from->m34, 2 * pixels * sizeof(float));
    memcpy(to->largest, from->largest, pixels * sizeof(float));
}

void ec_moments_clear(const ec_moments *m, uint64_t pixels)
{
    memset(m->mean, 0, 3 * pixels * sizeof(double));
    memset(m->m2, 0, 4 * pixels * sizeof(double));
    memset(m->m34, 0, 2 * pixels * sizeof(float));
    memset(m->largest, 0, pixels * sizeof(float));
}
