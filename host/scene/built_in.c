#include "scene/built_in.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

bool ec_is_built_in(const char *spec) { return !strcmp(spec, EC_STUDIO) || !strncmp(spec, EC_SKY, strlen(EC_SKY)); }

static ec_result read_sun(const char *spec, double *azimuth, double *elevation, ec_error *err)
{
    const char *numbers = spec + strlen(EC_SKY);
    int used = 0;
    if (strspn(numbers, "0123456789+-.eE,") == strlen(numbers) && sscanf(numbers, "%lf,%lf%n", azimuth, elevation, &used) == 2 && !numbers[used] &&
        fabs(*azimuth) <= 36000 && *elevation >= 0 && *elevation <= 90)
        return EC_OK;
    return ec_fail(err, "environment \"%.*s\": " EC_SKY "AZIMUTH,ELEVATION needs two numbers in degrees, the second from 0 to 90, e.g. " EC_SKY "30,45",
                   EC_CUT(spec, 200));
}

/* Makes either map; that of a sky is large enough for texels as fine as the sun. */
ec_result ec_built_in_make(const char *spec, ec_made_map *map, ec_error *err)
{
    const bool is_sky = strcmp(spec, EC_STUDIO) != 0;
    double azimuth = 0, elevation = 0;
    if (is_sky) EC_TRY(read_sun(spec, &azimuth, &elevation, err));
    *map = is_sky ? (ec_made_map){.width = 1024, .height = 512} : (ec_made_map){.width = 512, .height = 256};
    map->rgb = malloc(3 * sizeof(float) * map->width * map->height);
    if (!map->rgb) return ec_fail(err, "out of memory for an environment map of %u x %u", map->width, map->height);
    if (is_sky) ec_sky_fill(map, azimuth, elevation);
    else ec_studio_fill(map);
    return EC_OK;
}
