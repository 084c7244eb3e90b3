/* Marks of files in the driver's cache, in hexadecimal: they find damage, not attacks. Inside host/cl only. */
#ifndef EC_CL_FILE_MARK_H
#define EC_CL_FILE_MARK_H

#include <stdbool.h>
#include <stddef.h>

#define EC_FILE_MARK 33

void ec_bytes_mark(const void *bytes, size_t size, char mark[EC_FILE_MARK]);

/* Writes a file's mark; returns false if it cannot be read. */
bool ec_file_mark(const char *path, char mark[EC_FILE_MARK]);

#endif
