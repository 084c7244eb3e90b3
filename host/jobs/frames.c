#include "jobs/frames.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "jobs/numbers.h"
#include "jobs/option.h"

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

enum { WIDTH_MOST = 9 };

/* Reads what follows a '%': returns the length of d, 4d or 04d, and its width in *width; 0 for anything else. */
static size_t scan_number(const char *text, int *width)
{
    size_t size = 0;
    *width = 0;
    while (isdigit((unsigned char)text[size]) && size < 3) *width = 10 * *width + (text[size++] - '0');
    bool fits = text[size] == 'd' && *width <= WIDTH_MOST && (size == 0 || text[0] == '0');
    return fits ? size + 1 : 0;
}

static ec_result fill(const char *pattern, uint32_t frame, bool several, char path[PATH_MAX], ec_error *err)
{
    size_t used = 0;
    int places = 0, width;
    for (const char *c = pattern; *c; c++) {
        char piece[16] = {*c};
        if (*c == '%' && c[1] == '%') c++;
        else if (*c == '%') {
            size_t size = scan_number(c + 1, &width);
            if (!size) return ec_usage(err, "-o: '%s': after a %% there may be d, as in %%d or %%04d, or another %%", pattern);
            snprintf(piece, sizeof piece, "%0*u", width ? width : 1, frame);
            places++;
            c += size;
        }
        size_t length = strlen(piece);
        if (used + length >= PATH_MAX) return ec_usage(err, "-o: the path is longer than %d bytes", PATH_MAX - 1);
        memcpy(path + used, piece, length);
        used += length;
    }
    path[used] = 0;
    if (places > 1) return ec_usage(err, "-o: '%s' has %d places for the frame's number; leave one", pattern, places);
    if (places == 0 && several)
        return ec_usage(err, "-o: '%s' is one name for all --frames; put %%04d where the frame's number goes, as in out.%%04d.exr", pattern);
    return EC_OK;
}

ec_result ec_frame_outputs(const ec_outputs *patterns, uint32_t frame, bool several, ec_outputs *outputs, ec_error *err)
{
    outputs->count = 0;
    for (int i = 0; i < patterns->count; i++) {
        char path[PATH_MAX];
        EC_TRY(fill(patterns->file[i].path, frame, several, path, err));
        EC_TRY(ec_outputs_add(outputs, path, err));
    }
    return EC_OK;
}
