#include "base/error.h"
#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Formats a text, possibly with names of files, and cuts it at a whole character if it is too long. */
static void format_whole(char *text, size_t size, const char *format, va_list args)
{
    vsnprintf(text, size, format, args);
    text[ec_text_cut(text, (int)size)] = 0;
    ec_text_clean(text);
}

ec_result ec_fail(ec_error *err, const char *format, ...)
{
    if (err) {
        va_list args;
        va_start(args, format);
        format_whole(err->text, sizeof err->text, format, args);
        va_end(args);
        err->kind = EC_ERROR_OTHER;
    }
    return EC_FAILED;
}

void ec_fail_more(ec_error *err, const char *format, ...)
{
    if (!err) return;
    size_t used = strlen(err->text);
    va_list args;
    va_start(args, format);
    format_whole(err->text + used, sizeof err->text - used, format, args);
    va_end(args);
}

void ec_tell(const ec_log *log, ec_severity severity, const char *format, ...)
{
    if (!log || !log->write) return;
    char text[2048];
    va_list args;
    va_start(args, format);
    format_whole(text, sizeof text, format, args);
    va_end(args);
    log->write(log->user, severity, text);
}
