#include "store/layout.h"

#include <stdio.h>

const char *const ec_feature_channels[EC_FEATURE_CHANNELS] = {"albedo.R", "albedo.G", "albedo.B", "normal.X",
                                                              "normal.Y", "normal.Z", "depth.Z",  "A"};

static const char *const doubles[7][2] = {{"mean.R.low", "mean.R.high"}, {"mean.G.low", "mean.G.high"},
                                          {"mean.B.low", "mean.B.high"}, {"m2.R.low", "m2.R.high"},
                                          {"m2.G.low", "m2.G.high"},     {"m2.B.low", "m2.B.high"},
                                          {"m2.Y.low", "m2.Y.high"}};

/* A double's two halves; the low one comes first in memory where bytes do. */
static void add_halves(ec_channel *to, const char *const names[2], const double *first, uint32_t stride)
{
    const union {
        uint16_t number;
        uint8_t bytes[2];
    } order = {1};
    const float *words = (const float *)first;
    int low = order.bytes[0] ? 0 : 1;
    to[0] = (ec_channel){names[0], words + low, 2 * stride, true};
    to[1] = (ec_channel){names[1], words + 1 - low, 2 * stride, true};
}

uint32_t ec_sum_channels(const ec_moments *m, const uint32_t *counts, ec_channel channels[EC_SUM_CHANNELS])
{
    uint32_t n = 0;
    for (int c = 0; c < 3; c++, n += 2) add_halves(channels + n, doubles[c], m->mean + c, 3);
    for (int c = 0; c < 4; c++, n += 2) add_halves(channels + n, doubles[3 + c], m->m2 + c, 4);
    channels[n++] = (ec_channel){"m3.Y", m->m34, 2, false};
    channels[n++] = (ec_channel){"m4.Y", m->m34 + 1, 2, false};
    channels[n++] = (ec_channel){"largest.Y", m->largest, 1, false};
    if (counts) channels[n++] = (ec_channel){"count", (const float *)counts, 1, true};
    return n;
}

uint32_t ec_batch_channels(const float *batch, ec_channel channels[3])
{
    static const char *const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++) channels[c] = (ec_channel){names[c], batch + c, 3, false};
    return 3;
}

void ec_sum_part_name(uint32_t index, char name[24])
{
    snprintf(name, 24, "sums %u", index);
}
