#include "base/error.h"

#include <stdarg.h>
#include <stdio.h>

ec_result ec_fail(ec_error *err, const char *format, ...)
{
    if (err) {
        va_list args;
        va_start(args, format);
        vsnprintf(err->text, sizeof err->text, format, args);
        va_end(args);
    }
    return EC_FAILED;
}

static void log_write(const ec_log *log, ec_severity severity, const char *format, va_list args)
{
    if (!log || !log->write) return;
    char text[2048];
    vsnprintf(text, sizeof text, format, args);
    log->write(log->user, severity, text);
}

void ec_note(const ec_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_write(log, EC_NOTE, format, args);
    va_end(args);
}

void ec_warn(const ec_log *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_write(log, EC_WARNING, format, args);
    va_end(args);
}
