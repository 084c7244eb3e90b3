#include "pipeline/stages.h"

#define ALPHA_FEATURES                                                                             \
    (EC_FEATURE_ALPHA | EC_FEATURE_BASE_COLOR_TEXTURE | EC_FEATURE_VERTEX_COLORS | EC_FEATURE_FLOAT_TEXTURE)

#define FILTER_ARGS                                                                                \
    EC_ARG_PRIMS, EC_ARG_INDICES, EC_ARG_UVS, EC_ARG_COLORS, EC_ARG_MATERIALS,         \
        EC_ARG_TEXTURE_TABLE, EC_ARG_TEXELS, EC_ARG_SRGB
#define WAVE_ARGS EC_ARG_PARAMS, EC_ARG_SEED, EC_ARG_FIRST_PIXEL, EC_ARG_BOUNCE, EC_ARG_STEP, EC_ARG_COUNTERS

static const ec_arg generate[] = {EC_ARG_PARAMS,     EC_ARG_SEED,  EC_ARG_FIRST_PIXEL,
                                  EC_ARG_PATH_COUNT, EC_ARG_PATHS, EC_ARG_RADIANCE};
static const ec_arg intersect_packet[] = {WAVE_ARGS, EC_ARG_PATHS, EC_ARG_HITS, EC_ARG_BVH2_NODES, EC_ARG_BVH2_TRIS, EC_ARG_BVH2_BOXES, FILTER_ARGS};
static const ec_arg intersect_bvh8[] = {WAVE_ARGS, EC_ARG_PATHS, EC_ARG_HITS, EC_ARG_BVH8_NODES, EC_ARG_BVH8_BLOCKS, EC_ARG_BVH8_BOXES, FILTER_ARGS};
static const ec_arg shade[] = {WAVE_ARGS,          EC_ARG_INVALID,     EC_ARG_PATHS,
                               EC_ARG_HITS,        EC_ARG_NEXT,        EC_ARG_SHADOWS,
                               EC_ARG_RADIANCE,    EC_ARG_AOV,         EC_ARG_PRIMS,
                               EC_ARG_INDICES,     EC_ARG_NORMALS,     EC_ARG_TANGENTS,
                               EC_ARG_UVS,         EC_ARG_COLORS,
                               EC_ARG_MATERIALS,   EC_ARG_TEXTURE_TABLE, EC_ARG_TEXELS,
                               EC_ARG_SRGB,        EC_ARG_LIGHT_TABLE, EC_ARG_LIGHT_ALIAS,
                               EC_ARG_ENVIRONMENT_TEXELS, EC_ARG_ENVIRONMENT_ALIAS};
static const ec_arg connect_packet[] = {WAVE_ARGS,         EC_ARG_INVALID,   EC_ARG_SHADOWS, EC_ARG_RADIANCE,
                                        EC_ARG_BVH2_NODES, EC_ARG_BVH2_TRIS, EC_ARG_BVH2_BOXES, FILTER_ARGS};
static const ec_arg connect_bvh8[] = {WAVE_ARGS,         EC_ARG_INVALID,     EC_ARG_SHADOWS, EC_ARG_RADIANCE,
                                      EC_ARG_BVH8_NODES, EC_ARG_BVH8_BLOCKS, EC_ARG_BVH8_BOXES, FILTER_ARGS};
static const ec_arg accumulate[] = {EC_ARG_PARAMS, EC_ARG_FIRST_PIXEL, EC_ARG_PIXEL_COUNT, EC_ARG_RADIANCE, EC_ARG_BATCH_FILM};
static const ec_arg store_features[] = {EC_ARG_PARAMS, EC_ARG_FIRST_PIXEL, EC_ARG_PIXEL_COUNT, EC_ARG_AOV, EC_ARG_FEATURE_FILM};

#define ARGS(list) sizeof(list) / sizeof *(list), list

const ec_stage_entry ec_stages[EC_STAGE_ID_COUNT] = {
    [EC_GENERATE] = {"generate", "generate camera rays", EC_LANES_OF_PIPELINE, EC_FEATURE_SOBOL, ARGS(generate)},
    [EC_INTERSECT_PACKET] = {"intersect_packet", "intersect (packets)", EC_LANES_OF_PIPELINE,
                             EC_FEATURE_CULLING | ALPHA_FEATURES, ARGS(intersect_packet)},
    [EC_INTERSECT_BVH8] = {"intersect_bvh8", "intersect (8-wide BVH)", 8, EC_FEATURE_CULLING | ALPHA_FEATURES,
                           ARGS(intersect_bvh8)},
    [EC_SHADE] = {"shade", "shade", EC_LANES_OF_PIPELINE, (uint32_t)EC_FEATURE_ALL & ~(uint32_t)(EC_FEATURE_ALPHA | EC_FEATURE_CULLING),
                  ARGS(shade)},
    [EC_CONNECT_PACKET] = {"connect_packet", "connect shadow rays (packets)", EC_LANES_OF_PIPELINE, ALPHA_FEATURES,
                           ARGS(connect_packet)},
    [EC_CONNECT_BVH8] = {"connect_bvh8", "connect shadow rays (8-wide BVH)", 8, ALPHA_FEATURES, ARGS(connect_bvh8)},
    [EC_ACCUMULATE] = {"accumulate", "accumulate", 1, 0, ARGS(accumulate)},
    [EC_STORE_FEATURES] = {"features", "accumulate first-hit features", 1, 0, ARGS(store_features)},
};
