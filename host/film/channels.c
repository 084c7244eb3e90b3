#include "film/channels.h"

#include <stddef.h>

/* Layers by name, so that viewers group them. */
const ec_channel_row ec_channel_rows[EC_CHANNEL_ROWS] = {
    {"R", EC_PLANE_RGB, 0},
    {"G", EC_PLANE_RGB, 1},
    {"B", EC_PLANE_RGB, 2},
    {"samples", EC_PLANE_SAMPLES, 0},
    {"stderr.R", EC_PLANE_STDERR, 0},
    {"stderr.G", EC_PLANE_STDERR, 1},
    {"stderr.B", EC_PLANE_STDERR, 2},
    {"stderr.Y", EC_PLANE_STDERR_Y, 0},
    {"low95.R", EC_PLANE_LOW, 0},
    {"low95.G", EC_PLANE_LOW, 1},
    {"low95.B", EC_PLANE_LOW, 2},
    {"high95.R", EC_PLANE_HIGH, 0},
    {"high95.G", EC_PLANE_HIGH, 1},
    {"high95.B", EC_PLANE_HIGH, 2},
    {"heavy", EC_PLANE_HEAVY, 0},
    {"clamped.Y", EC_PLANE_CLAMPED, 0},
    {"clamped.stderr", EC_PLANE_CLAMPED, 1},
    {"albedo.R", EC_PLANE_FEATURES, 0},
    {"albedo.G", EC_PLANE_FEATURES, 1},
    {"albedo.B", EC_PLANE_FEATURES, 2},
    {"normal.X", EC_PLANE_FEATURES, 3},
    {"normal.Y", EC_PLANE_FEATURES, 4},
    {"normal.Z", EC_PLANE_FEATURES, 5},
    {"depth.Z", EC_PLANE_FEATURES, 6},
    {"A", EC_PLANE_FEATURES, EC_PLACE_ALPHA},
};

const char *ec_channel_name_of(ec_plane plane, uint32_t place)
{
    for (uint32_t i = 0; i < EC_CHANNEL_ROWS; i++)
        if (ec_channel_rows[i].plane == plane && ec_channel_rows[i].place == place) return ec_channel_rows[i].name;
    return NULL;
}
