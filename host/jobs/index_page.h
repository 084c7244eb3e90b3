/* A page that shows all pictures of a scenario file with their stated errors, and a contact sheet. */
#ifndef EC_JOBS_INDEX_PAGE_H
#define EC_JOBS_INDEX_PAGE_H

#include "jobs/entries.h"

/* Writes folder/index.html and folder/index.png of all pictures that exist, whichever run made them: folder/NAME.exr, which states the error, and
 * folder/NAME.png. */
ec_result ec_index_write(const char *file, const char *folder, const ec_entries *entries, ec_error *err);

#endif
