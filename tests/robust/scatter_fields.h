/* Layout of the arrays between scatter.cl and the tests that run it (scatter.h): n values of each field, one field after the other. */
#ifndef EC_TESTS_ROBUST_SCATTER_FIELDS_H
#define EC_TESTS_ROBUST_SCATTER_FIELDS_H

/* ec_scatter: a surface, wo, and three numbers that serve as a direction and as random numbers. */
enum ec_scatter_in {
    EC_SCATTER_BASE,         /* red, green, blue */
    EC_SCATTER_F0 = 3,
    EC_SCATTER_F90,
    EC_SCATTER_METALLIC,
    EC_SCATTER_ALPHA,
    EC_SCATTER_TRANSMISSION,
    EC_SCATTER_ETA,          /* 1: no refraction */
    EC_SCATTER_SMOOTH,       /* 0 or 1 */
    EC_SCATTER_WO,           /* x, y, z */
    EC_SCATTER_W = 13,       /* x, y, z */
    EC_SCATTER_STRETCH = 16, /* the lobe's width along x, in kernels with ANISOTROPY */
    EC_SCATTER_INS
};
enum ec_scatter_out {
    EC_SCATTER_F,            /* for direction w, green: |cos| is included */
    EC_SCATTER_PDF,
    EC_SCATTER_D,            /* GGX's density, with w as the microfacet's normal */
    EC_SCATTER_LAMBDA,       /* masking of w */
    EC_SCATTER_FRESNEL,      /* reflectance between dielectrics, of w.z */
    EC_SCATTER_WI,           /* x, y, z: direction sampled with w as random numbers */
    EC_SCATTER_WI_PDF = 8,
    EC_SCATTER_WEIGHT,       /* green */
    EC_SCATTER_OUTS
};

/* ec_scatter_fuzz: its counters. */
enum ec_fuzz_count {
    EC_FUZZ_NOT_FINITE,
    EC_FUZZ_NEGATIVE,
    EC_FUZZ_NOT_UNIT,        /* directions */
    EC_FUZZ_ASTRAY,          /* directions through an opaque surface */
    EC_FUZZ_HEAVY,           /* weights above EC_FUZZ_WEIGHT */
    EC_FUZZ_COUNTS
};
/* The weight f / pdf of a mixture is at most the largest ratio of a lobe's light to its probability. A lobe is chosen with probability 0.1
 * at least, and reflection against transmission by luminance, in which blue weighs 0.0722: 1 / 0.1 / 0.0722, and rounding. */
#define EC_FUZZ_WEIGHT 138.6f

#endif
