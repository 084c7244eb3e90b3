#include <unistd.h>

#include "cost/report.h"
#include "image/atomic_file.h"

/* A second descriptor: fclose() must not close the one that is still to be synced and renamed. */
ec_result ec_cost_write(const char *path, ec_cost_put *put, const void *what, ec_error *err)
{
    ec_atomic_file file;
    EC_TRY(ec_atomic_open(&file, path, err));
    int copy = dup(file.fd);
    FILE *to = copy >= 0 ? fdopen(copy, "w") : NULL;
    if (!to && copy >= 0) close(copy);
    if (to) put(to, what);
    bool good = to && !ferror(to);
    if (to) good = fclose(to) == 0 && good;
    if (good) return ec_atomic_commit(&file, err);
    ec_atomic_abort(&file);
    return ec_fail(err, "cannot write '%s': is the disk full?", path);
}
