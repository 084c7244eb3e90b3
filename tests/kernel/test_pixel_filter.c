/* tiers: quick, long */
/* Positions that the pixel filter's table gives for uniform numbers, against the density of the Blackman-Harris window by chi-square. */
#include "kernel/chi2.h"
#include "device/pixel_filter.h"

#define CELLS 64

/* Integral of 0.35875 - 0.48829 cos + 0.14128 cos 2 - 0.01168 cos 3 from 0 to x, relative to the whole. */
static double window(double x)
{
    return x - 0.48829 / 0.35875 * sin(2 * pi * x) / (2 * pi) + 0.14128 / 0.35875 * sin(4 * pi * x) / (4 * pi) - 0.01168 / 0.35875 * sin(6 * pi * x) / (6 * pi);
}

static void check_width(int lanes, double width)
{
    char name[64];
    float table[EC_FILTER_ENTRIES];
    cl_program program = kernel_build(&cl, "pixel_filter", lane_widths[lanes], NULL);
    ec_pixel_filter_blackman_harris(width, table);
    if (program && KERNEL_CALL(&cl, program, "places", samples / (uint32_t)lane_widths[lanes], IN(table, EC_FILTER_ENTRIES), SCALAR(seed), OUT(out, SAMPLES))) {
        uint32_t count[CELLS] = {0}, outside = 0;
        double expected[CELLS];
        for (int i = 0; i < CELLS; i++) expected[i] = SAMPLES * (window((i + 1.0) / CELLS) - window((double)i / CELLS));
        for (uint32_t i = 0; i < SAMPLES; i++) {
            double x = 0.5 + 0.5 * ((double)out[i] - 0.5) / width;
            outside += !(x >= 0 && x <= 1);
            count[(uint32_t)fmin(fmax(x, 0) * CELLS, CELLS - 1)]++;
        }
        CHECK_MSG(!outside, "%u samples outside of a filter of width %g", outside, width);
        snprintf(name, sizeof name, "filter of width %g", width);
        check_chi2(name, expected, count, CELLS);
    }
    if (program) clReleaseProgram(program);
}

int main(void)
{
    int open = kernel_open(&cl);
    if (open) return open;
    int widths = kernel_widths(&cl);
    for (int i = 0; i < widths; i++) check_width(i, i + 0.5);
    ec_cl_close(&cl);
    TEST_END();
}
