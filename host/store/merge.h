/* Merges slices of one job: in any order, to the same bits as one render. */
#ifndef EC_STORE_MERGE_H
#define EC_STORE_MERGE_H

#include "store/store.h"

/* Which file has which batches, for messages about batches that two files have. */
typedef struct ec_merge_range {
    const char *path;
    uint32_t first, count;
} ec_merge_range;

typedef struct ec_merge {
    ec_stored all;          /* the first file's job, and all films */
    const char *first_path;
    ec_merge_range *ranges; /* owned */
    uint32_t range_count;
} ec_merge;

/* Sorts files by their first batches, the order in which fewest sums wait for others: those of a whole job never take more than ec_film_bytes says,
 * beside the file that is read. Any other order gives the same bits. Fails if there is no memory. */
ec_result ec_merge_sort(char **paths, int count, ec_error *err);

/* Adds a file's film. Refuses one of another job, of batches that are there already, and adaptive ones beside others. path must last. */
ec_result ec_merge_take(ec_merge *merge, const char *path, const ec_log *log, ec_error *err);

/* Lists the samples between 0 and the end of the job, as far as that is known, that no file has: "0:64, 128:192", or, where they are too many for the
 * text, "0:64, 128:192 and 3 more ranges". Returns false if none are missing. */
bool ec_merge_missing(const ec_merge *merge, char *text, size_t size);

void ec_merge_free(ec_merge *merge); /* zero-initialised is fine */

#endif
