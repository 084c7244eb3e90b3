/* Adds rows to the report. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "selftest/cases.h"

/* Returns how many digits a relative error leaves. */
static double digits_of(double relative)
{
    if (!(relative < 1)) return 0; /* also for NaN */
    return fmin(-log10(relative), EC_SELFTEST_DIGITS);
}

static ec_result add(ec_selftest *t, const char *what, ec_selftest_row row, const char *note, ec_error *err)
{
    ec_selftest_report *r = t->report;
    ec_selftest_row *grown = realloc(r->rows, (r->count + 1) * sizeof *grown);
    if (!grown) return ec_fail(err, "out of memory for the report");
    r->rows = grown;
    row.breaks = t->current->breaks;
    row.pass = fabs(row.measured - row.expected) <= row.tolerance; /* false for NaN */
    snprintf(row.name, sizeof row.name, "%s%s%s", t->current->name, *what ? " " : "", what);
    snprintf(row.note, sizeof row.note, "%s", note ? note : "");
    r->rows[r->count++] = row;
    return EC_OK;
}

ec_result ec_selftest_value(ec_selftest *t, const char *what, double expected, double measured, double noise, double tolerance,
                            ec_error *err)
{
    double off = fmax(fabs(measured - expected), noise);
    ec_selftest_row row = {.expected = expected, .measured = measured, .tolerance = tolerance, .noise = noise,
                           .digits = isfinite(measured) ? digits_of(expected != 0 ? off / fabs(expected) : off) : 0};
    return add(t, what, row, NULL, err);
}

ec_result ec_selftest_largest(ec_selftest *t, const char *what, double error, double tolerance, const char *note, ec_error *err)
{
    ec_selftest_row row = {.measured = error, .tolerance = tolerance, .digits = digits_of(error)};
    return add(t, what, row, note, err);
}

ec_result ec_selftest_none(ec_selftest *t, const char *what, uint64_t wrong, uint64_t of, const char *note, ec_error *err)
{
    char all[sizeof((ec_selftest_row *)0)->note];
    ec_selftest_row row = {.measured = (double)wrong, .digits = digits_of(fmax((double)wrong, 1) / (double)of)};
    snprintf(all, sizeof all, "of %llu%s%s", (unsigned long long)of, note && *note ? "; " : "", note ? note : "");
    return add(t, what, row, all, err);
}

ec_result ec_selftest_broken(ec_selftest *t, const char *why, ec_error *err)
{
    return add(t, "", (ec_selftest_row){.measured = NAN}, why, err);
}
