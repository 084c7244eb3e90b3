/* tiers: quick, long */
/* A picture has the same bits on two devices if these operations are correctly rounded on both. Expected values are the host's, which
 * rounds by IEEE 754. Sum, product and fma must be right on every device of OpenCL 1.2. Quotient and root must be right if the device
 * claims it; otherwise within the 2.5 and 3 ulp of the specification (7.4), and the test prints how often they differ. Denormal numbers are
 * up to the device: operands from 2^-40 to 2^40 avoid them. */
#include "kernel/kernel_run.h"

enum { COUNT = 1 << 16, OPERATIONS = 11 };

static const struct {
    const char *name;
    double ulps; /* permitted error without correct rounding */
} operations[OPERATIONS] = {{"x + y", 0},        {"x * y", 0},     {"x / y", 2.5},         {"sqrt(x)", 3},
                            {"fma(x, y, z)", 0}, {"x * y + z", 0}, {"1 / sqrt(x)", 6},      {"floor(x)", 0},
                            {"x + y - y", 0},    {"x * y + x * z", 0}, {"1 / (1 / x)", 5}};

static float a[COUNT], b[COUNT], c[COUNT], expected[OPERATIONS][COUNT], out[OPERATIONS][COUNT];

static float random_signed(void)
{
    float size = (float)ldexp(1 + test_random(), (int)test_random_in(-40, 40));
    return test_random() < 0.5 ? -size : size;
}

/* volatile: the host's compiler must not fold or fuse these. */
static void expect(void)
{
    for (int i = 0; i < COUNT; i++) {
        a[i] = random_signed();
        b[i] = random_signed();
        c[i] = i % 2 ? random_signed() : -a[i] * b[i]; /* every second one cancels: only the product's rounding error is left */
        volatile float product = a[i] * b[i], root = sqrtf(fabsf(a[i])), sum = a[i] + b[i],
                       other = a[i] * c[i], inverse = 1.0f / a[i];
        const float values[OPERATIONS] = {a[i] + b[i],          a[i] * b[i],    a[i] / b[i], root,
                                          fmaf(a[i], b[i], c[i]), product + c[i], 1.0f / root, floorf(a[i]),
                                          sum - b[i], product + other, 1.0f / inverse};
        for (int k = 0; k < OPERATIONS; k++) expected[k][i] = values[k];
    }
}

static void check(int k, int lanes, bool exact)
{
    int wrong = 0, worst = 0;
    double most = 0;
    for (int i = 0; i < COUNT; i++) {
        if (!memcmp(&out[k][i], &expected[k][i], 4)) continue;
        double ulp = ldexp(1, ilogbf(expected[k][i]) - 23), off = fabs(((double)out[k][i] - (double)expected[k][i]) / ulp);
        wrong++;
        if (!(off <= most)) {
            most = off;
            worst = i;
        }
    }
    if (wrong) printf("LANES %d: %s is off for %d of %d, by up to %.3g ulp\n", lanes, operations[k].name, wrong, COUNT, most);
    CHECK_MSG(exact ? wrong == 0 : most <= operations[k].ulps, "LANES %d: %s of %a, %a, %a is %a, not %a", lanes, operations[k].name,
              (double)a[worst], (double)b[worst], (double)c[worst], (double)out[k][worst], (double)expected[k][worst]);
}

int main(void)
{
    ec_cl cl;
    int open = kernel_open(&cl);
    if (open) return open;
    expect();
    for (int w = 0; w < kernel_widths(&cl); w++) {
        cl_program program = kernel_build(&cl, "rounding", lane_widths[w], NULL);
        memset(out, 0xff, sizeof out);
        if (program && KERNEL_CALL(&cl, program, "rounding", COUNT / lane_widths[w], IN(a, COUNT), IN(b, COUNT), IN(c, COUNT),
                                   OUT(out[0], COUNT), OUT(out[1], COUNT), OUT(out[2], COUNT), OUT(out[3], COUNT), OUT(out[4], COUNT),
                                   OUT(out[5], COUNT), OUT(out[6], COUNT), OUT(out[7], COUNT), OUT(out[8], COUNT), OUT(out[9], COUNT), OUT(out[10], COUNT)))
            for (int k = 0; k < OPERATIONS; k++)
                check(k, lane_widths[w], operations[k].ulps == 0 || cl.info.correctly_rounded_divide_sqrt);
        if (program) clReleaseProgram(program);
    }
    ec_cl_close(&cl);
    TEST_END();
}
