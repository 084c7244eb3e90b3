/* Parses values of the command line strictly: all of the text, in a stated range, never NaN. `option` is named in messages. Failures are EC_USAGE. */
#ifndef EC_JOBS_NUMBERS_H
#define EC_JOBS_NUMBERS_H

#include <stdint.h>

#include "base/error.h"

enum { EC_SIZE_MAX_SIDE = 65536, EC_SIZE_MAX_PIXELS = 1 << 28 };

ec_result ec_parse_whole(const char *option, const char *text, uint64_t min, uint64_t max, uint64_t *value,
                         ec_error *err); /* decimal */
ec_result ec_parse_u32(const char *option, const char *text, uint32_t min, uint32_t max, uint32_t *value,
                       ec_error *err);
ec_result ec_parse_real(const char *option, const char *text, double min, double max, double *value, ec_error *err);
ec_result ec_parse_seconds(const char *option, const char *text, double *seconds, ec_error *err); /* 30, 30s, 2m, 1h */
ec_result ec_parse_bytes(const char *option, const char *text, uint64_t *bytes, ec_error *err); /* 4G, 512M: powers of 1000; GiB, MiB: of 1024 */
ec_result ec_parse_percent(const char *option, const char *text, double *fraction, ec_error *err); /* "2" and "2%" are both 0.02 */
/* Parses "A:B": two numbers from 0 to max, the second not below the first. */
ec_result ec_parse_span(const char *option, const char *text, double max, double *from, double *to, ec_error *err);
ec_result ec_parse_size(const char *option, const char *text, uint32_t *width, uint32_t *height, ec_error *err);
extern const char *const ec_lanes_names[]; /* auto, 1, 4, 8, 16 */
ec_result ec_parse_lanes(const char *option, const char *text, uint32_t *lanes, ec_error *err); /* auto: 0 */
ec_result ec_parse_triple(const char *option, const char *text, double xyz[3], ec_error *err); /* X,Y,Z, all finite */
/* Parses left, right, bottom, top: from -most to most, at least 1 / most apart. */
ec_result ec_parse_window(const char *option, const char *text, double most, double window[4], ec_error *err);
/* Parses one of names (NULL-terminated); *index is its index. */
ec_result ec_parse_choice(const char *option, const char *text, const char *const *names, uint32_t *index,
                          ec_error *err);

#endif
