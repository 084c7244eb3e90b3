#include <stdio.h>
#include <stdlib.h>

#include "base/atomic_file.h"
#include "cost/report.h"

ec_result ec_cost_write(const char *path, ec_cost_put *put, const void *what, ec_error *err)
{
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    if (to) put(to, what);
    bool good = to && !ferror(to);
    if (to) good = fclose(to) == 0 && good;
    ec_result result = good ? ec_atomic_write(path, text, size, err) : ec_fail(err, "out of memory for '%s'", path);
    free(text);
    return result;
}
