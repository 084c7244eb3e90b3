/* A file that appears under its name only when it is whole: written without a name or beside the target, then put in its place. */
#ifndef EC_BASE_ATOMIC_FILE_H
#define EC_BASE_ATOMIC_FILE_H

#include <stddef.h>
#include <sys/types.h>

#include "base/error.h"

typedef struct ec_atomic_file {
    int fd;           /* the temporary file, for reading and writing; -1 once committed or aborted */
    char *target;     /* owned: the final name, symbolic links followed */
    char *temporary;  /* owned: a name in the same folder, so that rename() does not cross file systems; "" = it has none */
    size_t temporary_size;
} ec_atomic_file;

/* Creates the temporary file; fails if the target could not be replaced. After success: commit or abort, once. */
ec_result ec_atomic_open(ec_atomic_file *file, const char *path, ec_error *err);

/* On failure the file is aborted. */
ec_result ec_atomic_append(ec_atomic_file *file, const void *bytes, size_t size, ec_error *err);

/* Flushes to disk and gives it its name. On failure the temporary file is gone and an older target is as it was. */
ec_result ec_atomic_commit(ec_atomic_file *file, ec_error *err);
void ec_atomic_abort(ec_atomic_file *file);

/* Writes all of it from byte `at` on, -1: where the file stands. 0, or the errno value of what failed. */
int ec_write_all(int fd, const void *bytes, size_t size, off_t at);

/* All of it at once. */
ec_result ec_atomic_write(const char *path, const void *bytes, size_t size, ec_error *err);

/* Where a file of this name is, or would come to be: the last of its symbolic links may lead to what is not there yet.
 * malloc'ed; NULL: they lead nowhere, or out of memory. */
char *ec_link_end(const char *path);

/* EC_FAILED with "cannot write 'path': reason; how to mend it" for an errno value. */
ec_result ec_write_failed(ec_error *err, const char *path, int error_number);

#endif
