/* The first look at the picture's paths: render_state.h. */
#include "base/clock.h"
#include "rare/paths.h"
#include "render/render_state.h"

/* Predicts on the first device that is loaded, or on another one if it fails, which is left out then. */
static ec_result predict(ec_render_state *r, ec_error *err)
{
    const uint32_t count = r->sources.count;
    for (uint32_t i = 0; i < 2 * count; i++) { /* those that are loaded already, then the others */
        ec_error why = {0};
        ec_pipeline *p = ec_sources_pipeline(&r->sources, i % count, i >= count);
        if (!p) continue;
        if (ec_rare_paths_predict(&r->lights, p, &r->rare, &r->joined, &why) == EC_OK) return EC_OK;
        if (!r->sources.team) {
            if (err) *err = why;
            return EC_FAILED;
        }
        ec_team_leave_out(r->sources.team, i % count, &why);
    }
    return EC_OK;
}

ec_result ec_render_predict(ec_render_state *r, ec_error *err)
{
    const double start = ec_now(), cpu_start = ec_cpu_now();
    if (r->is_predicted) return EC_OK;
    EC_TRY(predict(r, err));
    ec_rare_lights_free(&r->lights);
    r->is_predicted = true;
    r->render_start += ec_now() - start;
    r->look_cpu_seconds += ec_cpu_now() - cpu_start;
    r->cpu_start += ec_cpu_now() - cpu_start;
    return EC_OK;
}
