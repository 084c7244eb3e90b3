/* The study in one table. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cost/report.h"
#include "report/format.h"

enum { CELL = 48, NAME_WIDTH = 33 };
enum { TIME, RELATIVE, SLOPE, VARIANCE, BIAS, EFFICIENCY, TO_FIRST, MEMORY = TO_FIRST + EC_COST_TARGETS, COLUMNS };
static const char *const titles[COLUMNS] = {"ns/sample", "time", "slope", "variance", "bias",  "efficiency",
                                            "to 5 %",    "2 %",  "1 %",   "0.5 %",    "memory"};
static const int widths[COLUMNS] = {10, 8, 7, 9, 15, 11, 10, 10, 10, 10, 10};

typedef struct table {
    const ec_cost_study *study;
    bool bold;
    uint32_t best[COLUMNS]; /* row, or UINT32_MAX */
    FILE *to;
} table;

/* The value by which a row is the best of a column: the smallest wins, NaN never does. Rungs that do not converge to the picture do not compete. */
static double merit(const ec_cost_row *row, int column)
{
    bool ranked = row->state == EC_COST_MEASURED && !row->rung.is_effect && !row->unmet;
    if (!ranked || (!row->rung.unbiased && !row->rung.fades && column != MEMORY) ||
        (row->rung.speed_only && column != TIME && column != RELATIVE))
        return NAN;
    if (row->rung.fades && column < TO_FIRST) return NAN;
    if (column == TIME || column == RELATIVE) return row->seconds_per_sample;
    if (column == VARIANCE) return row->variance;
    if (column == EFFICIENCY) return -row->efficiency;
    if (column == MEMORY) return (double)row->device_bytes;
    if (column >= TO_FIRST && column < MEMORY)
        return isinf(row->seconds_to[column - TO_FIRST]) ? NAN : row->seconds_to[column - TO_FIRST];
    return NAN;
}

static void find_best(table *t)
{
    for (int c = 0; c < COLUMNS; c++) {
        double best = NAN;
        t->best[c] = UINT32_MAX;
        for (uint32_t i = 0; i < t->study->row_count; i++) {
            double m = merit(&t->study->rows[i], c);
            if (isfinite(m) && !(m >= best)) best = m, t->best[c] = i;
        }
    }
}

/* Three digits and a unit. */
static void format_time(double seconds, char *text, size_t size)
{
    static const struct {
        double seconds;
        const char *name;
    } units[] = {{86400, "d"}, {3600, "h"}, {60, "min"}, {1, "s"}, {1e-3, "ms"}};
    int i = 0;
    while (i < 4 && seconds < (units[i].seconds == 60 ? 99.5 : units[i].seconds)) i++;
    double value = seconds / units[i].seconds;
    snprintf(text, size, "%.*f %s", value < 9.995 ? 2 : value < 99.95 ? 1 : 0, value, units[i].name);
}

static void format_target(const ec_cost_row *row, int i, char *text, size_t size)
{
    double seconds = row->seconds_to[i];
    char number[16];
    if (row->unmet || isnan(seconds)) {
        snprintf(text, size, "?");
    } else if (isinf(seconds)) {
        snprintf(text, size, "never");
    } else {
        format_time(seconds, number, sizeof number);
        snprintf(text, size, "%s%s", row->extrapolated[i] ? "~" : "", number);
    }
}

static void format_bias(const ec_cost_row *row, char *text, size_t size)
{
    if (row->rung.fades) snprintf(text, size, "fades");
    else if (isnan(row->bias2)) snprintf(text, size, "?");
    else if (row->biased) snprintf(text, size, "floor %s", ec_percent(sqrt(row->bias2)).text);
    else if (row->unmet) snprintf(text, size, "lacks %s", ec_percent(sqrt(row->bias2)).text);
    else snprintf(text, size, "< %s", ec_percent(sqrt(fmax(row->bias2, 0) + 2 * row->bias2_se)).text);
}

static void format_cell(const ec_cost_row *row, int column, char *text, size_t size)
{
    text[0] = 0;
    if (column == TIME) snprintf(text, size, "%.4g", 1e9 * row->seconds_per_sample);
    if (column == RELATIVE) snprintf(text, size, "x%.2f", row->relative_time);
    if (column == MEMORY) snprintf(text, size, "%s", ec_bytes(row->device_bytes).text);
    if (row->rung.speed_only) {
        if (column == BIAS) snprintf(text, size, "%s", row->same_bits ? "same bits" : "BITS DIFFER");
        return;
    }
    if (column == SLOPE) snprintf(text, size, isnan(row->fit.slope) ? "?" : "%.2f", row->fit.slope);
    if (column == VARIANCE) snprintf(text, size, "%.3g", row->variance);
    if (column == BIAS) format_bias(row, text, size);
    if (column == EFFICIENCY && isnan(row->efficiency)) snprintf(text, size, "?");
    if (column == EFFICIENCY && !isnan(row->efficiency)) snprintf(text, size, "%s", ec_count(row->efficiency).text);
    if (column >= TO_FIRST && column < MEMORY) format_target(row, column - TO_FIRST, text, size);
}

static void print_row(const table *t, uint32_t index)
{
    const ec_cost_row *row = &t->study->rows[index];
    fprintf(t->to, "%-*.*s", NAME_WIDTH, NAME_WIDTH - 1, row->rung.name);
    if (row->state != EC_COST_MEASURED) {
        fprintf(t->to, " %s\n", *row->note ? row->note : "not reached");
        return;
    }
    for (int c = 0; c < COLUMNS; c++) {
        char text[CELL], marked[CELL + 8];
        bool best = t->best[c] == index;
        format_cell(row, c, text, sizeof text);
        snprintf(marked, sizeof marked, "%s%s", text, best && !t->bold ? "*" : "");
        fprintf(t->to, "%s%*s%s", best && t->bold ? "\033[1m" : "", widths[c], marked, best && t->bold ? "\033[0m" : "");
    }
    fputs(row->invalid ? "  not finite!\n" : "\n", t->to);
}

static void print_reference(const ec_cost_report *report, FILE *to)
{
    const ec_cost_reference *r = &report->study->reference;
    if (!(r->mean_luminance > 0))
        fprintf(to, "reference  none: interrupted before\n");
    else if (!r->source)
        fprintf(to, "reference  error %s, %llu samples a pixel in %s, seeds of its own\n", ec_percent(sqrt(r->noise)).text,
                (unsigned long long)r->samples_per_pixel, ec_seconds(r->seconds).text);
    else
        fprintf(to, "reference  %s, %s%s\n", r->source, r->has_variance ? "error " : "taken as exact: it states no error",
                r->has_variance ? ec_percent(sqrt(r->noise)).text : "");
}

static void print_footer(const ec_cost_study *study, FILE *to)
{
    fprintf(to, "\ntime     as a multiple of the first row's, measured in turns with it\n"
                "slope    of error over samples in the log-log chart; independent samples: -0.50\n"
                "bias     floor: the error that no time removes; fades: falls with more samples; lacks: rare light not met yet, so its figures are too good\n"
                "to 5 %%   seconds for one picture of %ux%u pixels; ~ extrapolated, ? not known, never: under its floor\n"
                "%s%s of %s%s\n",
            study->options.width, study->options.height, study->interrupted ? "interrupted after " : "took     ", ec_seconds(study->seconds).text,
            ec_seconds(study->budget).text,
            study->interrupted ? "" : " budget");
}

void ec_cost_table(const ec_cost_report *report, bool bold, FILE *to)
{
    table t = {.study = report->study, .bold = bold, .to = to};
    const char *group = "";
    find_best(&t);
    fprintf(to, "device     %s\n", report->device->name);
    print_reference(report, to);
    fprintf(to, "\n%-*s", NAME_WIDTH, bold ? "best in bold" : "best: *");
    for (int c = 0; c < COLUMNS; c++) fprintf(to, "%*s", widths[c], titles[c]);
    for (uint32_t i = 0; i < t.study->row_count; i++) {
        const ec_cost_rung *rung = &t.study->rows[i].rung;
        if (strcmp(group, rung->group)) fprintf(to, "\n%s\n", rung->title);
        group = rung->group;
        print_row(&t, i);
    }
    char words[256];
    ec_cost_denoise_words(t.study, words, sizeof words);
    if (*words) fprintf(to, "\ndenoiser %s\n", words);
    print_footer(t.study, to);
}
