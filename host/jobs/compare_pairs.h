/* Finds which pictures are compared with which. */
#ifndef EC_JOBS_COMPARE_PAIRS_H
#define EC_JOBS_COMPARE_PAIRS_H

#include <stdint.h>

#include "base/error.h"

typedef struct ec_compare_pair {
    char *a, *b; /* owned */
} ec_compare_pair;

typedef struct ec_compare_pairs {
    ec_compare_pair *pair; /* owned */
    uint32_t count, alone; /* alone: number of pictures of the first folder without a partner in the second */
} ec_compare_pairs;

/* Pairs each file but the last with the last one, the reference; or the files of two folders that are called alike but for the ending, in the order
 * of names. Must be freed on failure too. */
ec_result ec_compare_pairs_of(char *const *inputs, int count, ec_compare_pairs *pairs, ec_error *err);
void ec_compare_pairs_free(ec_compare_pairs *pairs);

#endif
