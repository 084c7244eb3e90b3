/* Prints the study as a table. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cost/report.h"
#include "report/format.h"

enum { CELL = 48, NAME_WIDTH = 27, LINE = 96 };
enum { RELATIVE, VARIANCE, BIAS, TO_FIRST, COLUMNS = TO_FIRST + EC_COST_TARGETS };
static const char *const titles[COLUMNS] = {"time", "variance", "bias", "to 5 %", "2 %", "1 %", "0.5 %"};
static const int widths[COLUMNS] = {7, 9, 13, 10, 10, 10, 10}; /* LINE in all, with the names */

typedef struct table {
    const ec_cost_study *study;
    bool bold;
    uint32_t best[COLUMNS]; /* row, or UINT32_MAX */
    FILE *to;
} table;

static void find_best(table *t)
{
    for (int c = 0; c < COLUMNS; c++)
        t->best[c] = c == BIAS ? UINT32_MAX : ec_cost_best(t->study, c == RELATIVE ? EC_COST_TIME : c == VARIANCE ? EC_COST_VARIANCE : EC_COST_TO_FIRST + (uint32_t)(c - TO_FIRST));
}

/* Prints a text in lines of LINE columns, after a first word. */
static void wrap(FILE *to, const char *first, const char *text)
{
    int at = fprintf(to, "%-10s", first);
    while (*text) {
        const size_t size = strcspn(text, " ");
        if (at > 10 && at + 1 + (int)size > LINE) at = fprintf(to, "\n%10s", "") - 1;
        at += fprintf(to, " %.*s", (int)size, text);
        text += size + (text[size] == ' ');
    }
    fputc('\n', to);
}

/* Formats three digits and a unit. */
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
    if (row->lacks_light || isnan(seconds)) {
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
    else if (row->lacks_light) snprintf(text, size, "lacks %s", ec_percent(sqrt(row->bias2)).text);
    else snprintf(text, size, "< %s", ec_percent(sqrt(fmax(row->bias2, 0) + 2 * row->bias2_se)).text);
}

static void format_cell(const ec_cost_row *row, int column, char *text, size_t size)
{
    text[0] = 0;
    if (column == RELATIVE) snprintf(text, size, "x%.2f", row->relative_time);
    if (row->rung.speed_only) {
        if (column == BIAS) snprintf(text, size, "%s", row->same_bits ? "same bits" : "BITS DIFFER");
        return;
    }
    if (column == VARIANCE) snprintf(text, size, "%.3g", row->variance);
    if (column == BIAS) format_bias(row, text, size);
    if (column >= TO_FIRST) format_target(row, column - TO_FIRST, text, size);
}

static void print_row(const table *t, uint32_t index)
{
    const ec_cost_row *row = &t->study->rows[index];
    fprintf(t->to, "%-*.*s", NAME_WIDTH, NAME_WIDTH - 1, row->rung.name);
    for (int c = 0; c < COLUMNS; c++) {
        char text[CELL], marked[CELL + 8];
        bool best = t->best[c] == index;
        format_cell(row, c, text, sizeof text);
        snprintf(marked, sizeof marked, "%s%s", text, best && !t->bold ? "*" : "");
        fprintf(t->to, "%s%*s%s", best && t->bold ? "\033[1m" : "", widths[c], marked, best && t->bold ? "\033[0m" : "");
    }
    fputs(row->invalid ? "  not finite!\n" : "\n", t->to);
}

/* Prints the rows that were not measured, grouped by reason. */
static void print_left(const ec_cost_study *study, FILE *to)
{
    for (uint32_t i = 0; i < study->row_count; i++) {
        const char *note = study->rows[i].note, *why = *note ? note : "not reached";
        char text[4096] = "", label[160];
        size_t used = 0;
        bool is_told = study->rows[i].state == EC_COST_MEASURED;
        for (uint32_t k = 0; k < i; k++) is_told |= study->rows[k].state != EC_COST_MEASURED && !strcmp(study->rows[k].note, note);
        if (is_told) continue;
        for (uint32_t k = i; k < study->row_count && used + sizeof label < sizeof text; k++) {
            if (study->rows[k].state == EC_COST_MEASURED || strcmp(study->rows[k].note, note)) continue;
            ec_cost_label(&study->rows[k].rung, label, sizeof label);
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", used ? ", " : "", label);
        }
        snprintf(text + used, sizeof text - used, ": %s", why);
        wrap(to, "left out", text);
    }
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
                "variance of one sample, relative to the mean luminance squared\n"
                "bias     floor: the error that no time removes; fades: falls with more samples;\n"
                "         lacks: rare light not met yet, so its figures are too good\n"
                "to 5 %%   time for one picture of %ux%u pixels; ~ extrapolated, ? not known, never: under its floor\n"
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
    char words[EC_COST_WORDS];
    ec_cost_words(t.study, words, sizeof words);
    wrap(to, "result", words);
    ec_cost_denoise_words(t.study, words, sizeof words);
    if (*words) wrap(to, "denoiser", words);
    fprintf(to, "device     %s\n", report->device->name);
    print_reference(report, to);
    fprintf(to, "\n%-*s", NAME_WIDTH, bold ? "best by evidence in bold" : "best by evidence: *");
    for (int c = 0; c < COLUMNS; c++) fprintf(to, "%*s", widths[c], titles[c]);
    for (uint32_t i = 0; i < t.study->row_count; i++) {
        const ec_cost_rung *rung = &t.study->rows[i].rung;
        if (t.study->rows[i].state != EC_COST_MEASURED) continue;
        if (strcmp(group, rung->group)) fprintf(to, "\n%s\n", rung->title);
        group = rung->group;
        print_row(&t, i);
    }
    fputc('\n', to);
    print_left(t.study, to);
    print_footer(t.study, to);
}
