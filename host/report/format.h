/* Numbers for people. All write a terminated text into `text`. */
#ifndef EC_REPORT_FORMAT_H
#define EC_REPORT_FORMAT_H

#include <stddef.h>
#include <stdint.h>

void ec_format_count(double value, char *text, size_t size);     /* 5.42 M */
void ec_format_percent(double fraction, char *text, size_t size); /* 1.93 %: three digits */
void ec_format_bytes(uint64_t bytes, char *text, size_t size);   /* 62.8 GiB */
void ec_format_roulette(double survival, char *text, size_t size); /* auto, off, 0.8: as --rr takes it */
void ec_format_seconds(double seconds, char *text, size_t size); /* 12.3 s, 2 min 5 s */

#endif
