/* The kernels a scene calls for, each built with the features that can change its code and no others. */
#include <stdio.h>
#include <stdlib.h>

#include "pipeline/pipeline.h"

void ec_feature_names(uint32_t features, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
#define ADD_NAME(bit, name, words)                                                                 \
    if ((features & (1u << (bit))) && used < size)                                                 \
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "", words);
    EC_FEATURES(ADD_NAME)
#undef ADD_NAME
}

/* Alpha decides by base colour; without it the traversal does not look at colour at all. */
static uint32_t canonical(const ec_stage_entry *stage, uint32_t features)
{
    uint32_t f = features & stage->features;
    const uint32_t of_alpha = EC_FEATURE_BASE_COLOR_TEXTURE | EC_FEATURE_VERTEX_COLORS | EC_FEATURE_FLOAT_TEXTURE;
    if ((stage->features & EC_FEATURE_ALPHA) && !(f & EC_FEATURE_ALPHA)) f &= ~of_alpha;
    return f;
}

static bool is_needed(const ec_pipeline *p, ec_stage_id id)
{
    bool is_raster_stage = id >= EC_RASTER_SETUP && id <= EC_SHADE_RASTER;
    if (p->integrator == EC_INTEGRATOR_RASTER) return is_raster_stage || id == EC_GENERATE || id >= EC_ACCUMULATE;
    if (is_raster_stage) return false;
    if (id == EC_INTERSECT_PACKET || id == EC_CONNECT_PACKET) return p->has_trace[EC_TRACE_PACKET];
    if (id == EC_INTERSECT_BVH8 || id == EC_CONNECT_BVH8) return p->has_trace[EC_TRACE_BVH8];
    return true;
}

static uint32_t lanes_of(const ec_pipeline *p, const ec_stage_entry *stage)
{
    return stage->lanes == EC_LANES_OF_PIPELINE ? p->lanes : stage->lanes;
}

/* One program for all stages of a lane width: each parse of the shared headers costs as much as compiling a stage. */
static ec_result build_width(ec_pipeline *p, uint32_t lanes, cl_program *program, ec_error *err)
{
    const char *names[EC_STAGE_ID_COUNT + 1] = {NULL};
    uint32_t features = 0, count = 0;
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++) {
        if (!is_needed(p, (ec_stage_id)id) || lanes_of(p, &ec_stages[id]) != lanes) continue;
        names[count++] = ec_stages[id].source;
        features |= canonical(&ec_stages[id], p->features);
    }
    char options[64], label[32], *source;
    snprintf(options, sizeof options, "-DLANES=%u -DFEATURES=0x%xu", lanes, features);
    snprintf(label, sizeof label, "lanes%u", lanes);
    EC_TRY(ec_kernel_sources_join(names, &source, err));
    ec_result result = ec_program_build(p->cl, label, source, options, program, err);
    free(source);
    return result;
}

ec_result ec_pipeline_build(ec_pipeline *p, ec_error *err)
{
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++) {
        if (!is_needed(p, (ec_stage_id)id)) continue;
        uint32_t lanes = lanes_of(p, &ec_stages[id]);
        cl_program *program = &p->programs[lanes];
        if (!*program) EC_TRY(build_width(p, lanes, program, err));
        char name[64];
        snprintf(name, sizeof name, "ec_%s", ec_stages[id].source);
        EC_TRY(ec_kernel_create(*program, name, &p->kernels[id], err));
    }
    return EC_OK;
}
