/* What the parts of the precision check share. */
#ifndef EC_PRECISION_INTERNAL_H
#define EC_PRECISION_INTERNAL_H

#include <stdint.h>

#include "shared/params.h"
#include "robust/precision/words.h"

/* A kernel in double: one input, one row of results. */
typedef struct ec_precision_reference {
    const char *name;
    void (*run)(const float *in, double *out, const float *memory, const ec_params *params);
} ec_precision_reference;
extern const ec_precision_reference ec_precision_references[]; /* ends with a name that is NULL */

/* How a result is measured. EACH: every word against itself. VECTOR: its words against the largest of them. SCALED: as VECTOR,
 * and against the word after them, which is what makes the size of the result (a share's whole, a picture's width). STATED: as
 * EACH, and the word after them, times u, is what one rounding inside may cost by design. */
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
    uint32_t words;   /* of x */
    uint64_t exact;   /* bit k: word k is no measured number (bits, a choice): it is not rounded */
    uint64_t turns;   /* bit k: word k is an angle from the sampler, a multiple of 2^-24: that is its ulp */
    double roundings; /* on the longest way from an input to a result */
    ec_precision_result results[EC_PRECISION_MOST_RESULTS]; /* a name that is NULL ends them */
} ec_precision_case;
extern const ec_precision_case ec_precision_cases[]; /* ends with a name that is NULL */

/* The tables in memory, and the params. */
void ec_precision_fill(float *memory, ec_params *params);

/* Compares one function's results, `count` inputs; rows has one for each result. */
typedef struct ec_precision_data {
    const float *in, *out, *memory;
    const ec_params *params;
    uint32_t count;
} ec_precision_data;
struct ec_precision_row;
void ec_precision_compare(const ec_precision_case *c, const ec_precision_reference *reference, const ec_precision_data *data,
                          struct ec_precision_row *rows);

#endif
