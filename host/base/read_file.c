#include "base/read_file.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ec_result ec_read_file(const char *path, uint8_t **bytes, size_t *size, ec_error *err)
{
    *bytes = NULL;
    FILE *file = fopen(path, "rbe");
    if (!file) return ec_fail(err, "cannot open '%s': %s", path, strerror(errno));
    bool good = fseek(file, 0, SEEK_END) == 0 && ftell(file) >= 0;
    *size = good ? (size_t)ftell(file) : 0;
    rewind(file);
    *bytes = malloc(*size + 1);
    good = good && *bytes && fread(*bytes, 1, *size, file) == *size;
    fclose(file);
    return good ? EC_OK : ec_fail(err, "cannot read '%s': %s", path, *bytes ? "it cannot be read to its end" : "out of memory");
}
