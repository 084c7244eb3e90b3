#include "cl/file_mark.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/fingerprint.h"
#include "base/read_file.h"

void ec_bytes_mark(const void *bytes, size_t size, char mark[EC_FILE_MARK])
{
    const ec_fingerprint sum = ec_fingerprint_add((ec_fingerprint){{0}}, bytes, size);
    snprintf(mark, EC_FILE_MARK, "%016" PRIx64 "%016" PRIx64, sum.half[0], sum.half[1]);
}

bool ec_file_mark(const char *path, char mark[EC_FILE_MARK])
{
    uint8_t *bytes;
    size_t size;
    const bool is_read = ec_read_file(path, &bytes, &size, NULL) == EC_OK;
    if (is_read) ec_bytes_mark(bytes, size, mark);
    free(bytes);
    return is_read;
}
