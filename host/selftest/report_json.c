#include "report/device_report.h"
#include "report/json.h"
#include "selftest/report_print.h"

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
