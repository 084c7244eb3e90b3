/* The stage table: which kernel a stage is, what it is built with, which arguments it takes in which order. */
#ifndef EC_PIPELINE_STAGES_H
#define EC_PIPELINE_STAGES_H

#include <stdint.h>

#include "cl/cl.h"
#include "shared/features.h"

/* Everything a kernel can be handed. The first ones are scalars that change from launch to launch. */
typedef enum ec_arg {
    EC_ARG_SEED,
    EC_ARG_FIRST_PIXEL,
    EC_ARG_BOUNCE,
    EC_ARG_STEP,
    EC_ARG_PATH_COUNT,
    EC_ARG_PIXEL_COUNT,
    EC_ARG_SCALAR_COUNT,
    EC_ARG_PARAMS = EC_ARG_SCALAR_COUNT,
    EC_ARG_COUNTERS,
    EC_ARG_INVALID,
    EC_ARG_PATHS,      /* the queue that is read … */
    EC_ARG_NEXT,       /* … and the one that is written: they change places every bounce */
    EC_ARG_HITS,
    EC_ARG_SHADOWS,
    EC_ARG_RADIANCE,
    EC_ARG_AOV,
    EC_ARG_BATCH_FILM,
    EC_ARG_FEATURE_FILM,
    EC_ARG_BVH2_NODES,
    EC_ARG_BVH2_TRIS,
    EC_ARG_BVH2_BOXES,
    EC_ARG_BVH8_NODES,
    EC_ARG_BVH8_BLOCKS,
    EC_ARG_BVH8_BOXES,
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
    EC_ARG_LIGHT_TABLE,
    EC_ARG_LIGHT_ALIAS,
    EC_ARG_ENVIRONMENT_TEXELS,
    EC_ARG_ENVIRONMENT_ALIAS,
    EC_ARG_COUNT
} ec_arg;

typedef enum ec_stage_id {
    EC_GENERATE,
    EC_INTERSECT_PACKET,
    EC_INTERSECT_BVH8,
    EC_SHADE,
    EC_CONNECT_PACKET,
    EC_CONNECT_BVH8,
    EC_ACCUMULATE,
    EC_STORE_FEATURES,
    EC_STAGE_ID_COUNT
} ec_stage_id;

/* How many lanes a stage's program is built with: the pipeline's, or a fixed number. */
#define EC_LANES_OF_PIPELINE 0

typedef struct ec_stage_entry {
    const char *source;        /* kernels/stages/SOURCE.cl; its kernel is ec_SOURCE */
    const char *label;         /* for messages and profiles */
    uint32_t lanes;
    uint32_t features;         /* bits that can change its code; others do not multiply binaries */
    uint32_t argument_count;
    const ec_arg *arguments;
} ec_stage_entry;

extern const ec_stage_entry ec_stages[EC_STAGE_ID_COUNT];

#define EC_LOCAL_SIZE 16 /* one fixed local size a kernel: PoCL compiles again for each new one */

#endif
