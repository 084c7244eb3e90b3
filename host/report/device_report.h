/* OpenCL devices in a table and in JSON. */
#ifndef EC_REPORT_DEVICE_REPORT_H
#define EC_REPORT_DEVICE_REPORT_H

#include <cjson/cJSON.h>
#include <stdint.h>
#include <stdio.h>

#include "cl/cl.h"

typedef struct ec_device_report {
    const ec_device_info *devices;
    uint32_t count;
    int64_t chosen;   /* index of the default; -1: none */
    const char *why;  /* why this one was chosen, or why none */
} ec_device_report;

void ec_device_report_text(const ec_device_report *report, FILE *to);
ec_result ec_device_report_json(const ec_device_report *report, FILE *to, ec_error *err);

cJSON *ec_device_json(const ec_device_info *device, uint32_t index); /* NULL when out of memory */

#endif
