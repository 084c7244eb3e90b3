#include <string.h>

#include "lib/internal.h"

const char *eclat_version(void) { return EC_VERSION; }

eclat_result ec_lib_end(ec_result result, const ec_error *from, eclat_error *to)
{
    if (to) {
        _Static_assert(sizeof to->text == sizeof from->text, "messages fit");
        memcpy(to->text, result == EC_OK ? "" : from->text, result == EC_OK ? 1 : sizeof to->text);
        to->kind = result == EC_OK ? ECLAT_ERROR_OTHER : (eclat_error_kind)from->kind;
    }
    return (eclat_result)result;
}
