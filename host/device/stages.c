#include "device/stages.h"

#define ALPHA_FEATURES                                                                             \
    (EC_FEATURE_ALPHA | EC_FEATURE_BASE_COLOR_TEXTURE | EC_FEATURE_VERTEX_COLORS | EC_FEATURE_FLOAT_TEXTURE)

#define FILTER_ARGS                                                                                \
    EC_ARG_PRIMS, EC_ARG_INDICES, EC_ARG_UVS, EC_ARG_COLORS, EC_ARG_MATERIALS,         \
        EC_ARG_TEXTURE_TABLE, EC_ARG_TEXELS, EC_ARG_SRGB, EC_ARG_PLACES, EC_ARG_MOTION, EC_ARG_TIMES, EC_ARG_COPLANAR
#define ACCEL_ARGS EC_ARG_ACCEL, EC_ARG_ACCEL + 1, EC_ARG_ACCEL + 2, EC_ARG_ACCEL + 3, EC_ARG_ACCEL + 4
#define SURFACE_ARGS                                                                               \
    EC_ARG_PRIMS, EC_ARG_INDICES, EC_ARG_NORMALS, EC_ARG_TANGENTS, EC_ARG_UVS, EC_ARG_COLORS, EC_ARG_MATERIALS,        \
        EC_ARG_TEXTURE_TABLE, EC_ARG_TEXELS, EC_ARG_SRGB, EC_ARG_PLACES
#define WAVE_ARGS EC_ARG_PARAMS, EC_ARG_SEED, EC_ARG_FIRST_PIXEL, EC_ARG_PIXEL_LIST, EC_ARG_BOUNCE, EC_ARG_STEP, EC_ARG_COUNTERS

static const ec_arg generate[] = {EC_ARG_PARAMS,       EC_ARG_SEED,       EC_ARG_FIRST_PIXEL, EC_ARG_PIXEL_LIST,
                                  EC_ARG_PIXEL_FILTER, EC_ARG_PATH_COUNT, EC_ARG_PATHS,       EC_ARG_RADIANCE,
                                  EC_ARG_CAMERA_KEYS,  EC_ARG_MOTION,     EC_ARG_TIMES,       EC_ARG_EDGES};
static const ec_arg intersect[] = {WAVE_ARGS, EC_ARG_SORTS, EC_ARG_PATHS, EC_ARG_HITS, ACCEL_ARGS, FILTER_ARGS};
static const ec_arg shade[] = {WAVE_ARGS,
                               EC_ARG_INVALID,
                               EC_ARG_PATHS,
                               EC_ARG_HITS,
                               EC_ARG_NEXT,
                               EC_ARG_SHADOWS,
                               EC_ARG_RADIANCE,
                               EC_ARG_AOV,
                               SURFACE_ARGS,
                               EC_ARG_MOTION,
                               EC_ARG_TIMES,
                               EC_ARG_LIGHT_TABLE,
                               EC_ARG_LIGHT_SHARES,
                               EC_ARG_ENVIRONMENT_TEXELS,
                               EC_ARG_ENVIRONMENT_TABLE,
                               EC_ARG_LIGHT_TREE,
                               EC_ARG_LIGHT_TRAILS,
                               EC_ARG_LAMP_PARTS,
                               EC_ARG_EMISSION,
                               EC_ARG_GUIDE,
                               EC_ARG_LIGHT_GROUPS,
                               EC_ARG_PARTS,
                               EC_ARG_CAMERA_KEYS};
static const ec_arg connect[] = {WAVE_ARGS, EC_ARG_SORTS, EC_ARG_INVALID, EC_ARG_SHADOWS, EC_ARG_RADIANCE, ACCEL_ARGS, FILTER_ARGS,
                                 EC_ARG_NORMALS, EC_ARG_TANGENTS};
static const ec_arg emit[] = {EC_ARG_PARAMS,   EC_ARG_SEED,        EC_ARG_FIRST_PIXEL, EC_ARG_PATH_COUNT, EC_ARG_COUNTERS,    EC_ARG_INVALID,
                              EC_ARG_PATHS,    EC_ARG_RADIANCE,    EC_ARG_LIGHT_SLOTS, SURFACE_ARGS,      EC_ARG_MOTION,      EC_ARG_TIMES,
                              EC_ARG_LIGHT_TABLE, EC_ARG_ENVIRONMENT_TEXELS, EC_ARG_ENVIRONMENT_TABLE, EC_ARG_EMISSION, EC_ARG_COPLANAR};
static const ec_arg shade_light[] = {WAVE_ARGS, EC_ARG_INVALID, EC_ARG_PATHS, EC_ARG_HITS, EC_ARG_NEXT, EC_ARG_SHADOWS, EC_ARG_LIGHT_SLOTS,
                                     EC_ARG_PIXEL_FILTER, EC_ARG_CAMERA_KEYS, SURFACE_ARGS, EC_ARG_MOTION, EC_ARG_TIMES, EC_ARG_LIGHT_TABLE,
                                     EC_ARG_ENVIRONMENT_TEXELS, EC_ARG_ENVIRONMENT_TABLE, EC_ARG_LIGHT_TREE, EC_ARG_LAMP_PARTS, EC_ARG_EMISSION,
                                     EC_ARG_PHOTONS, EC_ARG_PATH_COUNT, EC_ARG_GUIDE};
static const ec_arg splat[] = {EC_ARG_PARAMS, EC_ARG_SEED, EC_ARG_FIRST_PIXEL, EC_ARG_BOUNCE, EC_ARG_PATH_COUNT, EC_ARG_RADIANCE,
                               EC_ARG_LIGHT_SLOTS, EC_ARG_SPLATS};
static const ec_arg raster_setup[] = {EC_ARG_PARAMS, EC_ARG_TRIANGLE_COUNT, EC_ARG_PRIMS, EC_ARG_RASTER_TRIS, EC_ARG_TILE_ENDS};
static const ec_arg raster_fill[] = {EC_ARG_PARAMS, EC_ARG_TRIANGLE_COUNT, EC_ARG_RASTER_TRIS, EC_ARG_TILE_ENDS, EC_ARG_TILE_LIST};
static const ec_arg raster[] = {EC_ARG_PARAMS,     EC_ARG_SEED,      EC_ARG_FIRST_PIXEL, EC_ARG_PIXEL_LIST,
                                EC_ARG_PATH_COUNT, EC_ARG_PATHS, EC_ARG_HITS,      EC_ARG_RASTER_TRIS, EC_ARG_TILE_STARTS,
                                EC_ARG_TILE_ENDS,  EC_ARG_TILE_LIST, FILTER_ARGS};
static const ec_arg shade_raster[] = {EC_ARG_PARAMS,      EC_ARG_PATH_COUNT,        EC_ARG_INVALID, EC_ARG_PATHS,
                                      EC_ARG_HITS,        EC_ARG_RADIANCE,          EC_ARG_AOV,     SURFACE_ARGS,
                                      EC_ARG_LIGHT_TABLE, EC_ARG_ENVIRONMENT_TEXELS, EC_ARG_PARTS};
static const ec_arg whitted[] = {WAVE_ARGS,       EC_ARG_INVALID,  EC_ARG_PATHS, EC_ARG_HITS,  EC_ARG_NEXT,
                                 EC_ARG_BRANCHES, EC_ARG_RADIANCE, EC_ARG_AOV,   SURFACE_ARGS, EC_ARG_ENVIRONMENT_TEXELS, EC_ARG_PARTS};
static const ec_arg whitted_light[] = {EC_ARG_PARAMS, EC_ARG_LIGHT, EC_ARG_STEP,    EC_ARG_COUNTERS, EC_ARG_INVALID,
                                       EC_ARG_PATHS,  EC_ARG_HITS,  EC_ARG_SHADOWS, SURFACE_ARGS,    EC_ARG_LIGHT_TABLE};
static const ec_arg lamp_edges[] = {EC_ARG_PARAMS, EC_ARG_PIXEL_LIST, EC_ARG_PATH_COUNT, EC_ARG_PIXEL_COUNT, EC_ARG_RADIANCE};
static const ec_arg accumulate[] = {EC_ARG_PARAMS,      EC_ARG_FIRST_PIXEL, EC_ARG_PIXEL_LIST,
                                    EC_ARG_PIXEL_COUNT, EC_ARG_RADIANCE,    EC_ARG_BATCH_FILM, EC_ARG_SPLATS};
static const ec_arg store_features[] = {EC_ARG_PARAMS,      EC_ARG_FIRST_PIXEL, EC_ARG_PIXEL_LIST,
                                        EC_ARG_PIXEL_COUNT, EC_ARG_AOV,         EC_ARG_FEATURE_FILM};

static const ec_arg slot_layers[] = {EC_ARG_PARAMS, EC_ARG_FIRST_PIXEL, EC_ARG_PIXEL_LIST, EC_ARG_PIXEL_COUNT, EC_ARG_RADIANCE, EC_ARG_LAYER_FILM};

#define COUNT(list) (sizeof(list) / sizeof *(list))
#define FITS(list) sizeof(struct { char any; _Static_assert(COUNT(list) <= EC_STAGE_ARGUMENTS, "EC_STAGE_ARGUMENTS"); })
#define ARGS(list) COUNT(list) + 0 * FITS(list), list

#define CAMERA_FEATURES (EC_FEATURE_LENS | EC_FEATURE_PIXEL_FILTER)
#define SHADING_FEATURES                                                                           \
    (EC_FEATURE_ALL & ~(EC_FEATURE_CULLING | EC_FEATURE_SOBOL | EC_FEATURE_TERMINATOR | EC_FEATURE_MULTISCATTER | \
                        EC_FEATURE_LAMP_PARTS | EC_FEATURE_LAMP_PAIRS | EC_FEATURE_PANES | EC_FEATURE_MATCHED | EC_FEATURE_MOTION | EC_FEATURE_SCATTERING | EC_FEATURE_FOG | \
                        EC_FEATURES_FROM_LIGHTS | EC_FEATURE_COPLANAR | CAMERA_FEATURES))
#define PATH_FEATURES                                                                              \
    (SHADING_FEATURES | EC_FEATURE_SOBOL | EC_FEATURE_TERMINATOR | EC_FEATURE_MULTISCATTER | EC_FEATURE_LAMP_PARTS | EC_FEATURE_LAMP_PAIRS | EC_FEATURE_PANES | \
     EC_FEATURE_MATCHED | EC_FEATURE_MOTION | EC_FEATURES_FROM_LIGHTS)
#define LIGHT_PATH_FEATURES (PATH_FEATURES | CAMERA_FEATURES)
/* Shadow rays look at surfaces where there are panes, else at no more than alpha: see ec_stage_features. */
#define SHADOW_FEATURES ((SHADING_FEATURES & ~EC_FEATURE_AREA_LIGHTS) | EC_FEATURE_PANES | EC_FEATURE_MATCHED | EC_FEATURE_FOG)

const ec_stage_entry ec_stages[EC_STAGE_ID_COUNT] = {
    [EC_GENERATE] = {"generate", "generate camera rays", EC_OF_ALL, EC_LANES_OF_PIPELINE, 0,
                     EC_FEATURE_SOBOL | EC_FEATURES_MEDIUM | EC_FEATURE_MOTION | EC_FEATURE_LIGHT_PATHS | EC_FEATURE_LAYERS | CAMERA_FEATURES,
                     EC_ARG_PATH_COUNT, ARGS(generate)},
    [EC_INTERSECT] = {"intersect", "intersect", EC_OF_PATHS | EC_OF(WHITTED), EC_LANES_OF_ACCEL, 0,
                      EC_FEATURE_CULLING | EC_FEATURE_INSTANCES | EC_FEATURE_MOTION | EC_FEATURE_COPLANAR | ALPHA_FEATURES,
                      EC_ARG_COUNTERS, ARGS(intersect)},
    [EC_SHADE] = {"shade", "shade", EC_OF_PATHS, EC_LANES_OF_PIPELINE, 0,
                  PATH_FEATURES | EC_FEATURE_SCATTERING | EC_FEATURE_FOG,
                  EC_ARG_COUNTERS, ARGS(shade)},
    [EC_CONNECT] = {"connect", "connect shadow rays", EC_OF_PATHS | EC_OF(WHITTED), EC_LANES_OF_ACCEL, 0,
                    EC_FEATURE_INSTANCES | EC_FEATURE_MOTION | EC_FEATURE_LIGHT_PATHS | EC_FEATURE_LAYERS | EC_FEATURE_CULLING | EC_FEATURE_COPLANAR | SHADOW_FEATURES,
                    EC_ARG_COUNTERS, ARGS(connect)},
    [EC_EMIT] = {"emit", "start light paths", EC_OF_PATHS, EC_LANES_OF_PIPELINE, EC_FEATURES_FROM_LIGHTS,
                 (LIGHT_PATH_FEATURES & ~(EC_FEATURE_PIXEL_FILTER | EC_FEATURE_LENS)) | EC_FEATURE_COPLANAR, EC_ARG_PATH_COUNT, ARGS(emit)},
    [EC_SHADE_LIGHT] = {"shade_light", "shade light paths", EC_OF_PATHS, EC_LANES_OF_PIPELINE, EC_FEATURES_FROM_LIGHTS,
                        LIGHT_PATH_FEATURES | EC_FEATURE_CULLING, EC_ARG_COUNTERS, ARGS(shade_light)},
    [EC_SPLAT] = {"splat", "add light paths' light to pixels", EC_OF_PATHS, EC_LANES_OF_PIPELINE, EC_FEATURE_LIGHT_PATHS, 0, EC_ARG_PATH_COUNT, ARGS(splat)},
    [EC_RASTER_SETUP] = {"raster_setup", "set up triangles", EC_OF(RASTER), 1, 0, 0, EC_ARG_TRIANGLE_COUNT, ARGS(raster_setup)},
    [EC_RASTER_FILL] = {"raster_fill", "fill tiles", EC_OF(RASTER), 1, 0, 0, EC_ARG_TRIANGLE_COUNT, ARGS(raster_fill)},
    [EC_RASTER] = {"raster", "rasterise", EC_OF(RASTER), EC_LANES_OF_PIPELINE, 0,
                   EC_FEATURE_SOBOL | EC_FEATURE_CULLING | EC_FEATURE_COPLANAR | ALPHA_FEATURES, EC_ARG_PATH_COUNT, ARGS(raster)},
    [EC_SHADE_RASTER] = {"shade_raster", "shade without visibility", EC_OF(RASTER), EC_LANES_OF_PIPELINE, 0,
                         SHADING_FEATURES, EC_ARG_PATH_COUNT, ARGS(shade_raster)},
    [EC_WHITTED] = {"whitted", "grow ray trees", EC_OF(WHITTED), EC_LANES_OF_PIPELINE, 0, SHADING_FEATURES, EC_ARG_COUNTERS, ARGS(whitted)},
    [EC_WHITTED_LIGHT] = {"whitted_light", "shade one light", EC_OF(WHITTED), EC_LANES_OF_PIPELINE, 0, SHADING_FEATURES | EC_FEATURE_MATCHED,
                          EC_ARG_COUNTERS, ARGS(whitted_light)},
    [EC_LAMP_EDGES] = {"lamp_edges", "add what is seen of lamps' edges", EC_OF_PATHS, 1, EC_FEATURE_EMISSION, EC_FEATURE_LAYERS, EC_ARG_PIXEL_COUNT, ARGS(lamp_edges)},
    [EC_ACCUMULATE] = {"accumulate", "accumulate", EC_OF_ALL, EC_LANES_OF_PIPELINE, 0, 0, EC_ARG_PIXEL_COUNT, ARGS(accumulate)},
    [EC_STORE_FEATURES] = {"features", "accumulate first-hit features", EC_OF_ALL, EC_LANES_OF_PIPELINE, 0, 0, EC_ARG_PIXEL_COUNT, ARGS(store_features)},
    [EC_SLOT_LAYERS] = {"slot_layers", "accumulate layers", EC_OF_ALL, EC_LANES_OF_PIPELINE, EC_FEATURE_LAYERS, 0, EC_ARG_PIXEL_COUNT, ARGS(slot_layers)},
};

bool ec_stage_is_of(const ec_stage_entry *stage, ec_integrator integrator, uint64_t features)
{
    return (stage->integrators >> integrator & 1) && (!stage->calls_for || (stage->calls_for & features));
}
