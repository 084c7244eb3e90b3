#include "film/channels.h"

#include <stddef.h>

/* Layers by name, so that viewers group them. */
const ec_channel_row ec_channel_rows[EC_CHANNEL_ROWS] = {
    {"R", EC_PLANE_RGB, 0, EC_CHANNEL_FLOAT, true},
    {"G", EC_PLANE_RGB, 1, EC_CHANNEL_FLOAT, true},
    {"B", EC_PLANE_RGB, 2, EC_CHANNEL_FLOAT, true},
    {"samples", EC_PLANE_SAMPLES, 0, EC_CHANNEL_UINT, true},
    {"stderr.R", EC_PLANE_STDERR, 0, EC_CHANNEL_HALF, true},
    {"stderr.G", EC_PLANE_STDERR, 1, EC_CHANNEL_HALF, true},
    {"stderr.B", EC_PLANE_STDERR, 2, EC_CHANNEL_HALF, true},
    {"stderr.Y", EC_PLANE_STDERR_Y, 0, EC_CHANNEL_HALF, true},
    {"low95.R", EC_PLANE_LOW, 0, EC_CHANNEL_FLOAT, false},
    {"low95.G", EC_PLANE_LOW, 1, EC_CHANNEL_FLOAT, false},
    {"low95.B", EC_PLANE_LOW, 2, EC_CHANNEL_FLOAT, false},
    {"high95.R", EC_PLANE_HIGH, 0, EC_CHANNEL_FLOAT, false},
    {"high95.G", EC_PLANE_HIGH, 1, EC_CHANNEL_FLOAT, false},
    {"high95.B", EC_PLANE_HIGH, 2, EC_CHANNEL_FLOAT, false},
    {"heavy", EC_PLANE_HEAVY, 0, EC_CHANNEL_HALF, true},
    {"clamped.Y", EC_PLANE_CLAMPED, 0, EC_CHANNEL_FLOAT, true},
    {"clamped.stderr", EC_PLANE_CLAMPED, 1, EC_CHANNEL_FLOAT, true},
    {"denoised.R", EC_PLANE_DENOISED, 0, EC_CHANNEL_FLOAT, true},
    {"denoised.G", EC_PLANE_DENOISED, 1, EC_CHANNEL_FLOAT, true},
    {"denoised.B", EC_PLANE_DENOISED, 2, EC_CHANNEL_FLOAT, true},
    {"denoised.stderr", EC_PLANE_DENOISED_STDERR, 0, EC_CHANNEL_FLOAT, true},
    {"best.R", EC_PLANE_BEST, 0, EC_CHANNEL_FLOAT, true},
    {"best.G", EC_PLANE_BEST, 1, EC_CHANNEL_FLOAT, true},
    {"best.B", EC_PLANE_BEST, 2, EC_CHANNEL_FLOAT, true},
    {"albedo.R", EC_PLANE_FEATURES, 0, EC_CHANNEL_HALF, false},
    {"albedo.G", EC_PLANE_FEATURES, 1, EC_CHANNEL_HALF, false},
    {"albedo.B", EC_PLANE_FEATURES, 2, EC_CHANNEL_HALF, false},
    {"normal.X", EC_PLANE_FEATURES, 3, EC_CHANNEL_HALF, false},
    {"normal.Y", EC_PLANE_FEATURES, 4, EC_CHANNEL_HALF, false},
    {"normal.Z", EC_PLANE_FEATURES, 5, EC_CHANNEL_HALF, false},
    {"depth.Z", EC_PLANE_FEATURES, 6, EC_CHANNEL_FLOAT, false},
    {"A", EC_PLANE_FEATURES, EC_PLACE_ALPHA, EC_CHANNEL_HALF, true},
};

const char *ec_channel_name_of(ec_plane plane, uint32_t place)
{
    for (uint32_t i = 0; i < EC_CHANNEL_ROWS; i++)
        if (ec_channel_rows[i].plane == plane && ec_channel_rows[i].place == place) return ec_channel_rows[i].name;
    return NULL;
}
