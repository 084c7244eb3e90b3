/* The compiler's output: puts the few lines that help into the message, and all of it into a folder if asked. */
#include "cl/build_log.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define EC_LOG_LINES 15

char *ec_build_log(const ec_cl *cl, cl_program program)
{
    size_t size = 0;
    if (clGetProgramBuildInfo(program, cl->info.id, CL_PROGRAM_BUILD_LOG, 0, NULL, &size) != CL_SUCCESS || size < 2)
        return NULL;
    char *log = malloc(size + 1);
    if (!log) return NULL;
    log[size] = 0; /* some drivers leave the terminator out */
    if (clGetProgramBuildInfo(program, cl->info.id, CL_PROGRAM_BUILD_LOG, size, log, NULL) == CL_SUCCESS) return log;
    free(log);
    return NULL;
}

static bool is_error(const char *line, size_t length)
{
    for (size_t i = 0; i + 5 <= length; i++)
        if (memcmp(line + i, "error", 5) == 0) return true;
    return false;
}

/* Finds where line n of the source comes from, by the #line before it. */
static void place_of(const char *source, unsigned n, char *place, size_t size)
{
    unsigned line = n, named;
    char file[256] = "kernels";
    for (unsigned at = 1; source && *source && at < n; at++) {
        if (sscanf(source, "#line %u \"%255[^\"]\"", &named, file) == 2) line = named + n - at - 1;
        source += strcspn(source, "\n");
        source += *source == '\n';
    }
    snprintf(place, size, "%s:%u", file, line);
}

/* Corrects the place of a line: NVIDIA's compiler counts lines from the start of the source, whatever #line says. Returns how many characters of the
 * line the place replaces. */
static size_t put_right(const char *line, const char *source, char *place, size_t size)
{
    char number[10]; /* %u would look for one on the next line too */
    int read = 0;
    *place = 0;
    if (sscanf(line, "<kernel>:%9[0-9]%n", number, &read) < 1) return 0;
    place_of(source, (unsigned)strtoul(number, NULL, 10), place, size);
    return (size_t)read;
}

/* Appends up to *lines lines of the log, those with errors or the others. */
static void append_lines(char *text, size_t size, const char *log, const char *source, bool errors, int *lines)
{
    size_t used = strlen(text);
    while (*log && *lines > 0) {
        size_t length = strcspn(log, "\n");
        if (length && is_error(log, length) == errors) {
            char place[300];
            const size_t skip = put_right(log, source, place, sizeof place);
            int put = snprintf(text + used, size - used, "\n  %s%.*s", place, (int)(length - skip), log + skip);
            if (put < 0 || (size_t)put >= size - used) {
                text[used] = 0; /* no half lines */
                return;
            }
            used += (size_t)put;
            --*lines;
        }
        log += length + (log[length] == '\n');
    }
}

/* Returns what to do about a failed build. PoCL says only that it failed if it cannot write what it compiles. */
static const char *remedy(const ec_cl *cl, const char *log)
{
    if (is_error(log ? log : "", log ? strlen(log) : 0) || strcmp(cl->info.platform_name, "Portable Computing Language") != 0)
        return "ECLAT_DUMP_KERNELS=DIR writes source and full log there";
    return "its compiler gives no reason; its disk may be full, or its folder not writable: POCL_CACHE_DIR=FOLDER names another";
}

ec_result ec_build_log_fail(const ec_cl *cl, const char *label, const char *source, const char *log, cl_int code, ec_error *err)
{
    ec_fail(err, "kernels %s do not compile on %s: %s (%d); %s", label, cl->info.name, ec_cl_error_name(code), code, remedy(cl, log));
    if (!err || !log) return EC_FAILED;
    int lines = EC_LOG_LINES;
    append_lines(err->text, sizeof err->text, log, source, true, &lines);
    append_lines(err->text, sizeof err->text, log, source, false, &lines);
    return EC_FAILED;
}

static ec_result write_file(const char *folder, const char *label, const char *suffix, const char *first, const char *rest, ec_error *err)
{
    char path[4096];
    FILE *file = snprintf(path, sizeof path, "%s/%s.%s", folder, label, suffix) < (int)sizeof path ? fopen(path, "w") : NULL;
    if (!file) return ec_fail(err, "ECLAT_DUMP_KERNELS: cannot write '%s': %s", path, strerror(errno));
    const bool is_written = fprintf(file, "%s%s", first, rest) >= 0;
    return fclose(file) == 0 && is_written ? EC_OK : ec_fail(err, "ECLAT_DUMP_KERNELS: cannot write '%s': %s", path, strerror(errno));
}

bool ec_build_log_wanted(void)
{
    const char *folder = getenv("ECLAT_DUMP_KERNELS");
    return folder && *folder;
}

ec_result ec_build_log_dump(const char *label, const char *source, const char *options, const char *log, ec_error *err)
{
    if (!ec_build_log_wanted()) return EC_OK;
    const char *folder = getenv("ECLAT_DUMP_KERNELS");
    mkdir(folder, 0777);
    char first[1024];
    snprintf(first, sizeof first, "// options: %s\n", options);
    EC_TRY(write_file(folder, label, "cl", first, source, err));
    return write_file(folder, label, "log", "", log ? log : "", err);
}
