/* Macros for kernel tests. A test is one file tests/kernel/test_NAME.cl and nothing else. Every kernel in it has the argument `global
 * test_result *result` and, if it needs memory, `global uint *scratch` (TEST_SCRATCH_WORDS words of 0). It runs as a single work-item for
 * each LANES (1, 4, 8, 16). A line that starts with "// options: " requests a build with these options; several such lines request several
 * builds.
 *
 * Functions that use CHECK name the argument `result` too. The header is also legal C11, for the driver. */
#ifndef EC_TESTS_KERNEL_TEST_H
#define EC_TESTS_KERNEL_TEST_H

#include "shared/types.h"

#define TEST_SCRATCH_WORDS 4096

enum test_value_kind { TEST_NO_VALUES, TEST_FLOATS, TEST_UINTS };

typedef struct test_result {
    ec_uint checks;
    ec_uint failures;
    ec_uint line;         /* this and the rest: of the first failure */
    ec_uint kind;         /* test_value_kind */
    ec_uint count;        /* number of values */
    ec_uint values[4];    /* bits */
    ec_uint pad[3];
} test_result;
EC_ASSERT_SIZE(test_result, 48);

#ifdef __OPENCL_VERSION__
static inline void test_record(global test_result *result, int good, uint line, uint kind, uint count, uint4 values) {
    result->checks++;
    if (good || result->failures++) return;
    result->line = line;
    result->kind = kind;
    result->count = count;
    vstore4(values, 0, result->values);
}

#define CHECK(condition) test_record(result, (condition) != 0, __LINE__, TEST_NO_VALUES, 0, (uint4)(0u))
/* With up to four floats, or uints, which are printed when the check fails. */
#define CHECK_FLOATS(condition, a, b, c, d)                                                        \
    test_record(result, (condition) != 0, __LINE__, TEST_FLOATS, 4, as_uint4((float4)(a, b, c, d)))
#define CHECK_UINTS(condition, a, b, c, d)                                                         \
    test_record(result, (condition) != 0, __LINE__, TEST_UINTS, 4, (uint4)(a, b, c, d))
/* Integers, up to 32 bits. */
#define CHECK_EQUAL(a, b)                                                                          \
    test_record(result, (uint)(a) == (uint)(b), __LINE__, TEST_UINTS, 2, (uint4)((uint)(a), (uint)(b), 0u, 0u))
/* Floats. NaN is near no number. */
#define CHECK_NEAR(a, b, tolerance)                                                                \
    test_record(result, fabs((float)(a) - (float)(b)) <= (float)(tolerance), __LINE__, TEST_FLOATS, 3, \
                as_uint4((float4)(a, b, tolerance, 0.0f)))
#define CHECK_SAME_BITS(a, b)                                                                      \
    test_record(result, as_uint((float)(a)) == as_uint((float)(b)), __LINE__, TEST_FLOATS, 2,      \
                as_uint4((float4)(a, b, 0.0f, 0.0f)))
#endif

#endif
