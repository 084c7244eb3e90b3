/* eclat selftest */
#include <string.h>

#include "commands/command.h"
#include "jobs/numbers.h"
#include "selftest/report_print.h"

typedef struct request {
    const char *device;
    ec_selftest_options options;
} request;

#define REQUEST request

/* An empty value chooses all cases. */
static ec_result set_only(void *target, const char *option, const char *value, ec_error *err)
{
    (void)option, (void)err;
    ((request *)target)->options.only = value;
    return EC_OK;
}

static const ec_option options[] = {
    {.name = "device", .metavar = "ID", EC_STORED(TEXT, device), .help = "OpenCL device, as for eclat render"},
    {.name = "full", EC_STORED(FLAG, options.full), .help = "run more rays and samples, every lane width and every structure; this takes some minutes on a processor"},
    {.name = "json", .help = "print one JSON object instead of a table"},
    {.name = "lanes", .metavar = "N", EC_STORED(LANES, options.lanes), .choices = ec_lanes_names, .help = "paths per work-item: 1, 4, 8, 16 or auto", .otherwise = "auto"},
    {.name = "only", .metavar = "NAME", .set = set_only, .help = "run only the cases whose name contains NAME"},
    {.name = "quiet", .letter = 'q', .help = "print only the rows that failed, and nothing if none did"},
};

EC_ROWS(options)

static bool show(void *user, const char *name, uint32_t done, uint32_t count)
{
    const ec_listener *listener = user;
    const ec_step step = {.doing = name, .done = done + 1, .count = count, .fraction = (double)done / count, .seconds_left = -1};
    return listener->step(listener->user, &step);
}

static ec_result run(ec_call *call, ec_error *err)
{
    request *r = call->request;
    const ec_listener *listener = call->listener;
    ec_device_info device;
    uint32_t index;
    ec_cl cl = {0};
    ec_selftest_report report = {0};
    ec_result result;
    if (call->input_count) return ec_usage(err, "selftest takes no operand, not '%s'; --only NAME chooses cases", call->inputs[0]);
    EC_TRY(ec_device_find(r->device, &device, &index, NULL, err));
    r->options.go_on = show;
    r->options.user = (void *)(uintptr_t)listener;
    EC_TRY_CLEANUP(ec_cl_open(&device, &cl, err));
    listener->begin(listener->user, NULL, true);
    cl.keeps_programs = true;
    ec_say(&listener->log, "testing %s, %s", device.name, device.driver);
    result = ec_selftest_run(&cl, &r->options, &report, err);
    listener->end(listener->user);
    if (result == EC_OK && call->json) result = ec_selftest_report_json(&report, &device, index, listener->to, err);
    else if (result == EC_OK) ec_selftest_report_text(&report, call->quiet, listener->to);
    call->says_no = report.failed > 0;
cleanup:
    ec_selftest_free(&report);
    ec_cl_close(&cl);
    return result;
}

static const eclat_note notes[] = {
    {"Columns", "expected", "the value from a closed form or from double precision; the measured one must lie within the tolerance of it"},
    {"Columns", "tolerance", "from the number of rounded operations, or four standard errors of what is sampled"},
    {"Columns", "digits",
     "correct decimal digits, of the 7.2 that a float has; of sampled values, those that noise does not hide; of counts (expected: none), those of the number"},
    {0}};

const ec_command ec_cmd_selftest = {
    .told = {.name = "selftest", .operands = "[options]", .summary = "test a device and its driver on hard cases with known answers",
             .intro = "Runs hard cases with known answers on a device, to show whether its pictures, with this driver, can be trusted. Prints a row for each, the worst "
                       "first; the exit code is 1 if one fails.",
             .notes = notes},
    .rows = list_rows, .size = sizeof(request), .run = run,
};
