/* Effects that a scene can call for, one bit each: the host sets the mask (host/pack/features.c), the kernels are built with it. A bit says that code
 * is structurally needed; values stay in buffers. */
#ifndef EC_SHARED_FEATURES_H
#define EC_SHARED_FEATURES_H

#include "material_fields.h"
#include "types.h"

#define EC_FEATURE_BIT(n) ((ec_ulong)1 << (n))
#define EC_FEATURE_NONE 0
#define EC_FEATURE_EMISSION EC_FEATURE_BIT(0)
#define EC_FEATURE_AREA_LIGHTS EC_FEATURE_BIT(1)
#define EC_FEATURE_PUNCTUAL_LIGHTS EC_FEATURE_BIT(2)
#define EC_FEATURE_ENVIRONMENT EC_FEATURE_BIT(3)
#define EC_FEATURE_ENVIRONMENT_MAP EC_FEATURE_BIT(4)
#define EC_FEATURE_SPECULAR EC_FEATURE_BIT(5)
#define EC_FEATURE_SMOOTH_NORMALS EC_FEATURE_BIT(6)
#define EC_FEATURE_VERTEX_COLORS EC_FEATURE_BIT(7)
#define EC_FEATURE_BASE_COLOR_TEXTURE EC_FEATURE_BIT(8)
#define EC_FEATURE_METALLIC_ROUGHNESS_TEXTURE EC_FEATURE_BIT(9)
#define EC_FEATURE_NORMAL_TEXTURE EC_FEATURE_BIT(10)
#define EC_FEATURE_EMISSION_TEXTURE EC_FEATURE_BIT(11)
#define EC_FEATURE_SPECULAR_TEXTURE EC_FEATURE_BIT(12)
#define EC_FEATURE_ALPHA EC_FEATURE_BIT(13)
#define EC_FEATURE_CULLING EC_FEATURE_BIT(14)
#define EC_FEATURE_UNLIT EC_FEATURE_BIT(15)
#define EC_FEATURE_FLOAT_TEXTURE EC_FEATURE_BIT(16)
#define EC_FEATURE_SMOOTH EC_FEATURE_BIT(17)
#define EC_FEATURE_TRANSMISSION EC_FEATURE_BIT(18)
#define EC_FEATURE_TRANSMISSION_TEXTURE EC_FEATURE_BIT(19)
#define EC_FEATURE_ABSORPTION EC_FEATURE_BIT(20)
#define EC_FEATURE_SOBOL EC_FEATURE_BIT(21)
#define EC_FEATURE_TERMINATOR EC_FEATURE_BIT(22)
#define EC_FEATURE_CLEARCOAT EC_FEATURE_BIT(23)
#define EC_FEATURE_CLEARCOAT_TEXTURE EC_FEATURE_BIT(24)
#define EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE EC_FEATURE_BIT(25)
#define EC_FEATURE_SHEEN EC_FEATURE_BIT(26)
#define EC_FEATURE_SHEEN_TEXTURE EC_FEATURE_BIT(27)
#define EC_FEATURE_ANISOTROPY EC_FEATURE_BIT(28)
#define EC_FEATURE_ANISOTROPY_TEXTURE EC_FEATURE_BIT(29)
#define EC_FEATURE_IRIDESCENCE EC_FEATURE_BIT(30)
#define EC_FEATURE_IRIDESCENCE_TEXTURE EC_FEATURE_BIT(31)
#define EC_FEATURE_DIFFUSE_TRANSMISSION EC_FEATURE_BIT(32)
#define EC_FEATURE_DIFFUSE_TRANSMISSION_TEXTURE EC_FEATURE_BIT(33)
#define EC_FEATURE_DISPERSION EC_FEATURE_BIT(34)
#define EC_FEATURE_MULTISCATTER EC_FEATURE_BIT(35)
#define EC_FEATURE_UV EC_FEATURE_BIT(36)
#define EC_FEATURE_LAYERS EC_FEATURE_BIT(37)
#define EC_FEATURE_SCATTERING EC_FEATURE_BIT(38)
#define EC_FEATURE_FOG EC_FEATURE_BIT(39)
#define EC_FEATURE_LENS EC_FEATURE_BIT(40)
#define EC_FEATURE_PIXEL_FILTER EC_FEATURE_BIT(41)
#define EC_FEATURE_ENVIRONMENT_TURN EC_FEATURE_BIT(42)
#define EC_FEATURE_LIGHT_TREE EC_FEATURE_BIT(43)
#define EC_FEATURE_LAMP_PARTS EC_FEATURE_BIT(44)
#define EC_FEATURE_LIGHT_PATHS EC_FEATURE_BIT(45)
#define EC_FEATURE_GUIDING EC_FEATURE_BIT(46)
#define EC_FEATURE_LAMP_PAIRS EC_FEATURE_BIT(47)
#define EC_FEATURE_MOTION EC_FEATURE_BIT(49)
#define EC_FEATURE_INSTANCES EC_FEATURE_BIT(48)
#define EC_FEATURE_MATCHED EC_FEATURE_BIT(51)
#define EC_FEATURE_COPLANAR EC_FEATURE_BIT(50)
#define EC_FEATURE_PANES EC_FEATURE_BIT(52)
#define EC_FEATURE_NESTED EC_FEATURE_BIT(53)

/* X(NAME, text for `eclat info`) */
#define EC_FEATURES(X)                                                                             \
    X(EMISSION, "emission")                                                                        \
    X(AREA_LIGHTS, "area-lights")                                                                  \
    X(PUNCTUAL_LIGHTS, "punctual-lights")                                                          \
    X(ENVIRONMENT, "environment")                                                                  \
    X(ENVIRONMENT_MAP, "environment-map")                                                          \
    X(SPECULAR, "specular")                                                                        \
    X(SMOOTH_NORMALS, "smooth-normals")                                                            \
    X(VERTEX_COLORS, "vertex-colors")                                                              \
    X(BASE_COLOR_TEXTURE, "base-color-texture")                                                    \
    X(METALLIC_ROUGHNESS_TEXTURE, "metallic-roughness-texture")                                    \
    X(NORMAL_TEXTURE, "normal-texture")                                                            \
    X(EMISSION_TEXTURE, "emission-texture")                                                        \
    X(SPECULAR_TEXTURE, "specular-texture")                                                        \
    X(ALPHA, "alpha")                                                                              \
    X(CULLING, "back-face-culling")                                                                \
    X(UNLIT, "unlit")                                                                              \
    X(FLOAT_TEXTURE, "float-textures")                                                             \
    X(SMOOTH, "smooth-surfaces")                                                                   \
    X(TRANSMISSION, "transmission")                                                                \
    X(TRANSMISSION_TEXTURE, "transmission-texture")                                                \
    X(ABSORPTION, "absorption")                                                                    \
    X(SCATTERING, "volume-scattering")                                                             \
    X(FOG, "fog")                                                                                  \
    X(SOBOL, "sobol-sampler")                                                                      \
    X(TERMINATOR, "smooth-terminator")                                                             \
    X(CLEARCOAT, "clearcoat")                                                                      \
    X(CLEARCOAT_TEXTURE, "clearcoat-texture")                                                      \
    X(CLEARCOAT_NORMAL_TEXTURE, "clearcoat-normal-texture")                                        \
    X(SHEEN, "sheen")                                                                              \
    X(SHEEN_TEXTURE, "sheen-texture")                                                              \
    X(ANISOTROPY, "anisotropy")                                                                    \
    X(ANISOTROPY_TEXTURE, "anisotropy-texture")                                                    \
    X(IRIDESCENCE, "iridescence")                                                                  \
    X(IRIDESCENCE_TEXTURE, "iridescence-texture")                                                  \
    X(DIFFUSE_TRANSMISSION, "diffuse-transmission")                                                \
    X(DIFFUSE_TRANSMISSION_TEXTURE, "diffuse-transmission-texture")                                \
    X(DISPERSION, "dispersion")                                                                    \
    X(MULTISCATTER, "multiple-scattering")                                                         \
    X(UV, "texture-coordinates")                                                                   \
    X(LAYERS, "picture-layers")                                                                    \
    X(LENS, "depth-of-field")                                                                      \
    X(PIXEL_FILTER, "pixel-filter")                                                                \
    X(ENVIRONMENT_TURN, "environment-rotation")                                                    \
    X(LIGHT_TREE, "light-tree")                                                                    \
    X(LAMP_PARTS, "lamp-parts")                                                                    \
    X(LAMP_PAIRS, "lamp-pairs")                                                                    \
    X(LIGHT_PATHS, "light-paths")                                                                  \
    X(GUIDING, "path-guiding")                                                                     \
    X(MOTION, "motion-blur")                                                                       \
    X(INSTANCES, "instances")                                                                      \
    X(COPLANAR, "coplanar-faces")                                                                  \
    X(PANES, "transparent-shadows")                                                                \
    X(MATCHED, "transparent-bodies")                                                               \
    X(NESTED, "nested-bodies")

#define EC_FEATURE_OR_(name, text) | EC_FEATURE_##name
#define EC_FEATURE_SUM_(name, text) +EC_FEATURE_##name
#define EC_FEATURE_ALL (0 EC_FEATURES(EC_FEATURE_OR_))
EC_ASSERT(EC_FEATURE_ALL == 0 EC_FEATURES(EC_FEATURE_SUM_), ec_each_feature_has_its_own_bit);

/* Effects that read a texture or follow one's direction, and so need texels and texture coordinates. */
#define EC_FEATURE_OF_SLOT_(name, is_srgb, effect, textured, has, path) | EC_FEATURE_##textured
#define EC_FEATURES_TEXTURED (EC_FEATURE_ANISOTROPY EC_SLOTS(EC_FEATURE_OF_SLOT_))
/* Effects that bend normals; these and effects with a direction, which need tangents. */
#define EC_FEATURES_BENDING (EC_FEATURE_NORMAL_TEXTURE | EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE)
#define EC_FEATURES_TANGENTS (EC_FEATURES_BENDING | EC_FEATURE_ANISOTROPY)
/* Effects that need to know which body a ray is in. */
#define EC_FEATURES_MEDIUM (EC_FEATURE_ABSORPTION | EC_FEATURE_NESTED | EC_FEATURE_FOG)
/* Effects that trace paths from lights. */
#define EC_FEATURES_FROM_LIGHTS (EC_FEATURE_LIGHT_PATHS | EC_FEATURE_GUIDING)
#define EC_FEATURES_UV (EC_FEATURES_TEXTURED | EC_FEATURE_UV)
#define EC_FEATURES_ATTRIBUTES (EC_FEATURES_UV | EC_FEATURE_SMOOTH_NORMALS | EC_FEATURE_VERTEX_COLORS)

#ifdef EC_DEVICE_CODE
#ifndef FEATURES
#define FEATURES EC_FEATURE_ALL
#endif
#define HAS(name) ((FEATURES & EC_FEATURE_##name) != 0)
#define HAS_TEXTURES ((FEATURES & EC_FEATURES_TEXTURED) != 0)
#define HAS_UV ((FEATURES & EC_FEATURES_UV) != 0)
#define HAS_PASSING (HAS(TRANSMISSION) || HAS(DIFFUSE_TRANSMISSION))
#define HAS_BENDING ((FEATURES & EC_FEATURES_BENDING) != 0)
#define HAS_MEDIUM ((FEATURES & EC_FEATURES_MEDIUM) != 0)
/* Shadow rays carry their medium. */
#define HAS_SHADOW_MEDIUM (HAS(MATCHED) && HAS_MEDIUM)
#define HAS_FAR_AND_LAMPS ((HAS(ENVIRONMENT) || HAS(PUNCTUAL_LIGHTS)) && (HAS(AREA_LIGHTS) || HAS(PUNCTUAL_LIGHTS)))
#define HAS_ATTRIBUTES ((FEATURES & EC_FEATURES_ATTRIBUTES) != 0)
#endif

#endif
