/* Measures how many digits the kernels keep. Each numerical function of the library runs on the device in float, and the same source is
 * compiled as C in double (tools/double_kernels.py). Both get the same inputs, which are floats, chosen where functions break: grazing
 * angles, critical angles, narrow lobes, slivers, far origins, poles.
 *
 * The error that a float function may have follows without a list of tolerances. Its result is rounded: u |f|. Its inputs count as rounded:
 * sum |f(x_i + ulp) - f(x_i)| / 2, measured in double. No code can avoid that (its condition; Higham 2002, chapter 1). Every rounding on
 * the way from input to output may cost as much again, and no more, unless two numbers cancel that were rounded before. So a function
 * passes if its error is within that sum times the number of roundings on its longest way. */
#ifndef EC_PRECISION_PRECISION_H
#define EC_PRECISION_PRECISION_H

#include "cl/cl.h"
#include "robust/precision/words.h"

/* One result of one function. Digits are -log10 of the relative error; a float has 7.2. */
typedef struct ec_precision_row {
    const char *function, *result, *file; /* file: under kernels/lib */
    uint32_t inputs;       /* number of judged inputs */
    uint32_t hopeless;     /* number of inputs left out: rounding them alone leaves less than two digits */
    double digits, median; /* digits kept for the worst and for the median input */
    double explained;      /* digits left after rounding the worst input, before any arithmetic */
    double times;          /* largest error over the error that rounding of inputs and result explains; INFINITY: a result was NaN */
    double roundings;      /* the limit of `times` */
    bool pass;
    double lost;           /* digits lost by the code itself: log10(times), or 0 */
    uint32_t words;
    float worst[EC_PRECISION_WORDS]; /* the input with the largest `times` */
    double expected;                 /* its result in double */
    float measured;
} ec_precision_row;

enum { EC_PRECISION_ROWS = 104 };

/* source: precision.cl with its includes. lanes: paths a work-item. rows: room for EC_PRECISION_ROWS; the rows with the most lost digits
 * come first. */
ec_result ec_precision_run(ec_cl *cl, const char *source, uint32_t lanes, ec_precision_row *rows, uint32_t *count, ec_error *err);

#endif
