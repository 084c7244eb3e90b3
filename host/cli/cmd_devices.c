/* eclat devices */
#include <stdlib.h>
#include <string.h>

#include "cl/cl.h"
#include "cli/cli.h"
#include "jobs/option_parser.h"
#include "jobs/usage.h"
#include "report/device_report.h"

static ec_result set_json(void *target, const char *option, const char *value, ec_error *err)
{
    (void)option, (void)value, (void)err;
    *(bool *)target = true;
    return EC_OK;
}

static const ec_option options[] = {{.name = "json", .set = set_json, .help = "print one JSON object instead of a table"}};

int ec_devices_rows(ec_option *rows)
{
    memcpy(rows, options, sizeof options);
    return sizeof options / sizeof options[0];
}

ec_result ec_cmd_devices(ec_cli *cli, int argc, char **argv, ec_error *err)
{
    bool json = false;
    int first = 0;
    ec_request asked;
    EC_TRY(ec_options_parse(options, 1, &json, argc, argv, &first, NULL, &asked, err));
    if (ec_cli_leaves(cli, asked)) return EC_OK;
    if (first < argc) return ec_usage(err, "devices takes no operand, not '%s'", argv[first]);

    ec_device_info *devices = NULL;
    ec_device_report report = {.chosen = -1};
    EC_TRY(ec_devices_list(&devices, &report.count, err));
    report.devices = devices;

    /* A wrong ECLAT_DEVICE must not hide the list that mends it. */
    uint32_t chosen = 0;
    ec_error reason = {0};
    if (ec_device_choose(devices, report.count, NULL, &chosen, &report.why, &reason) == EC_OK) {
        report.chosen = chosen;
    } else {
        ec_log log = ec_console_log(&cli->console);
        ec_warn(&log, "%s", reason.text);
        report.why = reason.text;
    }
    ec_result result = EC_OK;
    if (json)
        result = ec_device_report_json(&report, stdout, err);
    else
        ec_device_report_text(&report, stdout);
    free(devices);
    return result;
}
