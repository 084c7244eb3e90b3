/* Reports of a study: a table for the terminal, JSON, and a page with charts of both. */
#ifndef EC_COST_REPORT_H
#define EC_COST_REPORT_H

#include <cjson/cJSON.h>
#include <stdio.h>

#include "cost/cost.h"

typedef struct ec_cost_report {
    const ec_cost_study *study;
    const char *command, *scene, *camera, *environment; /* as in ec_render_report */
    const ec_device_info *device;
    const char *device_why;
    uint32_t device_index;
} ec_cost_report;

/* Writes a file with `put`, completely or not at all. */
typedef void ec_cost_put(FILE *to, const void *what);
ec_result ec_cost_write(const char *path, ec_cost_put *put, const void *what, ec_error *err);

/* Prints the table. bold: with a terminal's escape codes; otherwise the best of a column has an asterisk. */
void ec_cost_table(const ec_cost_report *report, bool bold, FILE *to);

cJSON *ec_cost_json(const ec_cost_report *report); /* NULL when out of memory */
ec_result ec_cost_write_json(const ec_cost_report *report, const char *path, ec_error *err);

/* Writes a page that contains everything it needs and opens without a network. */
ec_result ec_cost_write_html(const ec_cost_report *report, const char *path, ec_error *err);

#endif
