/* A picture with what is known of its noise. Owns no memory. */
#ifndef EC_FILM_MEASURED_H
#define EC_FILM_MEASURED_H

#include <math.h>
#include <stdint.h>

typedef struct ec_measured {
    uint32_t width, height;
    const float *rgb;     /* 3 a pixel, finite */
    const float *se;      /* 3 a pixel: standard errors, finite; NULL if they are not known, which counts as none */
    const float *se_y;    /* 1 a pixel: of luminance; NULL if not known */
    double replicates;    /* independent estimates behind the standard errors; INFINITY if not known */
    double samples;       /* a pixel; 0 if not known */
    int is_half;          /* the values were rounded to 16 bits */
    const float *slack;   /* 3 a pixel: by how much values may be off, all of them in one direction, as stored in few bits; NULL: not at all */
    const uint8_t *mask;  /* 1 a pixel: 0 does not count; NULL: all do */
    double peak;          /* the largest value there can be; 0: there is no limit */
    const float *tail_se; /* 3 a pixel: in place of se where single values are judged, as noise reaches further to one side; NULL: se */
} ec_measured;

/* Two values closer than this are the same number after rounding: other orders of addition (a few ulps of a float), other
 * devices, storage as half. */
static inline double ec_rounding(const ec_measured *a, const ec_measured *b, double x, double y)
{
    double largest = fmax(fabs(x), fabs(y));
    return a->is_half || b->is_half ? 0x1p-10 * largest + 0x1p-24 : 1e-5 * largest;
}

/* Returns whether a pixel counts in both pictures. */
static inline int ec_counts(const ec_measured *a, const ec_measured *b, uint64_t pixel)
{
    return (!a->mask || a->mask[pixel]) && (!b->mask || b->mask[pixel]);
}

static inline double ec_slack(const ec_measured *a, const ec_measured *b, uint64_t value)
{
    return (a->slack ? (double)a->slack[value] : 0) + (b->slack ? (double)b->slack[value] : 0);
}

#endif
