#include <string.h>

#include "report/format.h"
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
