/* Joins several embedded sources into one. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cl/cl.h"

#define HEADERS_MOST 512
#define ONCE "/* once */" /* of tools/embed_kernels.py: a header that its guard leaves out where it is already there */

/* The file that a #line directive names, quotes included; begins: the directive gives line 1. */
typedef struct place {
    const char *name;
    size_t length;
    bool begins, is_once;
} place;

static bool read_place(const char *line, size_t length, place *at)
{
    if (length < 6 || strncmp(line, "#line ", 6)) return false;
    const char *name = memchr(line, '"', length), *end = name ? memchr(name + 1, '"', length - (size_t)(name + 1 - line)) : NULL;
    if (!end) return false;
    *at = (place){name, (size_t)(end + 1 - name), line[6] == '1' && line[7] == ' ', false};
    at->is_once = at->begins && length > strlen(ONCE) && !strncmp(line + length - strlen(ONCE), ONCE, strlen(ONCE));
    return true;
}

static bool is_same(const place *a, const place *b) { return a->length == b->length && !memcmp(a->name, b->name, a->length); }

static bool is_there(const place *headers, size_t count, const place *at)
{
    for (size_t i = 0; i < count; i++)
        if (is_same(&headers[i], at)) return true;
    return false;
}

/* Writes a source without the headers that those before it have brought, headers[0 .. *count): drivers read all of a program anew in
 * every run. */
static void join(const char *source, place headers[HEADERS_MOST], size_t *count, FILE *to)
{
    const size_t before = *count;
    place file = {0}, left_out = {0}, at;
    for (const char *line = source; *line;) {
        const size_t length = strcspn(line, "\n");
        if (read_place(line, length, &at)) {
            if (left_out.name && is_same(&at, &file)) left_out.name = NULL;
            if (!left_out.name && at.is_once && is_there(headers, before, &at)) left_out = at;
            if (!left_out.name) {
                file = at;
                if (at.is_once && *count < HEADERS_MOST) headers[(*count)++] = at;
            }
        }
        const size_t whole = length + (line[length] != 0);
        if (!left_out.name) fwrite(line, 1, whole, to);
        line += whole;
    }
}

ec_result ec_kernel_sources_join(const char *const *names, char **joined, ec_error *err)
{
    char *text = NULL;
    size_t size = 0, count = 0;
    place headers[HEADERS_MOST];
    *joined = NULL;
    for (size_t i = 0; names[i]; i++)
        if (!ec_kernel_source(names[i])) return ec_fail(err, "no kernels named %s are built into this program", names[i]);
    FILE *to = open_memstream(&text, &size);
    for (size_t i = 0; to && names[i]; i++) join(ec_kernel_source(names[i]), headers, &count, to);
    if (to && fclose(to) == 0) *joined = text;
    else free(text);
    return *joined ? EC_OK : ec_fail(err, "out of memory while joining kernel sources");
}
