/* A file that appears under its name only once it is complete: it is written without a name or beside the target, then put in its place. */
#ifndef EC_BASE_ATOMIC_FILE_H
#define EC_BASE_ATOMIC_FILE_H

#include <stddef.h>
#include <sys/types.h>

#include "base/error.h"

typedef struct ec_atomic_file {
    int fd;           /* the temporary file, for reading and writing; -1 once committed or aborted */
    char *target;     /* owned: the final name, symbolic links followed */
    char *temporary;  /* owned: a name in the same folder, so that rename() stays within one file system; "": none */
    size_t temporary_size;
} ec_atomic_file;

/* Creates the temporary file; fails if the target could not be replaced. After success, call commit or abort, once. */
ec_result ec_atomic_open(ec_atomic_file *file, const char *path, ec_error *err);

/* On failure the file is aborted. */
ec_result ec_atomic_append(ec_atomic_file *file, const void *bytes, size_t size, ec_error *err);

/* Flushes the file to disk and gives it its name. On failure the temporary file is removed, and an older target is unchanged. */
ec_result ec_atomic_commit(ec_atomic_file *file, ec_error *err);
void ec_atomic_abort(ec_atomic_file *file);

/* Writes all bytes from offset `at` on; -1: at the file's current position. Returns 0 or an errno value. */
int ec_write_all(int fd, const void *bytes, size_t size, off_t at);

/* Writes a whole file at once. */
ec_result ec_atomic_write(const char *path, const void *bytes, size_t size, ec_error *err);

/* Returns the path behind all symbolic links, which need not exist yet. malloc'ed; NULL: the links lead nowhere, or out of memory. */
char *ec_link_end(const char *path);

/* Returns EC_FAILED with "cannot write 'path': reason; how to mend it" for an errno value. */
ec_result ec_write_failed(ec_error *err, const char *path, int error_number);

#endif
