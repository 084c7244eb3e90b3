/* Formats numbers for people; returned by value: ec_bytes(n).text. */
#ifndef EC_REPORT_FORMAT_H
#define EC_REPORT_FORMAT_H

#include <stdint.h>

typedef struct ec_figure {
    char text[32];
} ec_figure;

ec_figure ec_count(double value);         /* 5.42 M */
ec_figure ec_percent(double fraction);    /* 1.93 %, with three digits */
ec_figure ec_bytes(uint64_t bytes);       /* 62.8 GiB */
ec_figure ec_roulette(double survival);   /* auto, off or 0.8, as in --rr */
ec_figure ec_seconds(double seconds);     /* 12.3 s, 2 min 5 s */

#endif
