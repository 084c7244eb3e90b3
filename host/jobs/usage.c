#include "jobs/usage.h"

#include <stdarg.h>
#include <stdio.h>

ec_result ec_usage(ec_error *err, const char *format, ...)
{
    if (err) {
        va_list args;
        va_start(args, format);
        vsnprintf(err->text, sizeof err->text, format, args);
        va_end(args);
    }
    return EC_USAGE;
}
