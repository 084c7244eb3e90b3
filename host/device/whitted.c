/* Whitted's ray trees: one ray of each slot's tree at a time, and behind each hit one light at a time, so that a slot's sums come
 * in the same order always and memory is bounded by depth, not by the number of branches. */
#include <string.h>

#include "device/pipeline.h"

/* Returns how many of the counters are in use: each of a few lights has its shadow rays. */
static uint32_t used(const ec_pipeline *p) { return p->params.light_count < EC_SEGMENT ? p->params.light_count + 1 : EC_SEGMENT; }

/* Sends the counters to the device, with empty shadow queues. */
static ec_result clear_shadows(ec_pipeline *p, ec_error *err)
{
    for (uint32_t k = 0; k <= used(p); k++) memset(p->counters.at[k].shadows, 0, sizeof p->counters.at[k].shadows);
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_COUNTERS], 0, ec_counters_bytes(used(p)), &p->counters, err);
}

static ec_result read_counters(ec_pipeline *p, ec_error *err)
{
    EC_TRY(ec_buffer_read(p->cl, p->buffers[EC_ARG_COUNTERS], 0, ec_counters_bytes(used(p)), &p->counters, err));
    for (uint32_t k = 0; k < used(p); k++) {
        p->rays += ec_pipeline_total(p->counters.at[k].shadows);
        ec_pipeline_busy(p, EC_CONNECT, p->counters.at[k].shadows);
    }
    return EC_OK;
}

/* Shades by the lights in turn; after every EC_SEGMENT of them the shadow queues' counters are used up, and cleared. */
static ec_result shade_lights(ec_pipeline *p, uint32_t *scalars, ec_error *err)
{
    for (uint32_t k = 0; k < p->params.light_count; k++) {
        scalars[EC_ARG_LIGHT] = k;
        scalars[EC_ARG_STEP] = k % EC_SEGMENT;
        if (k && k % EC_SEGMENT == 0) {
            EC_TRY(read_counters(p, err));
            EC_TRY(clear_shadows(p, err));
        }
        ec_pipeline_busy(p, EC_WHITTED_LIGHT, p->counters.at[0].rays);
        EC_TRY(ec_pipeline_launch(p, EC_WHITTED_LIGHT, scalars, err));
        EC_TRY(ec_pipeline_trace(p, 1, scalars[EC_ARG_BOUNCE], scalars, err));
    }
    return EC_OK;
}

ec_result ec_integrate_whitted(ec_pipeline *p, uint32_t *scalars, ec_error *err)
{
    ec_counters *counters = &p->counters;
    ec_pipeline_fill_parts(p, scalars[EC_ARG_PATH_COUNT]);
    for (uint32_t step = 0; ec_pipeline_total(counters->at[0].rays); step++) {
        p->rays += ec_pipeline_total(counters->at[0].rays);
        ec_pipeline_busy(p, EC_INTERSECT, counters->at[0].rays);
        ec_pipeline_busy(p, EC_WHITTED, counters->at[0].rays);
        memset(counters->at[1].rays, 0, sizeof counters->at[1].rays);
        EC_TRY(clear_shadows(p, err));
        scalars[EC_ARG_BOUNCE] = step;
        scalars[EC_ARG_STEP] = 0;
        ec_pipeline_swap_queues(p, step);
        EC_TRY(ec_pipeline_trace(p, 0, step, scalars, err));
        EC_TRY(ec_pipeline_launch(p, EC_WHITTED, scalars, err));
        if (p->params.max_depth > 1) EC_TRY(shade_lights(p, scalars, err));
        EC_TRY(read_counters(p, err));
        memcpy(counters->at[0].rays, counters->at[1].rays, sizeof counters->at[0].rays);
    }
    return EC_OK;
}
