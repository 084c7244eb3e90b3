/* Writes a page that contains everything it needs. */
#include <stdlib.h>

#include "cost/page.h"
#include "cost/cost_internal.h"
#include "cost/report.h"
#include "report/page.h"

/* Returns the table as on a terminal, malloc'ed; NULL: out of memory. */
static char *table_text(const ec_cost_report *report)
{
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    if (!memory) return NULL;
    ec_cost_table(report, false, memory);
    fclose(memory);
    return text;
}

ec_result ec_cost_write_html(const ec_cost_report *report, const char *path, ec_error *err)
{
    char *text = table_text(report);
    cJSON *data = ec_cost_json(report), *images = NULL;
    ec_result result = ec_cost_pictures(report->study, &images, err);
    if (result == EC_OK)
        result = ec_page_write(path, ec_text_page_html,
                               (const ec_page_part[]){{.name = "STYLE", .text = ec_text_page_css}, {.name = "CHART", .text = ec_text_chart_js},
                                                      {.name = "SCRIPT", .text = ec_text_page_js}, {.name = "TEXT", .prose = text},
                                                      {.name = "DATA", .json = data}, {.name = "IMAGES", .json = images}, {0}}, err);
    cJSON_Delete(data);
    cJSON_Delete(images);
    free(text);
    return result;
}
