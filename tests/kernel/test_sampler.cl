/* Random numbers: stratification, independence, uniformity, of both samplers. */
// options: -DFEATURES=EC_FEATURE_SOBOL
// options: -DFEATURES=0
#include "kernel_test.h"
#include "lib/sampler.h"

/* Sample i of a pixel, in any lane. */
kernel void lanes_do_not_matter(global test_result *result)
{
    uint a[16], b[16], c[16], d[16];
    lane_u x, y;
    for (uint pair = 0; pair < 6; pair++) {
        sample_pair_u(sampler_make(7, LANE_NUMBERS + 100u * U(1), LANE_NUMBERS * 3u + 5u), pair, &x, &y);
        LANE_STORE(x, a);
        LANE_STORE(y, b);
        for (uint k = 0; k < LANES; k++) {
            sample_pair_u(sampler_make(7, U(100u + k), U(3u * k + 5u)), pair, &x, &y);
            LANE_STORE(x, c);
            LANE_STORE(y, d);
            CHECK_UINTS(c[0] == a[k] && d[0] == b[k], c[0], a[k], d[0], b[k]);
        }
    }
}

#define MOST 256

static void take(uint seed, uint pixel, uint pair, uint from, uint count, uint *a, uint *b)
{
    for (uint i = 0; i < count; i += LANES) {
        lane_u x, y;
        uint xs[16], ys[16];
        sample_pair_u(sampler_make(seed, U(pixel), LANE_NUMBERS + (from + i)), pair, &x, &y);
        LANE_STORE(x, xs);
        LANE_STORE(y, ys);
        for (uint k = 0; k < LANES && i + k < count; k++) {
            a[i + k] = xs[k];
            b[i + k] = ys[k];
        }
    }
}

/* Checks that each box of 2^-j by 2^(j-k), for every j, contains one of the 2^k points. */
static bool is_net(const uint *a, const uint *b, uint k)
{
    for (uint j = 0; j <= k; j++) {
        uint seen[MOST / 32 + 1] = {0};
        for (uint i = 0; i < 1u << k; i++) {
            uint column = j ? a[i] >> (32u - j) : 0u, row = j < k ? b[i] >> (32u - (k - j)) : 0u;
            uint cell = column << (k - j) | row;
            if (seen[cell / 32u] & (1u << cell % 32u)) return false;
            seen[cell / 32u] |= 1u << cell % 32u;
        }
    }
    return true;
}

kernel void blocks_are_stratified(global test_result *result)
{
    uint a[MOST], b[MOST];
    uint nets = 0, blocks = 0;
    for (uint trial = 0; trial < 24; trial++)
        for (uint k = 0; k <= 8; k++) {
            uint block = trial % 4u + (trial == 23 ? 1000u : 0u);
            take(trial, hash_scalar(trial), trial % 5u, block << k, 1u << k, a, b);
            bool net = is_net(a, b, k);
            if (HAS(SOBOL)) CHECK_UINTS(net, trial, k, block, 0);
            nets += k >= 4 && net;
            blocks += k >= 4;
        }
    if (!HAS(SOBOL)) CHECK_UINTS(nets == 0, nets, blocks, 0, 0); /* otherwise this test shows nothing */
}

/* Pearson's correlation, and a check of the variances, for pairs of 32-bit numbers. */
typedef struct moments {
    float n, x, y, xx, yy, xy;
} moments;
static void moments_add(moments *m, uint a, uint b)
{
    float x = (float)a * 0x1p-32f - 0.5f, y = (float)b * 0x1p-32f - 0.5f;
    m->n += 1.0f;
    m->x += x;
    m->y += y;
    m->xx += x * x;
    m->yy += y * y;
    m->xy += x * y;
}
static float correlation(const moments *m)
{
    float cxy = m->xy - m->x * m->y / m->n;
    return cxy / sqrt((m->xx - m->x * m->x / m->n) * (m->yy - m->y * m->y / m->n));
}

#define PIXELS 4096u
#define BOUND (4.0f / 64.0f) /* 4 / sqrt(PIXELS) */

/* Over many pixels at one sample number: neighbouring pixels, both numbers of a pair, other pairs, batches and samples. */
kernel void pixels_are_independent(global test_result *result)
{
    for (uint sample = 0; sample < 3; sample++) {
        moments right = {0}, below = {0}, within = {0}, pair = {0}, seed = {0}, next = {0};
        for (uint pixel = 0; pixel < PIXELS; pixel += LANES) {
            lane_u a, b, c, d, e, f, p = LANE_NUMBERS + pixel;
            uint s = sample * 5u;
            uint va[16], vb[16], vc[16], vd[16], ve[16], vf[16], vg[16];
            sample_pair_u(sampler_make(1, p, U(s)), 0, &a, &b);
            LANE_STORE(a, va);
            LANE_STORE(b, vb);
            sample_pair_u(sampler_make(1, p + 1u, U(s)), 0, &c, &d);
            LANE_STORE(c, vc);
            sample_pair_u(sampler_make(1, p + 64u, U(s)), 0, &c, &d);
            LANE_STORE(c, vd);
            sample_pair_u(sampler_make(1, p, U(s)), 2, &c, &d);
            LANE_STORE(c, ve);
            sample_pair_u(sampler_make(2, p, U(s)), 0, &e, &f);
            LANE_STORE(e, vf);
            sample_pair_u(sampler_make(1, p, U(s + 4u)), 0, &e, &f);
            LANE_STORE(e, vg);
            for (uint k = 0; k < LANES; k++) {
                moments_add(&right, va[k], vc[k]);
                moments_add(&below, va[k], vd[k]);
                moments_add(&within, va[k], vb[k]);
                moments_add(&pair, va[k], ve[k]);
                moments_add(&seed, va[k], vf[k]);
                moments_add(&next, va[k], vg[k]);
            }
        }
        /* Samples 0 and 4, 5 and 9, 10 and 14 of one sequence repel each other: no limit for these with Sobol. */
        CHECK_FLOATS(fabs(correlation(&right)) < BOUND, correlation(&right), sample, 0, 0);
        CHECK_FLOATS(fabs(correlation(&below)) < BOUND, correlation(&below), sample, 0, 0);
        CHECK_FLOATS(fabs(correlation(&within)) < BOUND, correlation(&within), sample, 0, 0);
        CHECK_FLOATS(fabs(correlation(&pair)) < BOUND, correlation(&pair), sample, 0, 0);
        CHECK_FLOATS(fabs(correlation(&seed)) < BOUND, correlation(&seed), sample, 0, 0);
        if (!HAS(SOBOL)) CHECK_FLOATS(fabs(correlation(&next)) < BOUND, correlation(&next), sample, 0, 0);
        /* Mean 1/2 within 4 standard errors, sqrt(1 / 12 / PIXELS). */
        CHECK_NEAR(right.x / right.n, 0.0f, 4.0f * 0.0045106f);
        CHECK_NEAR(within.y / within.n, 0.0f, 4.0f * 0.0045106f);
        CHECK_NEAR(right.xx / right.n, 1.0f / 12.0f, 0.005f);
    }
}

/* 8 x 8 cells over pixels: chi-square with 63 degrees of freedom exceeds 122 once in 10^5. */
kernel void pixels_are_uniform(global test_result *result)
{
    for (uint trial = 0; trial < 8; trial++) {
        uint cells[64] = {0};
        for (uint pixel = 0; pixel < PIXELS; pixel += LANES) {
            lane_u a, b;
            uint va[16], vb[16];
            sample_pair_u(sampler_make(trial / 4u, LANE_NUMBERS + pixel, U(trial * 3u)), trial, &a, &b);
            LANE_STORE(a, va);
            LANE_STORE(b, vb);
            for (uint k = 0; k < LANES; k++) cells[(va[k] >> 29) * 8u + (vb[k] >> 29)]++;
        }
        float chi2 = 0.0f;
        for (uint i = 0; i < 64; i++) chi2 += ((float)cells[i] - 64.0f) * ((float)cells[i] - 64.0f) / 64.0f;
        CHECK_FLOATS(chi2 < 122.0f && chi2 > 25.0f, chi2, trial, 0, 0);
    }
}
