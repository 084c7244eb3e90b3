/* Random numbers as a function of (seed, pixel, sample, dimension) and of nothing else: no state, so any lane width, wave
 * size or device gives the same ones. Numbers come in pairs; every pair is a dimension of its own.
 *
 * Sobol: the (0,2)-sequence of Sobol's first two dimensions, padded; index shuffled and values scrambled in Owen's way by
 * hashing (Burley 2020, "Practical Hash-based Owen Scrambling", with Vegdahl's constants). Independent: a hash. */
#ifndef EC_LIB_SAMPLER_H
#define EC_LIB_SAMPLER_H

#include "../shared/features.h"
#include "math.h"

/* Pairs: two for the camera, then three a bounce. */
#define EC_PAIR_PIXEL 0u
#define EC_PAIR_LENS 1u
#define EC_PAIR_TIME 0x80000000u /* the time, while the shutter is open: behind all bounces */
#define EC_PAIR_MEDIUM(b) (0x40000000u + (b)) /* how far light goes inside a body that scatters it */
#define EC_PAIR_BOUNCE(b) (2u + 3u * (b))
#define EC_PAIR_LIGHT 0u    /* which light, and the point on it */
#define EC_PAIR_BSDF 1u     /* which lobe, and the direction */
#define EC_PAIR_ROULETTE 2u /* whether the path goes on; at glass also which colour, and whether it passes */

typedef struct sampler {
    lane_u key;   /* hash of seed and pixel */
    lane_u index; /* number of the sample */
} sampler;

/* Integer mixer with low bias (C. Wellons, "hash prospector", 2-round constants of 2022). */
EC_FN lane_u hash_u(lane_u x)
{
    x ^= x >> 16;
    x *= 0x21f0aaadu;
    x ^= x >> 15;
    x *= 0x735a2d97u;
    x ^= x >> 15;
    return x;
}
EC_FN uint hash_scalar(uint x)
{
    x ^= x >> 16;
    x *= 0x21f0aaadu;
    x ^= x >> 15;
    x *= 0x735a2d97u;
    x ^= x >> 15;
    return x;
}

/* Uniform in [0, 1 - 2^-24]: 24 bits, never 1. */
EC_FN lane_f to_unit(lane_u x) { return to_lane_f(x >> 8) * 5.9604644775390625e-8f; }

EC_FN lane_u reverse_bits(lane_u x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/* Owen scrambling of a bit-reversed number: each bit is flipped by a hash of the bits below it (Laine & Karras 2011;
 * constants by N. Vegdahl 2021). */
EC_FN lane_u owen_reversed(lane_u x, lane_u seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* Second Sobol dimension, bit-reversed: over GF(2) its matrix maps the index polynomial i(x) to i(x + 1), done here in
 * five halvings instead of 32 columns. */
EC_FN lane_u sobol_second_reversed(lane_u i)
{
    i ^= i >> 16;
    i ^= (i & 0xff00ff00u) >> 8;
    i ^= (i & 0xf0f0f0f0u) >> 4;
    i ^= (i & 0xccccccccu) >> 2;
    i ^= (i & 0xaaaaaaaau) >> 1;
    return i;
}

EC_FN sampler sampler_make(uint seed, lane_u pixel, lane_u index)
{
    sampler s;
    s.key = hash_u(hash_u(pixel) ^ seed);
    s.index = index;
    return s;
}

/* Two 32-bit random integers of dimension `pair`. */
EC_FN void sample_pair_u(sampler s, uint pair, lane_u *a, lane_u *b)
{
    lane_u k = hash_u(s.key ^ (pair * 0x9e3779b9u));
    if (HAS(SOBOL)) {
        lane_u i = reverse_bits(owen_reversed(reverse_bits(s.index), k));
        *a = reverse_bits(owen_reversed(i, k * 0x2c1b3c6du + 0x68bc21ebu));
        *b = reverse_bits(owen_reversed(sobol_second_reversed(i), k * 0x297a2d39u + 0x02e5be93u));
    } else {
        lane_u h = k + s.index * 0x9e3779b9u;
        *a = hash_u(h);
        *b = hash_u(h ^ 0x68e31da4u);
    }
}

EC_FN void sample_pair(sampler s, uint pair, lane_f *a, lane_f *b)
{
    lane_u x, y;
    sample_pair_u(s, pair, &x, &y);
    *a = to_unit(x);
    *b = to_unit(y);
}

#endif
