/* Hard cases with known answers, run on one device: does it, with this driver, still compute what it should?
 *
 * A case is a function that reports rows. A row compares a measured with an expected value, which comes from a closed form or from
 * double precision on the host, within a tolerance that is derived: the case says from what. */
#ifndef EC_SELFTEST_SELFTEST_H
#define EC_SELFTEST_SELFTEST_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"
#include "cl/cl.h"

/* The precision of a float: -log10(2^-24). No row shows more. */
#define EC_SELFTEST_DIGITS 7.22

typedef struct ec_selftest_row {
    char name[80];         /* group/case, and what varies */
    const char *breaks;    /* what goes wrong where this fails, and the source; static */
    double expected, measured, tolerance; /* passes where |measured - expected| <= tolerance */
    double noise;          /* standard error of what was measured; 0: none */
    double digits;         /* that survived: -log10 of the relative difference, or of the noise where that is more */
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
    bool full;             /* the long cases too */
    const char *only;      /* cases whose name holds this; NULL: all */
    uint32_t lanes;        /* 0: what suits the device */
    /* Asked before each case; false ends the run. NULL: never ends. */
    bool (*go_on)(void *user, const char *name, uint32_t done, uint32_t count);
    void *user;
} ec_selftest_options;

/* Set cl->keeps_programs, since most cases share theirs. A case that cannot be run at all (kernels do not build, out of memory) is a failed
 * row. Fails where no case fits `only`, or memory ends. */
ec_result ec_selftest_run(ec_cl *cl, const ec_selftest_options *options, ec_selftest_report *report, ec_error *err);

#endif
