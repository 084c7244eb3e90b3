/* Measures the machine's memory, how much of it this process has, and how much more it may take. */
#ifndef EC_BASE_MEMORY_H
#define EC_BASE_MEMORY_H

#include <stdint.h>

uint64_t ec_memory_of_machine(void); /* bytes, free or used */
uint64_t ec_memory_resident(void); /* bytes that belong to the process and are in memory; 0: unknown */

/* Returns the bytes that the process may take in addition before the machine runs short, its control group (v2 or v1) kills it, or its address space
 * (ulimit -v) is full. The page cache counts as free. UINT64_MAX: unknown. */
uint64_t ec_memory_free(void);

/* Allocates memory that a device which is a processor can use in place. Free with free(). NULL: out of memory. */
#define EC_SHARED_ALIGNMENT 128
void *ec_shared_alloc(uint64_t bytes);

#endif
