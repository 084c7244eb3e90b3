#include "store/layout.h"

#include <stdio.h>

static const char *const fields[EC_BATCH_FIELDS] = {"R", "G", "B", "largest.Y", "squares.Y", "fourths.Y"};

uint32_t ec_sum_channels(const ec_sums *sums, const uint32_t *counts, ec_channel_name names[EC_SUM_CHANNELS], ec_channel channels[EC_SUM_CHANNELS])
{
    uint32_t n = 0;
    for (; n < 3 * sums->replicates; n++) {
        snprintf(names[n].text, sizeof names[n].text, "replicate %02u.%s", n / 3, fields[n % 3]);
        channels[n] = (ec_channel){names[n].text, ec_sums_mean(sums, n / 3, 0) + n % 3, 3, EC_CHANNEL_FLOAT};
    }
    for (uint32_t i = 0; i < 3; i++, n++) channels[n] = (ec_channel){fields[3 + i], sums->tail + i, 3, EC_CHANNEL_FLOAT};
    for (uint32_t i = 0; i < EC_FILM_FEATURES * sums->sets; i++, n++) {
        const uint32_t set = i / EC_FILM_FEATURES, place = i % EC_FILM_FEATURES;
        snprintf(names[n].text, sizeof names[n].text, "set %u.%s", set, ec_channel_name_of(EC_PLANE_FEATURES, place));
        channels[n] = (ec_channel){names[n].text, ec_sums_features(sums, set, 0) + place, EC_FILM_FEATURES, EC_CHANNEL_FLOAT};
    }
    if (counts) channels[n++] = (ec_channel){"count", (const float *)counts, 1, EC_CHANNEL_WORDS};
    return n;
}

uint32_t ec_batch_channels(const float *batch, const float *features, ec_channel channels[EC_BATCH_CHANNELS])
{
    for (int c = 0; c < EC_BATCH_FIELDS; c++) channels[c] = (ec_channel){fields[c], batch + c, EC_BATCH_FIELDS, EC_CHANNEL_FLOAT};
    for (uint32_t i = 0; features && i < EC_FILM_FEATURES; i++)
        channels[EC_BATCH_FIELDS + i] = (ec_channel){ec_channel_name_of(EC_PLANE_FEATURES, i), features + i, EC_FILM_FEATURES, EC_CHANNEL_FLOAT};
    return features ? EC_BATCH_CHANNELS : EC_BATCH_FIELDS;
}

void ec_sum_part_name(uint32_t layer, uint32_t index, char name[EC_PART_NAME])
{
    if (layer) snprintf(name, EC_PART_NAME, "layer %u sums %u", layer, index);
    else snprintf(name, EC_PART_NAME, "sums %u", index);
}
