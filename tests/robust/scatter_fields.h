/* What scatter.cl and the tests that run it (scatter.h) tell each other: arrays of n values, one after the other. */
#ifndef EC_TESTS_ROBUST_SCATTER_FIELDS_H
#define EC_TESTS_ROBUST_SCATTER_FIELDS_H

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

#endif
