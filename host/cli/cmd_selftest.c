/* eclat selftest */
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "jobs/option_parser.h"
#include "jobs/setters.h"
#include "cli/stop.h"
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

int ec_selftest_rows(ec_option *rows)
{
    memcpy(rows, options, sizeof options);
    return sizeof options / sizeof options[0];
}

static bool show(void *user, const char *name, uint32_t done, uint32_t count)
{
    char line[160];
    snprintf(line, sizeof line, "%u of %u  %s", done + 1, count, name);
    ec_console_draw(user, line);
    return !ec_stop_requested();
}

static ec_result test_device(ec_cli *cli, const ec_device_info *device, uint32_t index, request *r, ec_error *err)
{
    ec_cl cl = {0};
    ec_selftest_report report = {0};
    ec_result result = EC_FAILED;
    r->options.go_on = show;
    r->options.user = &cli->console;
    ec_stop_catch_signals(ec_console_wants_progress(&cli->console));
    EC_TRY_CLEANUP(ec_cl_open(device, &cl, err));
    cl.keeps_programs = true;
    ec_console_say(&cli->console, "testing %s, %s", device->name, device->driver);
    result = ec_selftest_run(&cl, &r->options, &report, err);
    ec_console_erase(&cli->console);
    if (result != EC_OK) goto cleanup;
    if (r->json) result = ec_selftest_report_json(&report, device, index, stdout, err);
    else ec_selftest_report_text(&report, r->quiet, stdout);
    cli->exit_code = report.failed > 0;
cleanup:
    ec_selftest_free(&report);
    ec_cl_close(&cl);
    return result;
}

ec_result ec_cmd_selftest(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    request r = {0};
    int first = 0;
    ec_request asked;
    EC_TRY(ec_options_parse(options, sizeof options / sizeof options[0], &r, argc, argv, &first, NULL, &asked, err));
    if (ec_cli_leaves(cli, asked)) return EC_OK;
    if (first < argc) return ec_usage(err, "selftest takes no operand, not '%s'; --only NAME chooses cases", argv[first]);
    cli->console.quiet = r.quiet;

    ec_device_info device;
    uint32_t index;
    EC_TRY(ec_device_find(r.device, &device, &index, NULL, err));
    return test_device(cli, &device, index, &r, err);
}
