/* Runs the cases one after the other. */
#include "selftest/selftest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "device/pipeline.h"
#include "render/render.h"
#include "selftest/cases.h"
#include "selftest/tracer.h"

static bool is_wanted(const ec_selftest_options *o, const ec_selftest_case *c)
{
    return (o->full || !c->is_long) && (!o->only || strstr(c->name, o->only));
}

static ec_result run_case(ec_selftest *t, const ec_selftest_case *c, ec_error *err)
{
    ec_error why = {0};
    uint32_t first = t->report->count;
    double start = ec_now();
    t->current = c;
    if (c->run(t, &why) != EC_OK) EC_TRY(ec_selftest_broken(t, why.text, err));
    for (uint32_t i = first; i < t->report->count; i++)
        t->report->rows[i].seconds = (ec_now() - start) / (t->report->count - first);
    return EC_OK;
}

static int by_trouble(const void *a, const void *b)
{
    const ec_selftest_row *x = a, *y = b;
    if (x->pass != y->pass) return x->pass ? 1 : -1;
    if (x->digits != y->digits) return x->digits < y->digits ? -1 : 1;
    return strcmp(x->name, y->name);
}

static void finish(ec_selftest_report *r)
{
    if (r->count) qsort(r->rows, r->count, sizeof *r->rows, by_trouble);
    for (uint32_t i = 0; i < r->count; i++) r->failed += !r->rows[i].pass;
}

static ec_result run_wanted(ec_selftest *t, const ec_selftest_case *cases, uint32_t count, const ec_selftest_options *options, uint32_t wanted,
                            ec_error *err)
{
    uint32_t done = 0;
    for (uint32_t i = 0; i < count; i++) {
        const ec_selftest_case *c = &cases[i];
        if (!is_wanted(options, c)) continue;
        if (options->go_on && !options->go_on(options->user, c->name, done, wanted))
            return ec_fail(err, "stopped before %s", c->name);
        EC_TRY(run_case(t, c, err));
        done++;
    }
    return EC_OK;
}

ec_result ec_selftest_run_cases(ec_cl *cl, const ec_selftest_case *cases, uint32_t count, const ec_selftest_options *options,
                                ec_selftest_report *report, ec_error *err)
{
    ec_selftest t = {.cl = cl, .full = options->full, .report = report};
    uint32_t wanted = 0;
    double start = ec_now();
    EC_TRY(ec_pipeline_lanes(cl, options->lanes, &t.lanes, err));
    report->lanes = t.lanes;
    for (uint32_t i = 0; i < count; i++) wanted += is_wanted(options, &cases[i]);
    if (!wanted) return ec_fail(err, "no case of the self-test has '%s' in its name", options->only);
    ec_result result = run_wanted(&t, cases, count, options, wanted, err);
    ec_tracer_close(t.tracer);
    EC_TRY(result);
    report->seconds = ec_now() - start;
    finish(report);
    return EC_OK;
}

ec_result ec_selftest_run(ec_cl *cl, const ec_selftest_options *options, ec_selftest_report *report, ec_error *err)
{
#define ROW(name, is_long, function, breaks) {name, is_long, function, breaks},
    static const ec_selftest_case cases[] = {EC_SELFTEST_CASES(ROW)};
    return ec_selftest_run_cases(cl, cases, sizeof cases / sizeof cases[0], options, report, err);
}

void ec_selftest_free(ec_selftest_report *r)
{
    free(r->rows);
    *r = (ec_selftest_report){0};
}
