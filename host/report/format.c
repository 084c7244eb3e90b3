#include "report/format.h"

#include <stdio.h>

void ec_format_count(double value, char *text, size_t size)
{
    static const char *const prefixes[] = {"", " k", " M", " G", " T"};
    int i = 0;
    for (; value >= 999.5 && i < 4; i++) value /= 1000;
    if (i == 0)
        snprintf(text, size, "%.3g", value);
    else
        snprintf(text, size, "%.*f%s", value < 9.995 ? 2 : value < 99.95 ? 1 : 0, value, prefixes[i]);
}

void ec_format_percent(double fraction, char *text, size_t size)
{
    double percent = 100 * fraction;
    int decimals = 0;
    for (double limit = 99.95; percent < limit && decimals < 6; limit /= 10) decimals++;
    snprintf(text, size, "%.*f %%", decimals, percent);
}

void ec_format_bytes(uint64_t bytes, char *text, size_t size)
{
    static const char *const units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
    double value = (double)bytes;
    int i = 0;
    for (; value >= 1023.5 && i < 4; i++) value /= 1024;
    snprintf(text, size, "%.*f %s", i == 0 || value >= 100 ? 0 : 1, value, units[i]);
}

void ec_format_roulette(double survival, char *text, size_t size)
{
    if (survival == 0 || survival == 1)
        snprintf(text, size, "%s", survival == 0 ? "auto" : "off");
    else
        snprintf(text, size, "%.9g", survival);
}

void ec_format_seconds(double seconds, char *text, size_t size)
{
    if (seconds < 0.9995)
        snprintf(text, size, "%.3g ms", 1000 * seconds);
    else if (seconds < 99.95)
        snprintf(text, size, "%.3g s", seconds);
    else if (seconds < 3600)
        snprintf(text, size, "%d min %d s", (int)seconds / 60, (int)seconds % 60);
    else
        snprintf(text, size, "%d h %d min", (int)seconds / 3600, (int)seconds / 60 % 60);
}
