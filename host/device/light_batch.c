#include "device/light_batch.h"

#include <math.h>

#include "device/tiers.h"
#include "shared/params.h"

float ec_light_paths_a_pixel(double asked, uint32_t width, uint32_t height)
{
    const double pixels = (double)width * height;
    return (float)(fmax(floor(asked * pixels + 0.5), 1) / pixels);
}

ec_result ec_light_batch_run(ec_pipeline *p, uint32_t seed, ec_light_go_on *go_on, void *user, bool *complete, ec_error *err)
{
    const ec_params *params = &p->params;
    const uint32_t paths = (uint32_t)((double)params->light_paths * params->width * params->height + 0.5);
    *complete = true;
    if (!paths) return EC_OK;
    EC_TRY(ec_buffer_zero(p->cl, p->buffers[EC_ARG_SPLATS], 0, (uint64_t)params->width * params->film_rows * 4 * EC_SPLAT_WORDS, err));
    for (uint32_t first = 0, count; *complete && first < paths; first += count) {
        EC_TRY(ec_tiers_step(p, err));
        count = p->wave / params->batch;
        if (count > paths - first) count = paths - first;
        EC_TRY(ec_pipeline_run_light_wave(p, seed, first, count, err));
        *complete = !go_on || go_on(user);
    }
    return EC_OK;
}
