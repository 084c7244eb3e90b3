/* Prints the report of a self-test as a table or as JSON. */
#ifndef EC_SELFTEST_REPORT_PRINT_H
#define EC_SELFTEST_REPORT_PRINT_H

#include <stdio.h>

#include "cl/cl.h"
#include "selftest/selftest.h"

/* Prints failed rows with their reasons first. failed_only: prints no others, and no last line. */
void ec_selftest_report_text(const ec_selftest_report *report, bool failed_only, FILE *to);
ec_result ec_selftest_report_json(const ec_selftest_report *report, const ec_device_info *device, uint32_t device_index, FILE *to,
                                  ec_error *err);

#endif
