#include "jobs/numbers.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs/option.h"

/* 116 days: renders of a day are long, and weeks are conceivable. */
#define EC_MAX_SECONDS 1e7

/* Reads decimal digits only, as strtoull also accepts blanks, signs and more. *end is where they stop. */
static int scan_whole(const char *text, uint64_t *value, const char **end)
{
    if (!isdigit((unsigned char)*text)) return 0;
    char *stop;
    errno = 0;
    *value = strtoull(text, &stop, 10);
    *end = stop;
    return errno == 0;
}

/* Reads digits, sign, point and exponent only: no hexadecimal, "inf", "nan" or blanks. */
static int scan_real(const char *text, double *value, const char **end)
{
    size_t size = strspn(text, "0123456789+-.eE");
    if (size == 0 || !(isdigit((unsigned char)*text) || strchr("+-.", *text))) return 0;
    char *stop;
    *value = strtod(text, &stop);
    *end = stop;
    return stop != text && stop <= text + size && isfinite(*value); /* strtod would read on after 0x */
}

ec_result ec_parse_whole(const char *option, const char *text, uint64_t min, uint64_t max, uint64_t *value,
                         ec_error *err)
{
    const char *end;
    uint64_t parsed;
    if (!scan_whole(text, &parsed, &end) || *end || parsed < min || parsed > max)
        return ec_usage(err, "--%s: '%s' is not a whole number from %" PRIu64 " to %" PRIu64, option, text, min, max);
    *value = parsed;
    return EC_OK;
}

ec_result ec_parse_u32(const char *option, const char *text, uint32_t min, uint32_t max, uint32_t *value,
                       ec_error *err)
{
    uint64_t wide = 0;
    EC_TRY(ec_parse_whole(option, text, min, max, &wide, err));
    *value = (uint32_t)wide;
    return EC_OK;
}

ec_result ec_parse_real(const char *option, const char *text, double min, double max, double *value, ec_error *err)
{
    const char *end;
    double parsed;
    if (!scan_real(text, &parsed, &end) || *end || parsed < min || parsed > max)
        return ec_usage(err, "--%s: '%s' is not a number from %g to %g", option, text, min, max);
    *value = parsed;
    return EC_OK;
}

static double seconds_in(const char *unit)
{
    if (!*unit || !strcmp(unit, "s")) return 1;
    if (!strcmp(unit, "m") || !strcmp(unit, "min")) return 60;
    if (!strcmp(unit, "h")) return 3600;
    return 0;
}

ec_result ec_parse_seconds(const char *option, const char *text, double *seconds, ec_error *err)
{
    const char *unit;
    double parsed;
    if (!scan_real(text, &parsed, &unit) || seconds_in(unit) == 0)
        return ec_usage(err, "--%s: '%s' is not a time such as 30, 30s, 2m or 1h", option, text);
    parsed *= seconds_in(unit);
    if (!(parsed > 0) || parsed > EC_MAX_SECONDS)
        return ec_usage(err, "--%s: '%s' must be more than 0 and at most %g seconds", option, text, EC_MAX_SECONDS);
    *seconds = parsed;
    return EC_OK;
}

/* Returns the bytes in a unit: "4G" and "4GB" are 4 10^9, "4Gi" and "4GiB" 4 2^30; 0: not a unit. */
static double bytes_in(const char *unit)
{
    static const char letters[] = "kKmMgGtT";
    const char *letter = *unit ? strchr(letters, *unit) : NULL;
    if (!letter) return 0;
    bool is_binary = unit[1] == 'i';
    const char *rest = unit + 1 + is_binary;
    return !*rest || !strcmp(rest, "B") ? pow(is_binary ? 1024 : 1000, (double)((letter - letters) / 2 + 1)) : 0;
}

ec_result ec_parse_bytes(const char *option, const char *text, uint64_t *bytes, ec_error *err)
{
    const char *unit;
    double parsed;
    if (!scan_real(text, &parsed, &unit) || bytes_in(unit) == 0)
        return ec_usage(err, "--%s: '%s' is not an amount of memory such as 512M or 4G", option, text);
    parsed *= bytes_in(unit);
    if (!(parsed >= 1e6) || parsed > 1e18) return ec_usage(err, "--%s: '%s' must be from 1M to 1000000T", option, text);
    *bytes = (uint64_t)parsed;
    return EC_OK;
}

ec_result ec_parse_percent(const char *option, const char *text, double *fraction, ec_error *err)
{
    const char *end;
    double parsed;
    if (!scan_real(text, &parsed, &end) || (*end && strcmp(end, "%")))
        return ec_usage(err, "--%s: '%s' is not a percentage such as 2 or 2%%", option, text);
    if (!(parsed > 0) || parsed > 100)
        return ec_usage(err, "--%s: '%s' must be more than 0 and at most 100 per cent", option, text);
    *fraction = parsed / 100;
    return EC_OK;
}

ec_result ec_parse_size(const char *option, const char *text, uint32_t *width, uint32_t *height, ec_error *err)
{
    const char *x, *end;
    uint64_t w, h;
    if (!scan_whole(text, &w, &x) || *x != 'x' || !scan_whole(x + 1, &h, &end) || *end)
        return ec_usage(err, "--%s: '%s' is not WIDTHxHEIGHT such as 512x512", option, text);
    if (w < 1 || h < 1 || w > EC_SIZE_MAX_SIDE || h > EC_SIZE_MAX_SIDE)
        return ec_usage(err, "--%s: '%s': each side must be from 1 to %d pixels", option, text, EC_SIZE_MAX_SIDE);
    if (w * h > EC_SIZE_MAX_PIXELS)
        return ec_usage(err, "--%s: '%s' has more than %d pixels in all", option, text, EC_SIZE_MAX_PIXELS);
    *width = (uint32_t)w;
    *height = (uint32_t)h;
    return EC_OK;
}

ec_result ec_parse_choice(const char *option, const char *text, const char *const *names, uint32_t *index,
                          ec_error *err)
{
    char list[256] = "";
    for (uint32_t i = 0; names[i]; i++) {
        if (!strcmp(names[i], text)) {
            *index = i;
            return EC_OK;
        }
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
    }
    return ec_usage(err, "--%s: '%s' is not one of %s", option, text, list);
}

const char *const ec_lanes_names[] = {"auto", "1", "4", "8", "16", NULL};

ec_result ec_parse_lanes(const char *option, const char *text, uint32_t *lanes, ec_error *err)
{
    static const uint32_t widths[] = {0, 1, 4, 8, 16};
    uint32_t index = 0;
    EC_TRY(ec_parse_choice(option, text, ec_lanes_names, &index, err));
    *lanes = widths[index];
    return EC_OK;
}

ec_result ec_parse_span(const char *option, const char *text, double max, double *from, double *to, ec_error *err)
{
    char first[64];
    const char *colon = strchr(text, ':');
    if (!colon || (size_t)(colon - text) >= sizeof first)
        return ec_usage(err, "--%s: '%s' is not two numbers as in 0.5:0.52", option, text);
    snprintf(first, sizeof first, "%.*s", (int)(colon - text), text);
    EC_TRY(ec_parse_real(option, first, 0, max, from, err));
    EC_TRY(ec_parse_real(option, colon + 1, 0, max, to, err));
    if (*from > *to) return ec_usage(err, "--%s: '%s' ends before it begins; give the earlier moment first", option, text);
    return EC_OK;
}

static bool scan_list(const char *at, int count, double *values)
{
    for (int i = 0; i < count; i++) {
        if (!scan_real(at, &values[i], &at) || *at != (i < count - 1 ? ',' : 0)) return false;
        at += i < count - 1;
    }
    return true;
}

ec_result ec_parse_triple(const char *option, const char *text, double xyz[3], ec_error *err)
{
    if (scan_list(text, 3, xyz)) return EC_OK;
    return ec_usage(err, "--%s: '%s' is not three numbers separated by commas, as in 1,2.5,-3", option, text);
}

ec_result ec_parse_window(const char *option, const char *text, double most, double window[4], ec_error *err)
{
    double read[4];
    if (!scan_list(text, 4, read)) return ec_usage(err, "--%s: '%s' is not four numbers separated by commas, as in -1,1,-0.5,1.5", option, text);
    for (int i = 0; i < 4; i++)
        if (!(fabs(read[i]) <= most)) return ec_usage(err, "--%s: '%s' reaches too far; give numbers from -%g to %g", option, text, most, most);
    for (int i = 0; i < 4; i += 2)
        if (!(read[i + 1] - read[i] >= 1 / most))
            return ec_usage(err, "--%s: '%s' leaves nothing to see; the order is left, right, bottom, top", option, text);
    memcpy(window, read, sizeof read);
    return EC_OK;
}
