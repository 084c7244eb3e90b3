/* Runs cases that are written as those of `eclat selftest` are (selftest/cases.h), each to its full length. They prove a formula or an
 * algorithm rather than a device. Every row must pass. */
#ifndef EC_TESTS_ROBUST_CASES_H
#define EC_TESTS_ROBUST_CASES_H

#include "kernel/kernel_run.h"
#include "selftest/cases.h"

static inline int run_cases(const ec_selftest_case *cases, uint32_t count)
{
    const ec_selftest_options options = {.full = true};
    ec_selftest_report report = {0};
    ec_error err = {0};
    ec_cl cl = {0};
    int opened = kernel_open(&cl);
    if (opened) return opened;
    cl.keeps_programs = true;
    CHECK_OK(ec_selftest_run_cases(&cl, cases, count, &options, &report, &err), err);
    for (uint32_t i = 0; i < report.count; i++) {
        const ec_selftest_row *r = &report.rows[i];
        printf("%-6s %-50s %12.6g %12.6g %10.2g %5.1f %s\n", r->pass ? "ok" : "FAILED", r->name, r->expected, r->measured, r->tolerance, r->digits, r->note);
        CHECK_MSG(r->pass, "%s: %.9g, expected %.9g within %g; %s; breaks: %s", r->name, r->measured, r->expected, r->tolerance, r->note, r->breaks);
    }
    ec_selftest_free(&report);
    ec_cl_close(&cl);
    TEST_END();
}
#define RUN_CASES(cases) run_cases(cases, sizeof(cases) / sizeof(cases)[0])

#endif
