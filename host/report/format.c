#include "report/format.h"

#include <stdio.h>

ec_figure ec_count(double value)
{
    ec_figure figure;
    static const char *const prefixes[] = {"", " k", " M", " G", " T"};
    int i = 0;
    for (; value >= 999.5 && i < 4; i++) value /= 1000;
    if (i == 0)
        snprintf(figure.text, sizeof figure.text, "%.3g", value);
    else
        snprintf(figure.text, sizeof figure.text, "%.*f%s", value < 9.995 ? 2 : value < 99.95 ? 1 : 0, value, prefixes[i]);
    return figure;
}

ec_figure ec_percent(double fraction)
{
    ec_figure figure;
    double percent = 100 * fraction;
    int decimals = 0;
    for (double limit = 99.95; percent != 0 && percent < limit && decimals < 6; limit /= 10) decimals++;
    snprintf(figure.text, sizeof figure.text, "%.*f %%", decimals, percent);
    return figure;
}

ec_figure ec_bytes(uint64_t bytes)
{
    ec_figure figure;
    static const char *const units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
    double value = (double)bytes;
    int i = 0;
    for (; value >= 1023.5 && i < 4; i++) value /= 1024;
    snprintf(figure.text, sizeof figure.text, "%.*f %s", i == 0 || value >= 100 ? 0 : 1, value, units[i]);
    return figure;
}

ec_figure ec_roulette(double survival)
{
    ec_figure figure;
    if (survival == 0 || survival == 1)
        snprintf(figure.text, sizeof figure.text, "%s", survival == 0 ? "auto" : "off");
    else
        snprintf(figure.text, sizeof figure.text, "%.9g", survival);
    return figure;
}

ec_figure ec_seconds(double seconds)
{
    ec_figure figure;
    if (seconds < 0.9995)
        snprintf(figure.text, sizeof figure.text, "%.3g ms", 1000 * seconds);
    else if (seconds < 99.95)
        snprintf(figure.text, sizeof figure.text, "%.3g s", seconds);
    else if (seconds < 3600)
        snprintf(figure.text, sizeof figure.text, "%d min %d s", (int)seconds / 60, (int)seconds % 60);
    else
        snprintf(figure.text, sizeof figure.text, "%d h %d min", (int)seconds / 3600, (int)seconds / 60 % 60);
    return figure;
}
