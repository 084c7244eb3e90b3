/* Every numerical function of kernels/lib against the same text in double: a row each, of how many times the error is as large as what
 * rounding the inputs and the result explains. As many as there are roundings on the way may be. */
#include <stdio.h>

#include "selftest/cases.h"
#include "selftest/precision.h"

ec_result ec_selftest_precision(ec_selftest *t, ec_error *err)
{
    ec_precision_row rows[EC_PRECISION_ROWS];
    uint32_t count = 0;
    EC_TRY(ec_precision_run(t->cl, t->lanes, rows, &count, err));
    for (uint32_t i = 0; i < count; i++) {
        const ec_precision_row *r = &rows[i];
        char what[64], note[96];
        snprintf(what, sizeof what, "%s: %s", r->function, r->result);
        snprintf(note, sizeof note, "%s; rounding the input leaves %.1f digits", r->file, r->explained);
        EC_TRY(ec_selftest_digits(t, what, r->times, r->roundings, r->digits, note, err));
    }
    return EC_OK;
}
