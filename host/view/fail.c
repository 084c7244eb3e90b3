#include "view/view.h"

#include <stdarg.h>
#include <stdio.h>

eclat_result ec_view_fail(eclat_error *err, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    if (err) vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    return ECLAT_FAILED;
}
