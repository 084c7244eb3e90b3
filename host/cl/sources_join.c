/* Several embedded sources as one. */
#include <stdio.h>
#include <stdlib.h>

#include "cl/cl.h"

ec_result ec_kernel_sources_join(const char *const *names, char **joined, ec_error *err)
{
    char *text = NULL;
    size_t size = 0;
    *joined = NULL;
    for (size_t i = 0; names[i]; i++)
        if (!ec_kernel_source(names[i])) return ec_fail(err, "no kernels named %s are built into this program", names[i]);
    FILE *to = open_memstream(&text, &size);
    for (size_t i = 0; to && names[i]; i++) fputs(ec_kernel_source(names[i]), to);
    if (to && fclose(to) == 0) *joined = text;
    else free(text);
    return *joined ? EC_OK : ec_fail(err, "out of memory while joining kernel sources");
}
