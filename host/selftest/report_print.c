#include <string.h>

#include "report/device_report.h"
#include "report/format.h"
#include "report/json.h"
#include "selftest/report_print.h"

static void print_row(const ec_selftest_row *row, int width, FILE *to)
{
    fprintf(to, "%-6s  %-*s  %12.8g  %12.8g  %9.2g  %6.1f", row->pass ? "ok" : "FAILED", width, row->name,
            row->expected, row->measured, row->tolerance, row->digits);
    if (*row->note) fprintf(to, "  %s", row->note);
    fputc('\n', to);
    if (!row->pass) fprintf(to, "        what this breaks: %s\n", row->breaks);
}

void ec_selftest_report_text(const ec_selftest_report *report, bool failed_only, FILE *to)
{
    int width = 4;
    for (uint32_t i = 0; i < report->count; i++)
        if ((int)strlen(report->rows[i].name) > width) width = (int)strlen(report->rows[i].name);
    if (!failed_only || report->failed)
        fprintf(to, "%-6s  %-*s  %12s  %12s  %9s  %6s\n", "", width, "case", "expected", "measured", "tolerance", "digits");
    for (uint32_t i = 0; i < report->count; i++)
        if (!failed_only || !report->rows[i].pass) print_row(&report->rows[i], width, to);
    if (failed_only) return;
    if (report->failed)
        fprintf(to, "%u of %u rows FAILED in %s: do not trust pictures from this device and driver before you know why\n", report->failed,
                report->count, ec_seconds(report->seconds).text);
    else
        fprintf(to, "all %u rows passed in %s; the fewest digits are %.1f, of %s\n", report->count, ec_seconds(report->seconds).text,
                report->rows[0].digits,
                report->rows[0].name);
}

static cJSON *row_json(const ec_selftest_row *row)
{
    cJSON *object = cJSON_CreateObject();
    ec_json_text(object, "name", row->name);
    cJSON_AddBoolToObject(object, "pass", row->pass);
    ec_json_real(object, "expected", row->expected);
    ec_json_real(object, "measured", row->measured);
    ec_json_real(object, "tolerance", row->tolerance);
    ec_json_real(object, "noise", row->noise);
    ec_json_real(object, "digits", row->digits);
    ec_json_text(object, "note", row->note);
    ec_json_text(object, "breaks", row->breaks);
    ec_json_real(object, "seconds", row->seconds);
    return object;
}

ec_result ec_selftest_report_json(const ec_selftest_report *report, const ec_device_info *device, uint32_t device_index, FILE *to,
                                  ec_error *err)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddBoolToObject(root, "pass", report->failed == 0);
    ec_json_whole(root, "failed", report->failed);
    ec_json_whole(root, "lanes", report->lanes);
    ec_json_real(root, "seconds", report->seconds);
    cJSON_AddItemToObject(root, "device", ec_device_json(device, device_index));
    cJSON *cases = cJSON_AddArrayToObject(root, "cases");
    for (uint32_t i = 0; i < report->count; i++) cJSON_AddItemToArray(cases, row_json(&report->rows[i]));
    return ec_json_print(root, to, err);
}
