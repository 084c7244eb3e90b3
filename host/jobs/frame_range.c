#include "jobs/frame_range.h"

#include <stdio.h>
#include <string.h>

#include "jobs/numbers.h"
#include "jobs/usage.h"

ec_result ec_frame_range_parse(const char *option, const char *text, ec_frame_range *range, ec_error *err)
{
    uint32_t number[3] = {0, 0, 1};
    int count = 0;
    const char *at = text;
    for (; count < 3; count++) {
        char digits[16];
        size_t size = strcspn(at, ":");
        if (size >= sizeof digits || size == 0) break;
        snprintf(digits, sizeof digits, "%.*s", (int)size, at);
        EC_TRY(ec_parse_u32(option, digits, count == 2, EC_FRAME_MOST, &number[count], err));
        at += size;
        if (!*at) break;
        at++;
    }
    if (*at || at == text || at[-1] == ':')
        return ec_usage(err, "--%s: '%s' is neither a frame's number nor A:B nor A:B:STEP, as in 0:99 or 0:99:2", option, text);
    if (count == 0) number[1] = number[0];
    if (number[0] > number[1]) return ec_usage(err, "--%s: '%s' ends before it begins; give the earlier frame first", option, text);
    range->given = true;
    range->first = number[0];
    range->last = number[1];
    range->step = number[2];
    return EC_OK;
}
