/* The arrays that `eclat selftest` and its kernels in kernels/selftest exchange: n values each, one after the other. */
#ifndef EC_SHARED_SELFTEST_H
#define EC_SHARED_SELFTEST_H

#include "types.h"

/* ec_numbers: a function of up to three numbers. */
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
    EC_NUMBERS_IS_FINITE,    /* 1 or 0 */
    EC_NUMBERS_COMPARED,     /* a < b: 1, a > b: 2, a == b: 4, a != b: 8 */
    EC_NUMBERS_ADD,
};

#endif
