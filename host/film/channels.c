#include "film/channels.h"
#include "film/sums.h"

#include <stddef.h>

/* A part of the picture's light, with its error. */
#define LIGHT(layer, plane)                                                                        \
    {layer "R", plane, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},                                    \
    {layer "G", plane, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},                                    \
    {layer "B", plane, 2, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},                                    \
    {layer "stderr.R", plane, 3, EC_CHANNEL_HALF, EC_CHANNEL_BY_NAME},                              \
    {layer "stderr.G", plane, 4, EC_CHANNEL_HALF, EC_CHANNEL_BY_NAME},                              \
    {layer "stderr.B", plane, 5, EC_CHANNEL_HALF, EC_CHANNEL_BY_NAME},                              \
    {layer "stderr.Y", plane, 6, EC_CHANNEL_HALF, EC_CHANNEL_BY_NAME}

/* Layers by name, so that viewers group them. */
const ec_channel_row ec_channel_rows[EC_CHANNEL_ROWS] = {
    {"R", EC_PLANE_RGB, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"G", EC_PLANE_RGB, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"B", EC_PLANE_RGB, 2, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"samples", EC_PLANE_SAMPLES, 0, EC_CHANNEL_UINT, EC_CHANNEL_DEFAULT},
    {"stderr.R", EC_PLANE_STDERR, 0, EC_CHANNEL_HALF, EC_CHANNEL_DEFAULT},
    {"stderr.G", EC_PLANE_STDERR, 1, EC_CHANNEL_HALF, EC_CHANNEL_DEFAULT},
    {"stderr.B", EC_PLANE_STDERR, 2, EC_CHANNEL_HALF, EC_CHANNEL_DEFAULT},
    {"stderr.Y", EC_PLANE_STDERR_Y, 0, EC_CHANNEL_HALF, EC_CHANNEL_DEFAULT},
    {"low95.R", EC_PLANE_LOW, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_OF_ALL},
    {"low95.G", EC_PLANE_LOW, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_OF_ALL},
    {"low95.B", EC_PLANE_LOW, 2, EC_CHANNEL_FLOAT, EC_CHANNEL_OF_ALL},
    {"high95.R", EC_PLANE_HIGH, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_OF_ALL},
    {"high95.G", EC_PLANE_HIGH, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_OF_ALL},
    {"high95.B", EC_PLANE_HIGH, 2, EC_CHANNEL_FLOAT, EC_CHANNEL_OF_ALL},
    {"heavy", EC_PLANE_HEAVY, 0, EC_CHANNEL_HALF, EC_CHANNEL_DEFAULT},
    {"clamped.Y", EC_PLANE_CLAMPED, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"clamped.stderr", EC_PLANE_CLAMPED, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"denoised.R", EC_PLANE_DENOISED, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"denoised.G", EC_PLANE_DENOISED, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"denoised.B", EC_PLANE_DENOISED, 2, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"denoised.stderr", EC_PLANE_DENOISED_STDERR, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"best.R", EC_PLANE_BEST, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"best.G", EC_PLANE_BEST, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"best.B", EC_PLANE_BEST, 2, EC_CHANNEL_FLOAT, EC_CHANNEL_DEFAULT},
    {"albedo.R", EC_PLANE_FEATURES, 0, EC_CHANNEL_HALF, EC_CHANNEL_OF_ALL},
    {"albedo.G", EC_PLANE_FEATURES, 1, EC_CHANNEL_HALF, EC_CHANNEL_OF_ALL},
    {"albedo.B", EC_PLANE_FEATURES, 2, EC_CHANNEL_HALF, EC_CHANNEL_OF_ALL},
    {"normal.X", EC_PLANE_FEATURES, 3, EC_CHANNEL_HALF, EC_CHANNEL_OF_ALL},
    {"normal.Y", EC_PLANE_FEATURES, 4, EC_CHANNEL_HALF, EC_CHANNEL_OF_ALL},
    {"normal.Z", EC_PLANE_FEATURES, 5, EC_CHANNEL_HALF, EC_CHANNEL_OF_ALL},
    {"depth.Z", EC_PLANE_FEATURES, 6, EC_CHANNEL_FLOAT, EC_CHANNEL_OF_ALL},
    {"A", EC_PLANE_FEATURES, EC_FILM_ALPHA, EC_CHANNEL_HALF, EC_CHANNEL_DEFAULT},
    LIGHT("direct.", EC_PLANE_LAYER + EC_LAYER_DIRECT),
    LIGHT("indirect.", EC_PLANE_LAYER + EC_LAYER_INDIRECT),
    {"position.X", EC_PLANE_LAYER + EC_LAYER_POSITION, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"position.Y", EC_PLANE_LAYER + EC_LAYER_POSITION, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"position.Z", EC_PLANE_LAYER + EC_LAYER_POSITION, 2, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"uv.U", EC_PLANE_LAYER + EC_LAYER_UV, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"uv.V", EC_PLANE_LAYER + EC_LAYER_UV, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"motion.X", EC_PLANE_LAYER + EC_LAYER_MOTION, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"motion.Y", EC_PLANE_LAYER + EC_LAYER_MOTION, 1, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"CryptoObject", EC_PLANE_MATTE + EC_MATTE_OBJECT, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"CryptoMaterial", EC_PLANE_MATTE + EC_MATTE_MATERIAL, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
    {"CryptoAsset", EC_PLANE_MATTE + EC_MATTE_ASSET, 0, EC_CHANNEL_FLOAT, EC_CHANNEL_BY_NAME},
};

const ec_channel_row ec_group_rows[EC_GROUP_ROWS] = {LIGHT("", EC_PLANE_LAYER + EC_LAYER_KINDS)};

const char *ec_channel_name_of(ec_plane plane, uint32_t place)
{
    for (uint32_t i = 0; i < EC_CHANNEL_ROWS; i++)
        if (ec_channel_rows[i].plane == plane && ec_channel_rows[i].place == place) return ec_channel_rows[i].name;
    return NULL;
}
