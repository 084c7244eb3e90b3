/* How much memory there is, how much of it this process has, and how much more it may take. */
#ifndef EC_BASE_MEMORY_H
#define EC_BASE_MEMORY_H

#include <stdint.h>

uint64_t ec_memory_of_machine(void); /* bytes, free or not */
uint64_t ec_memory_resident(void); /* bytes that are the process's own and in memory now; 0: not known */

/* Bytes that it may take beside them before the machine runs short, its control group (v2 or v1) ends it, or its address space (ulimit -v)
 * is full. What the page cache holds counts as free. UINT64_MAX: not known. */
uint64_t ec_memory_free(void);

/* Memory that a device may work on where it is, if it is a processor. free() frees it. NULL: there is none. */
#define EC_SHARED_ALIGNMENT 128
void *ec_shared_alloc(uint64_t bytes);

#endif
