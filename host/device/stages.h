/* The stage table: each stage's kernel, what it is built with, which arguments it takes in which order. */
#ifndef EC_DEVICE_STAGES_H
#define EC_DEVICE_STAGES_H

#include <stdint.h>

#include "cl/cl.h"
#include "device/options.h"
#include "device/stats.h"
#include "shared/accel.h"
#include "shared/features.h"

/* Arguments of kernels. The first ones are scalars that change from launch to launch. */
typedef enum ec_arg {
    EC_ARG_SEED,
    EC_ARG_FIRST_PIXEL,
    EC_ARG_BOUNCE,
    EC_ARG_STEP,
    EC_ARG_SORTS,      /* packets sort their rays (lib/sort_rays.h) */
    EC_ARG_PATH_COUNT,
    EC_ARG_PIXEL_COUNT,
    EC_ARG_TRIANGLE_COUNT,
    EC_ARG_LIGHT,
    EC_ARG_SCALAR_COUNT,
    EC_ARG_PARAMS = EC_ARG_SCALAR_COUNT,
    EC_ARG_PIXEL_LIST, /* of a pass over some of the pixels; else NULL */
    EC_ARG_EDGES,      /* which pixels lamps' edges go through, a bit each; NULL: none */
    EC_ARG_EDGE_LIST,  /* a wave's pixel list, with their rays to edges (device/lamp_edges.c) */
    EC_ARG_PIXEL_FILTER, /* NULL: a box */
    EC_ARG_COUNTERS,
    EC_ARG_INVALID,
    EC_ARG_PATHS,      /* the queue that is read … */
    EC_ARG_NEXT,       /* … and the one that is written: they change places every bounce */
    EC_ARG_HITS,
    EC_ARG_SHADOWS,
    EC_ARG_BRANCHES,
    EC_ARG_RADIANCE,
    EC_ARG_AOV,
    EC_ARG_BATCH_FILM,
    EC_ARG_FEATURE_FILM,
    EC_ARG_LAYER_FILM,
    EC_ARG_ACCEL,      /* the buffers of the accelerator that the launch goes through */
    EC_ARG_ACCEL_END = EC_ARG_ACCEL + EC_ACCEL_BUFFERS - 1,
    EC_ARG_RASTER_TRIS,
    EC_ARG_TILE_STARTS,
    EC_ARG_TILE_ENDS,
    EC_ARG_TILE_LIST,
    EC_ARG_PRIMS,
    EC_ARG_INDICES,
    EC_ARG_NORMALS,
    EC_ARG_TANGENTS,
    EC_ARG_UVS,
    EC_ARG_COLORS,
    EC_ARG_MATERIALS,
    EC_ARG_TEXTURE_TABLE,
    EC_ARG_TEXELS,
    EC_ARG_SRGB,
    EC_ARG_PLACES,
    EC_ARG_MOTION,
    EC_ARG_COPLANAR,   /* NULL: no faces lie on one another */
    EC_ARG_TIMES,      /* of paths, by slot */
    EC_ARG_CAMERA_KEYS, /* NULL: the camera stands still */
    EC_ARG_LIGHT_TABLE,
    EC_ARG_LIGHT_SHARES,
    EC_ARG_LIGHT_TREE,
    EC_ARG_LIGHT_TRAILS,
    EC_ARG_LAMP_PARTS,
    EC_ARG_EMISSION,
    EC_ARG_PARTS,      /* which triangles belong to which node (lib/features.h); NULL: not needed */
    EC_ARG_LIGHT_GROUPS, /* group of the environment, of each light, of each material; NULL: none */
    EC_ARG_LIGHT_SLOTS, /* light and point of each light path, by slot */
    EC_ARG_SPLATS,
    EC_ARG_GUIDE,      /* the guide's table; NULL: none */
    EC_ARG_PHOTONS,    /* what light paths meet, while the guide is made; else NULL */
    EC_ARG_ENVIRONMENT_TEXELS,
    EC_ARG_ENVIRONMENT_TABLE,
    EC_ARG_COUNT
} ec_arg;

typedef enum ec_stage_id {
    EC_GENERATE,
    EC_INTERSECT,
    EC_SHADE,
    EC_CONNECT,
    EC_EMIT,
    EC_SHADE_LIGHT,
    EC_SPLAT,
    EC_RASTER_SETUP,
    EC_RASTER_FILL,
    EC_RASTER,
    EC_SHADE_RASTER,
    EC_WHITTED,
    EC_WHITTED_LIGHT,
    EC_LAMP_EDGES,
    EC_ACCUMULATE,
    EC_STORE_FEATURES,
    EC_SLOT_LAYERS,
    EC_STAGE_ID_COUNT
} ec_stage_id;

#define EC_OF(integrator) (1u << EC_INTEGRATOR_##integrator)
#define EC_OF_PATHS (EC_OF(PATH) | EC_OF(LIGHT))
#define EC_OF_ALL UINT32_MAX

/* How many entries a work-item of a stage has: as many lanes as its program is built with, the pipeline's or the accelerator's; or one. */
#define EC_LANES_OF_PIPELINE 0
#define EC_LANES_OF_ACCEL UINT32_MAX

#define EC_STAGE_ARGUMENTS 40 /* at most */

typedef struct ec_stage_entry {
    const char *source;        /* kernels/stages/SOURCE.cl; its kernel is ec_SOURCE. With EC_LANES_OF_ACCEL there is one
                                  for each accelerator: ec_SOURCE_NAME in kernels/lib/traverse_NAME.h */
    const char *label;         /* for messages and profiles */
    uint32_t integrators;      /* EC_OF(x): those that launch it */
    uint32_t lanes;
    uint64_t calls_for;        /* an effect without which it is not launched; 0: always launched */
    uint64_t features;         /* those that can change its code; others do not multiply binaries */
    ec_arg busy;               /* argument that says how many of a launch have something to do: EC_ARG_COUNTERS for a queue (ec_pipeline_busy) */
    uint32_t argument_count;
    const ec_arg *arguments;
} ec_stage_entry;

/* Returns whether a render with that integrator and these effects has the stage. */
bool ec_stage_is_of(const ec_stage_entry *stage, ec_integrator integrator, uint64_t features);

extern const ec_stage_entry ec_stages[EC_STAGE_ID_COUNT];

typedef struct ec_traversal {
    const char *options; /* build options of an accelerator's kernels besides lanes and features; static text, "" for nothing */
    uint32_t lanes;      /* of its kernels */
    uint32_t takes;      /* rays that a work-item takes: a packet, a run, or one */
} ec_traversal;

/* Returns how a device traverses an accelerator. On processors a work-item traces 16 rays, one after the other, or in bvh8 64 by turns
 * (lib/trace_interleaved.h), where the accelerator's buffers, `bytes` in all, are larger than the device's cache. features: those that are built;
 * packet: rays of those accelerators that send packets. */
ec_traversal ec_traversal_of(const ec_device_info *device, uint32_t accel, uint64_t bytes, uint64_t features, uint32_t packet);

#define EC_LOCAL_SIZE 16 /* one fixed local size a kernel: PoCL compiles again for each new one */
#define EC_LOCAL_SIZE_OF_CARDS 64 /* cards' threads run in step by 32 or 64. On an H100 128 are as fast, 32 and 256 take 3 to 13 % longer */
uint32_t ec_local_size(const ec_device_info *device);

#endif
