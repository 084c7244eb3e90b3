/* Building blocks of cases, for host/selftest and for tests written as cases. */
#ifndef EC_SELFTEST_CASES_H
#define EC_SELFTEST_CASES_H

#include "selftest/selftest.h"

typedef struct ec_selftest {
    ec_cl *cl;
    bool full;
    uint32_t lanes;        /* a width, never 0 */
    const struct ec_selftest_case *current;
    ec_selftest_report *report;
    struct ec_tracer *tracer; /* set once a case has asked for it: see tracer.h */
} ec_selftest;

/* All cases: CASE(name, is long, function, what breaks elsewhere if it fails). A case is here if a device or its driver may fail it; the short ones
 * together take a few seconds, so that everybody with a new device or driver runs them all. Proofs of formulas and algorithms in the same form are in
 * tests/robust (cases.h). */
#define EC_SELFTEST_CASES(CASE)                                                                                                  \
    CASE("transport/furnace", false, ec_selftest_furnace, "light lost or made at a bounce (Nori's test-furnace)")                \
    CASE("transport/metal", false, ec_selftest_metal, "GGX with a wrong sign or denominator (Heitz 2014)")                       \
    CASE("rays/watertight", false, ec_selftest_watertight, "pinholes at edges and vertices (Woop et al. 2013; embree#387)")      \
    CASE("rays/lane widths", true, ec_selftest_lane_widths, "pictures that depend on the width of a vector")                     \
    CASE("rays/accelerators", true, ec_selftest_accelerators, "pictures that depend on the acceleration structure")              \
    CASE("lights/facing squares", false, ec_selftest_facing_squares, "form factors (Siegel and Howell, C-11)")                   \
    CASE("lights/punctual", false, ec_selftest_punctual, "units of glTF's lights")                                               \
    CASE("environment/sun", false, ec_selftest_sun, "float tables lose dim texels, 0/0 in black rows (pbrt, Mitsuba)")           \
    CASE("scatter/slab", false, ec_selftest_slabs, "glass that darkens or brightens what is behind it")                          \
    CASE("scatter/nested glass", false, ec_selftest_nested_glass, "black glass: paths lost at faces or by depth")                \
    CASE("scatter/white milk", true, ec_selftest_milk, "light lost on its way through what scatters it")                         \
    CASE("numbers/arithmetic", false, ec_selftest_arithmetic, "cracks between triangles: products contracted (half of all)")     \
    CASE("numbers/functions", false, ec_selftest_functions, "directions off the sphere")                                         \
    CASE("numbers/not finite", false, ec_selftest_not_finite, "tests for NaN folded away: black pixels that nobody counts")      \
    CASE("numbers/random", false, ec_selftest_random, "other pictures than elsewhere, patterns between pixels")                  \
    CASE("numbers/sums", false, ec_selftest_sums, "pictures that darken with more samples: float sums (-58 % at 1e8)")

typedef ec_result ec_selftest_function(ec_selftest *t, ec_error *err);
#define EC_SELFTEST_DECLARE(name, is_long, function, breaks) ec_selftest_function function;
EC_SELFTEST_CASES(EC_SELFTEST_DECLARE)

typedef struct ec_selftest_case {
    const char *name;      /* group/case */
    bool is_long;          /* runs with --full only */
    ec_selftest_function *run;
    const char *breaks;
} ec_selftest_case;

/* Like ec_selftest_run, for these cases. */
ec_result ec_selftest_run_cases(ec_cl *cl, const ec_selftest_case *cases, uint32_t count, const ec_selftest_options *options,
                                ec_selftest_report *report, ec_error *err);

/* Each of these adds a row to the report. `what` follows the case's name; "" if it has only one row. They fail only for lack of memory. */

/* Compares a value. noise: its standard error, 0 for none; tolerance: absolute. */
ec_result ec_selftest_value(ec_selftest *t, const char *what, double expected, double measured, double noise, double tolerance,
                            ec_error *err);
/* Compares the largest relative error of many values with 0. note (may be NULL): where it is. */
ec_result ec_selftest_largest(ec_selftest *t, const char *what, double error, double tolerance, const char *note, ec_error *err);
/* Compares the number of wrong values with 0. Digits: -log10 of the share if one were wrong. */
ec_result ec_selftest_none(ec_selftest *t, const char *what, uint64_t wrong, uint64_t of, const char *note, ec_error *err);
/* Records that the case could not be run. */
ec_result ec_selftest_broken(ec_selftest *t, const char *why, ec_error *err);

#endif
