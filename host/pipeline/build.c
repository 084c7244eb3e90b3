/* The kernels a scene calls for, each built with the features that can change its code and no others. */
#include <stdio.h>
#include <string.h>

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
    if (id == EC_INTERSECT_PACKET || id == EC_CONNECT_PACKET) return p->has_trace[EC_TRACE_PACKET];
    if (id == EC_INTERSECT_BVH8 || id == EC_CONNECT_BVH8) return p->has_trace[EC_TRACE_BVH8];
    return true;
}

ec_result ec_pipeline_build(ec_pipeline *p, ec_error *err)
{
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++) {
        const ec_stage_entry *stage = &ec_stages[id];
        if (!is_needed(p, (ec_stage_id)id)) continue;
        char options[128], name[64];
        snprintf(options, sizeof options, "-DLANES=%u -DFEATURES=0x%xu",
                 stage->lanes == EC_LANES_OF_PIPELINE ? p->lanes : stage->lanes, canonical(stage, p->features));
        snprintf(name, sizeof name, "ec_%s", stage->source);
        EC_TRY(ec_program_build(p->cl, stage->source, ec_kernel_source(stage->source), options, &p->programs[id], err));
        EC_TRY(ec_kernel_create(p->programs[id], name, &p->kernels[id], err));
    }
    return EC_OK;
}
