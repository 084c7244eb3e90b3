/* tiers: full, long */
/* Digits that the kernels' functions keep, against double precision; precision/precision.h describes the criterion. Lane widths must give
 * equal results: 8 lanes and one, and in the long tier all. */
#include "kernel/kernel_run.h"
#include "robust/precision/internal.h"
#include "robust/precision/precision.h"

static ec_precision_row rows[EC_PRECISION_ROWS], others[EC_PRECISION_ROWS];

static void print_row(const ec_precision_row *row)
{
    printf("%-30s %-20s %-14s %6.1f %6.1f %6.1f %9.2f %4.0f %6.1f %8u\n", row->function, row->result, row->file, row->digits, row->median,
           row->explained, row->times, row->roundings, row->lost, row->hopeless);
}

static void print_worst(const ec_precision_row *row)
{
    fprintf(stderr, "%s, %s: %.9g, double gives %.17g\n   ", row->function, row->result, (double)row->measured, row->expected);
    for (uint32_t k = 0; k < row->words; k++) fprintf(stderr, " %.9g", (double)row->worst[k]);
    fprintf(stderr, "\n");
}

static void every_kernel_has_a_case(void)
{
    for (const ec_precision_reference *r = ec_precision_references; r->name; r++) {
        const ec_precision_case *c = ec_precision_cases;
        while (c->name && strcmp(c->kernel, r->name) != 0) c++;
        CHECK_MSG(c->name, "%s has no inputs", r->name);
    }
}

int main(void)
{
    ec_error err = {0};
    ec_cl cl;
    uint32_t count, other_count;
    int opened = kernel_open(&cl);
    if (opened) return opened;
    char *source = kernel_flatten("robust/precision/precision.cl");
    CHECK(source);
    every_kernel_has_a_case();
    CHECK_OK(ec_precision_run(&cl, source, 1, rows, &count, &err), err);
    if (test_failures) return 1;
    printf("%-30s %-20s %-14s %6s %6s %6s %9s %4s %6s %8s\n", "function", "result", "kernels/lib", "digits", "median", "inputs", "times", "of",
           "lost", "hopeless");
    for (uint32_t i = 0; i < count; i++) {
        print_row(&rows[i]);
        CHECK_MSG(rows[i].pass, "%s, %s: %.1f times what its inputs explain, at most %.0f", rows[i].function, rows[i].result, rows[i].times,
                  rows[i].roundings);
        if (!rows[i].pass || i < 3) print_worst(&rows[i]);
    }
    for (int w = 1; w < (test_tier("long") ? kernel_widths(&cl) : 2); w++) {
        CHECK_OK(ec_precision_run(&cl, source, (uint32_t)lane_widths[w], others, &other_count, &err), err);
        CHECK(other_count == count && !memcmp(others, rows, count * sizeof *rows));
    }
    free(source);
    ec_cl_close(&cl);
    TEST_END();
}
