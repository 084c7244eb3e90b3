/* eclat selftest */
#include <string.h>

#include "commands/command.h"
#include "jobs/setters.h"
#include "jobs/telling.h"
#include "selftest/report_print.h"

typedef struct request {
    const char *device;
    bool json, quiet;
    ec_selftest_options options;
} request;

#define REQUEST ((request *)target)

FLAG_SETTER(full, options.full)
FLAG_SETTER(json, json)
FLAG_SETTER(quiet, quiet)
TEXT_SETTER(device, device)
PARSED_SETTER(lanes, ec_parse_lanes, options.lanes)

SETTER(only)
{
    (void)option, (void)err;
    REQUEST->options.only = value;
    return EC_OK;
}

static const ec_option options[] = {
    {.name = "device", .metavar = "ID", .set = set_device, .help = "OpenCL device, as for eclat render"},
    {.name = "full", .set = set_full, .help = "run more rays and samples, every lane width and every structure; this takes some minutes on a processor"},
    {.name = "json", .set = set_json, .help = "print one JSON object instead of a table"},
    {.name = "lanes", .metavar = "N", .set = set_lanes, .choices = ec_lanes_names, .help = "paths per work-item: 1, 4, 8, 16 or auto", .otherwise = "auto"},
    {.name = "only", .metavar = "NAME", .set = set_only, .help = "run only the cases whose name contains NAME"},
    {.name = "quiet", .letter = 'q', .set = set_quiet, .help = "print only the rows that failed, and nothing if none did"},
};

EC_ROWS(options)

static bool show(void *user, const char *name, uint32_t done, uint32_t count)
{
    const ec_step step = {.doing = name, .done = done + 1, .count = count, .fraction = (double)done / count, .seconds_left = -1};
    return ec_listener_step(user, &step);
}

static ec_result tell(const request *r, const ec_selftest_report *report, const ec_device_info *device, uint32_t index, const ec_listener *listener,
                      ec_error *err)
{
    ec_telling t;
    ec_result result = EC_OK;
    EC_TRY(ec_telling_begin(&t, listener, err));
    if (r->json) result = ec_selftest_report_json(report, device, index, t.to, err);
    else ec_selftest_report_text(report, r->quiet, t.to);
    return ec_telling_end(&t, result, err);
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
    ec_listener_begin(listener, NULL, true);
    EC_TRY_CLEANUP(ec_cl_open(&device, &cl, err));
    cl.keeps_programs = true;
    ec_say(&listener->log, "testing %s, %s", device.name, device.driver);
    result = ec_selftest_run(&cl, &r->options, &report, err);
    ec_listener_end(listener);
    if (result == EC_OK) result = tell(r, &report, &device, index, listener, err);
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
