/* eclat devices */
#include <stdlib.h>

#include "cl/cl.h"
#include "cl/drivers.h"
#include "commands/command.h"
#include "report/device_report.h"

static const ec_option options[] = {{.name = "json", .help = "print one JSON object instead of a table"}};
EC_ROWS(options)

static ec_result run(ec_call *call, ec_error *err)
{
    if (call->input_count) return ec_usage(err, "devices takes no operand, not '%s'", call->inputs[0]);
    ec_device_info *devices = NULL;
    ec_device_report report = {.chosen = -1};
    EC_TRY(ec_devices_list(&devices, &report.count, err));
    report.devices = devices;

    /* An invalid ECLAT_DEVICE must not hide the list that helps to correct it. */
    uint32_t chosen = 0;
    ec_error reason = {0};
    if (ec_device_choose(devices, report.count, NULL, &chosen, &report.why, &reason) == EC_OK) {
        report.chosen = chosen;
    } else {
        ec_warn(&call->listener->log, "%s", reason.text);
        report.why = reason.text;
    }
    char unnamed[256];
    if (ec_drivers_unnamed(unnamed, sizeof unnamed)) ec_warn(&call->listener->log, "%s", unnamed);
    ec_result result = EC_OK;
    if (call->json) result = ec_device_report_json(&report, call->listener->to, err);
    else ec_device_report_text(&report, call->listener->to);
    free(devices);
    return result;
}

static const eclat_note notes[] = {
    {"Environment", "ECLAT_DEVICE", "the default device: its number or part of its name"},
    {"Columns", "units", "compute units: cores or multiprocessors that work in parallel"},
    {"Columns", "lanes", "native vector width in floats, which --lanes auto uses"},
    {"Columns", "max alloc", "largest single buffer"},
    {"Columns", "exact div", "division and square root are correctly rounded"},
    {"Columns", "denormals, fma", "single-precision denormals; fused multiply-add in hardware"},
    {"Columns", "sub-groups", "kernels of one lane reserve places in queues once for a sub-group"},
    {0}};

const ec_command ec_cmd_devices = {
    .told = {.name = "devices", .operands = "[options]", .summary = "list the OpenCL devices and mark the default",
             .intro = "Lists every OpenCL device with the properties that matter here; * marks the one that a render uses by default.",
             .notes = notes},
    .rows = list_rows, .run = run,
};
