/* What cases are made of, in host/selftest and in those tests that are written as cases. */
#ifndef EC_SELFTEST_CASES_H
#define EC_SELFTEST_CASES_H

#include "selftest/case_list.h"
#include "selftest/selftest.h"

typedef struct ec_selftest {
    ec_cl *cl;
    bool full;
    uint32_t lanes;        /* a width: never 0 */
    const struct ec_selftest_case *current;
    ec_selftest_report *report;
    struct ec_tracer *tracer; /* once a case has asked for it: see tracer.h */
} ec_selftest;

typedef ec_result ec_selftest_function(ec_selftest *t, ec_error *err);
#define EC_SELFTEST_DECLARE(name, is_long, function, breaks) ec_selftest_function function;
EC_SELFTEST_CASES(EC_SELFTEST_DECLARE)

typedef struct ec_selftest_case {
    const char *name;      /* group/case */
    bool is_long;          /* runs with --full only */
    ec_selftest_function *run;
    const char *breaks;
} ec_selftest_case;

/* As ec_selftest_run, for these cases. */
ec_result ec_selftest_run_cases(ec_cl *cl, const ec_selftest_case *cases, uint32_t count, const ec_selftest_options *options,
                                ec_selftest_report *report, ec_error *err);

/* Each of these adds a row to the report. `what` follows the case's name; "" where it has only one row. All can only fail for want
 * of memory. */

/* A value. noise: its standard error, 0 for none; tolerance: absolute. */
ec_result ec_selftest_value(ec_selftest *t, const char *what, double expected, double measured, double noise, double tolerance,
                            ec_error *err);
/* The largest relative error of many values: expected 0. note (may be NULL): where it is. */
ec_result ec_selftest_largest(ec_selftest *t, const char *what, double error, double tolerance, const char *note, ec_error *err);
/* How many of so many are wrong: expected 0. Digits: -log10 of the share, were one wrong. */
ec_result ec_selftest_none(ec_selftest *t, const char *what, uint64_t wrong, uint64_t of, const char *note, ec_error *err);
/* The case could not be run. */
ec_result ec_selftest_broken(ec_selftest *t, const char *why, ec_error *err);

#endif
