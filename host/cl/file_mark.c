#include "cl/file_mark.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/fingerprint.h"

enum { BLOCK = 1 << 20 };

void ec_bytes_mark(const void *bytes, size_t size, char mark[EC_FILE_MARK])
{
    const ec_fingerprint sum = ec_fingerprint_add((ec_fingerprint){{0}}, bytes, size);
    snprintf(mark, EC_FILE_MARK, "%016" PRIx64 "%016" PRIx64, sum.half[0], sum.half[1]);
}

char *ec_file_bytes(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rbe");
    char *bytes = NULL, *grown;
    size_t got;
    *size = 0;
    if (!file) return NULL;
    do {
        grown = realloc(bytes, *size + BLOCK);
        if (!grown) break;
        bytes = grown;
        *size += got = fread(bytes + *size, 1, BLOCK, file);
    } while (got == BLOCK);
    const bool is_read = grown && !ferror(file);
    fclose(file);
    if (is_read) return bytes;
    free(bytes);
    return NULL;
}

bool ec_file_mark(const char *path, char mark[EC_FILE_MARK])
{
    size_t size;
    char *bytes = ec_file_bytes(path, &size);
    if (bytes) ec_bytes_mark(bytes, size, mark);
    free(bytes);
    return bytes != NULL;
}
