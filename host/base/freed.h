/* Memory that is freed when its variable goes out of scope, however a function is left. */
#ifndef EC_BASE_FREED_H
#define EC_BASE_FREED_H

#include <stdlib.h>
#include <string.h>

static inline void ec_free_at(void *pointer)
{
    void *memory; /* `pointer` is the address of a pointer of some type */
    memcpy(&memory, pointer, sizeof memory);
    free(memory);
}

/* Put before the declaration of a pointer, which must be initialised: EC_FREED float *rows = malloc(size); */
#define EC_FREED __attribute__((cleanup(ec_free_at)))

#endif
