/* Shared by the parts of the precision check. */
#ifndef EC_PRECISION_INTERNAL_H
#define EC_PRECISION_INTERNAL_H

#include <stdint.h>

#include "shared/params.h"
#include "robust/precision/words.h"

/* A kernel compiled in double: one input, one row of results. */
typedef struct ec_precision_reference {
    const char *name;
    void (*run)(const float *in, double *out, const float *memory, const ec_params *params);
} ec_precision_reference;
extern const ec_precision_reference ec_precision_references[]; /* ends with a NULL name */

/* How a result is measured. EACH: every word relative to itself. VECTOR: its words relative to the largest of them. SCALED: as VECTOR, and
 * relative to the word after them, which gives the size of the result (the whole that it is a share of, the width of a picture). STATED: as
 * EACH; the word after them, times u, is the error that one rounding inside may cause by design. */
typedef enum ec_precision_kind {
    EC_PRECISION_EACH,
    EC_PRECISION_VECTOR,
    EC_PRECISION_SCALED,
    EC_PRECISION_STATED
} ec_precision_kind;
typedef struct ec_precision_result {
    const char *name;
    uint32_t first, words;
    ec_precision_kind kind;
} ec_precision_result;
enum { EC_PRECISION_MOST_RESULTS = 6 };

typedef struct ec_precision_case {
    const char *name, *kernel, *file;
    void (*inputs)(uint64_t *random, float *x);
    uint32_t words;   /* words of x in use */
    uint64_t exact;   /* bit k: word k is not a measured number (bits, a choice), and has no rounding error */
    uint64_t turns;   /* bit k: word k is an angle from the sampler: a multiple of 2^-24, which counts as its ulp */
    double roundings; /* on the longest way from an input to a result */
    ec_precision_result results[EC_PRECISION_MOST_RESULTS]; /* ends with a NULL name */
} ec_precision_case;
extern const ec_precision_case ec_precision_cases[]; /* ends with a NULL name */

/* Fills the tables in memory, and the params. */
void ec_precision_fill(float *memory, ec_params *params);

/* Compares the results of one function for `count` inputs; rows has one row for each result. */
typedef struct ec_precision_data {
    const float *in, *out, *memory;
    const ec_params *params;
    uint32_t count;
} ec_precision_data;
struct ec_precision_row;
void ec_precision_compare(const ec_precision_case *c, const ec_precision_reference *reference, const ec_precision_data *data,
                          struct ec_precision_row *rows);

#endif
