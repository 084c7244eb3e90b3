/* What `eclat selftest` and its kernels in kernels/selftest tell each other: arrays of n values, one after the other. */
#ifndef EC_SHARED_SELFTEST_H
#define EC_SHARED_SELFTEST_H

#include "types.h"

/* ec_scatter: a surface, wo, and three numbers that are read both as a direction and as random numbers. */
enum ec_scatter_in {
    EC_SCATTER_BASE,         /* red, green, blue */
    EC_SCATTER_F0 = 3,
    EC_SCATTER_F90,
    EC_SCATTER_METALLIC,
    EC_SCATTER_ALPHA,
    EC_SCATTER_TRANSMISSION,
    EC_SCATTER_ETA,          /* 1: does not refract */
    EC_SCATTER_SMOOTH,       /* 0 or 1 */
    EC_SCATTER_WO,           /* x, y, z */
    EC_SCATTER_W = 13,       /* x, y, z */
    EC_SCATTER_STRETCH = 16, /* of the lobe along x, where kernels have ANISOTROPY */
    EC_SCATTER_INS
};
enum ec_scatter_out {
    EC_SCATTER_F,            /* of direction w, green: with |cos| in it */
    EC_SCATTER_PDF,
    EC_SCATTER_D,            /* GGX's density, w as the microfacet's normal */
    EC_SCATTER_LAMBDA,       /* masking, of w */
    EC_SCATTER_FRESNEL,      /* between dielectrics, of w.z */
    EC_SCATTER_WI,           /* x, y, z: sampled by w as random numbers */
    EC_SCATTER_WI_PDF = 8,
    EC_SCATTER_WEIGHT,       /* green */
    EC_SCATTER_OUTS
};

/* ec_scatter_fuzz: what it counts. */
enum ec_fuzz_count {
    EC_FUZZ_NOT_FINITE,
    EC_FUZZ_NEGATIVE,
    EC_FUZZ_NOT_UNIT,        /* directions */
    EC_FUZZ_ASTRAY,          /* through what is opaque */
    EC_FUZZ_HEAVY,           /* weights over EC_FUZZ_WEIGHT */
    EC_FUZZ_COUNTS
};
/* f / pdf of a mixture is at most the largest ratio of its lobes. A lobe that is there is chosen with probability 0.1 at least, and
 * reflection against transmission by luminance, in which blue weighs 0.0722: 1 / 0.1 / 0.0722, and rounding. */
#define EC_FUZZ_WEIGHT 138.6f

/* ec_numbers: a function of two numbers. */
enum ec_numbers_function {
    EC_NUMBERS_DIVIDE,
    EC_NUMBERS_SQRT,         /* of a */
    EC_NUMBERS_FMA,          /* a b - c in one */
    EC_NUMBERS_LESS,         /* a b - c in two roundings */
    EC_NUMBERS_SIN,          /* of 2 pi a */
    EC_NUMBERS_COS,
    EC_NUMBERS_EXP,          /* of a <= 0 */
    EC_NUMBERS_LOG,          /* of a in (0, 1] */
    EC_NUMBERS_ATAN2,        /* of (a, b), over 2 pi */
    EC_NUMBERS_MIS,          /* weight of a against b */
    EC_NUMBERS_SURVIVAL,     /* of roulette, for a throughput of a */
    EC_NUMBERS_UNIT,         /* the bits of a as a uniform number */
    EC_NUMBERS_IS_FINITE,    /* 1 or 0 */
    EC_NUMBERS_COMPARED,     /* a < b: 1, a > b: 2, a == b: 4, a != b: 8 */
    EC_NUMBERS_ADD,
    EC_NUMBERS_FUNCTIONS
};

#endif
