/* Queues have parts, each filled by some of the threads. */
#include "device/pipeline.h"

uint64_t ec_pipeline_total(const uint32_t *parts)
{
    uint64_t sum = 0;
    for (int k = 0; k < EC_PARTS; k++) sum += parts[k * EC_PART_STRIDE];
    return sum;
}

void ec_pipeline_swap_queues(ec_pipeline *p, uint32_t bounce)
{
    p->buffers[EC_ARG_PATHS] = p->path_queues[bounce & 1];
    p->buffers[EC_ARG_NEXT] = p->path_queues[~bounce & 1];
}

void ec_pipeline_fill_parts(ec_pipeline *p, uint32_t paths)
{
    for (uint32_t k = 0; k < EC_PARTS; k++) {
        uint32_t before = k * p->params.part, left = paths > before ? paths - before : 0;
        p->counters.rays[0][k * EC_PART_STRIDE] = left < p->params.part ? left : p->params.part;
    }
}
