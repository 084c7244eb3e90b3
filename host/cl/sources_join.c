/* Several embedded sources as one. */
#include <stdlib.h>
#include <string.h>

#include "cl/cl.h"

ec_result ec_kernel_sources_join(const char *const *names, char **joined, ec_error *err)
{
    *joined = NULL;
    size_t size = 1;
    for (size_t i = 0; names[i]; i++) {
        const char *source = ec_kernel_source(names[i]);
        if (!source) return ec_fail(err, "no kernels named %s are built into this program", names[i]);
        size += strlen(source);
    }
    char *text = malloc(size), *end = text;
    if (!text) return ec_fail(err, "out of memory while joining kernel sources");
    *text = 0;
    for (size_t i = 0; names[i]; i++) {
        size_t length = strlen(ec_kernel_source(names[i]));
        memcpy(end, ec_kernel_source(names[i]), length + 1);
        end += length;
    }
    *joined = text;
    return EC_OK;
}
