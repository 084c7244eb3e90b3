/* Assertions for C tests: a failed CHECK prints where and what and is counted; TEST_END returns the verdict to ctest
 * (77 = skipped). */
#ifndef EC_TESTS_SUPPORT_TEST_H
#define EC_TESTS_SUPPORT_TEST_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int test_failures, test_checks;

/* In a file of several tiers, tells whether the parts of that tier run. ctest chooses one; without ctest all run. */
static inline int test_tier(const char *name)
{
    const char *chosen = getenv("ECLAT_TIER");
    return !chosen || !strcmp(chosen, name);
}

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        test_checks++;                                                                             \
        if (!(condition)) {                                                                        \
            test_failures++;                                                                       \
            fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #condition);                \
        }                                                                                          \
    } while (0)

/* With a message: CHECK_MSG(a < b, "a = %g", a) */
#define CHECK_MSG(condition, ...)                                                                  \
    do {                                                                                           \
        test_checks++;                                                                             \
        if (!(condition)) {                                                                        \
            test_failures++;                                                                       \
            fprintf(stderr, "%s:%d: failed: %s: ", __FILE__, __LINE__, #condition);                \
            fprintf(stderr, __VA_ARGS__);                                                          \
            fputc('\n', stderr);                                                                   \
        }                                                                                          \
    } while (0)

#define CHECK_NEAR(a, b, tolerance)                                                                \
    CHECK_MSG(fabs((double)(a) - (double)(b)) <= (double)(tolerance), "%s = %.9g, expected %.9g within %g", #a, \
              (double)(a), (double)(b), (double)(tolerance))

#define CHECK_OK(call, err)                                                                        \
    do {                                                                                           \
        (err).text[0] = 0;                                                                         \
        CHECK_MSG((call) == EC_OK, "%s", (err).text);                                              \
    } while (0)

#define TEST_SKIP(...)                                                                             \
    do {                                                                                           \
        printf("skipped: ");                                                                       \
        printf(__VA_ARGS__);                                                                       \
        putchar('\n');                                                                             \
        return 77;                                                                                 \
    } while (0)

#define TEST_END()                                                                                 \
    do {                                                                                           \
        printf("%d checks, %d failed\n", test_checks, test_failures);                              \
        return test_failures || !test_checks ? 1 : 0;                                              \
    } while (0)

#endif
