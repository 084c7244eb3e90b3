/* Hard cases with known answers, run on one device, to check that it computes correctly with its driver.
 *
 * A case is a function that reports rows. A row compares a measured with an expected value, which comes from a closed form or from double precision
 * on the host. The tolerance is derived; the case says from what. */
#ifndef EC_SELFTEST_SELFTEST_H
#define EC_SELFTEST_SELFTEST_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"
#include "cl/cl.h"

/* Precision of a float: -log10(2^-24). No row shows more. */
#define EC_SELFTEST_DIGITS 7.22

typedef struct ec_selftest_row {
    char name[80];         /* group/case, and what varies */
    const char *breaks;    /* what goes wrong elsewhere if this fails, and the source; static */
    double expected, measured, tolerance; /* passes if |measured - expected| <= tolerance */
    double noise;          /* standard error of the measured value; 0: none */
    double digits;         /* correct ones: -log10 of the relative difference, or of the noise if that is larger */
    double seconds;
    bool pass;
    char note[160];        /* where it was worst, or what failed; may be empty */
} ec_selftest_row;

typedef struct ec_selftest_report {
    ec_selftest_row *rows; /* worst first: failed, then by digits; owned */
    uint32_t count, failed;
    uint32_t lanes;
    double seconds;
} ec_selftest_report;
void ec_selftest_free(ec_selftest_report *report); /* zero-initialised is fine */

typedef struct ec_selftest_options {
    bool full;             /* runs the long cases too */
    const char *only;      /* only cases whose name contains this; NULL: all */
    uint32_t lanes;        /* 0: the width that suits the device */
    /* Called before each case; returning false ends the run. May be NULL. */
    bool (*go_on)(void *user, const char *name, uint32_t done, uint32_t count);
    void *user;
} ec_selftest_options;

/* Runs the cases. Set cl->keeps_programs, since most cases share theirs. A case that cannot be run at all (kernels do not build, out of memory)
 * becomes a failed row. Fails if no case matches `only`, or memory runs out. */
ec_result ec_selftest_run(ec_cl *cl, const ec_selftest_options *options, ec_selftest_report *report, ec_error *err);

#endif
