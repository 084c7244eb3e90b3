/* How many digits do the kernels keep? Each of the library's numerical functions runs on the device, in float, and as the same
 * text compiled as C in double (tools/double_kernels.py), on the same inputs, which are floats; inputs go to where functions break:
 * grazing angles, critical angles, narrow lobes, slivers, far origins, poles.
 *
 * What a float function may lose is known without a list of tolerances. Its result is rounded, u |f|, and its inputs count as
 * rounded, sum |f(x_i + ulp) - f(x_i)| / 2, measured in double: that is lost whatever the code does (its condition; Higham 2002,
 * chapter 1). Every rounding on the way from input to output may cost as much again, not more, unless two numbers cancel that
 * were rounded before. So a function passes if its error is within that sum times the number of roundings on its longest way. */
#ifndef EC_PRECISION_PRECISION_H
#define EC_PRECISION_PRECISION_H

#include "cl/cl.h"
#include "robust/precision/words.h"

/* One result of one function. Digits are -log10 of the relative error; there are 7.2. */
typedef struct ec_precision_row {
    const char *function, *result, *file; /* file: under kernels/lib */
    uint32_t inputs;       /* judged */
    uint32_t hopeless;     /* left out: rounding the inputs alone leaves less than two digits */
    double digits, median; /* that survive in the worst and in the middlemost input */
    double explained;      /* left by rounding the worst input, before any arithmetic */
    double times;          /* largest error over what the rounding of inputs and result explains; INFINITY: it was NaN */
    double roundings;      /* times may be as large as this */
    bool pass;
    double lost;           /* digits lost by the code itself: log10(times), or 0 */
    uint32_t words;
    float worst[EC_PRECISION_WORDS]; /* the input with the largest `times`, */
    double expected;                 /* what double makes of it */
    float measured;
} ec_precision_row;

enum { EC_PRECISION_ROWS = 104 };

/* source: of precision.cl, with its includes; built for `lanes` paths a work-item. rows: room for EC_PRECISION_ROWS; most digits lost first. */
ec_result ec_precision_run(ec_cl *cl, const char *source, uint32_t lanes, ec_precision_row *rows, uint32_t *count, ec_error *err);

#endif
