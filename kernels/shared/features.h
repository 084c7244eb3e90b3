/* What a scene can call for, one bit each: the host sets the mask (host/pack/features.c), the kernels are built with it.
 * A bit says that code is structurally needed; values stay in buffers. */
#ifndef EC_SHARED_FEATURES_H
#define EC_SHARED_FEATURES_H

#include "types.h"

/* X(bit, NAME, text for `eclat info`) */
#define EC_FEATURES(X)                                                                             \
    X(0, EMISSION, "emission")                                                                     \
    X(1, AREA_LIGHTS, "area-lights")                                                               \
    X(2, PUNCTUAL_LIGHTS, "punctual-lights")                                                       \
    X(3, ENVIRONMENT, "environment")                                                               \
    X(4, ENVIRONMENT_MAP, "environment-map")                                                       \
    X(5, SPECULAR, "specular")                                                                     \
    X(6, SMOOTH_NORMALS, "smooth-normals")                                                         \
    X(7, VERTEX_COLORS, "vertex-colors")                                                           \
    X(8, BASE_COLOR_TEXTURE, "base-color-texture")                                                 \
    X(9, METALLIC_ROUGHNESS_TEXTURE, "metallic-roughness-texture")                                 \
    X(10, NORMAL_TEXTURE, "normal-texture")                                                        \
    X(11, EMISSION_TEXTURE, "emission-texture")                                                    \
    X(12, SPECULAR_TEXTURE, "specular-texture")                                                    \
    X(13, ALPHA, "alpha")                                                                          \
    X(14, CULLING, "back-face-culling")                                                            \
    X(15, UNLIT, "unlit")                                                                          \
    X(16, FLOAT_TEXTURE, "float-textures")                                                          \
    X(17, SMOOTH, "smooth-surfaces")                                                               \
    X(18, TRANSMISSION, "transmission")                                                            \
    X(19, TRANSMISSION_TEXTURE, "transmission-texture")                                            \
    X(20, ABSORPTION, "absorption")                                                                \
    X(21, SOBOL, "sobol-sampler")                                                                  \
    X(22, TERMINATOR, "smooth-terminator")

#define EC_FEATURE_ENUM(bit, name, text) EC_FEATURE_##name = 1 << bit,
enum ec_feature { EC_FEATURES(EC_FEATURE_ENUM) EC_FEATURE_ALL = (1 << 23) - 1 };

/* All of what reads a texture, and so wants texels and places on them. */
#define EC_FEATURES_TEXTURED                                                                                          \
    (EC_FEATURE_BASE_COLOR_TEXTURE | EC_FEATURE_METALLIC_ROUGHNESS_TEXTURE | EC_FEATURE_NORMAL_TEXTURE |              \
     EC_FEATURE_EMISSION_TEXTURE | EC_FEATURE_SPECULAR_TEXTURE | EC_FEATURE_TRANSMISSION_TEXTURE)
#define EC_FEATURES_ATTRIBUTES (EC_FEATURES_TEXTURED | EC_FEATURE_SMOOTH_NORMALS | EC_FEATURE_VERTEX_COLORS)

#ifdef EC_DEVICE_CODE
#ifndef FEATURES
#define FEATURES EC_FEATURE_ALL
#endif
#define HAS(name) ((FEATURES & EC_FEATURE_##name) != 0)
#define HAS_TEXTURES ((FEATURES & EC_FEATURES_TEXTURED) != 0)
#define HAS_ATTRIBUTES ((FEATURES & EC_FEATURES_ATTRIBUTES) != 0)
#endif

#endif
