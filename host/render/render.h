/* Renders a scene on a device into a film. */
#ifndef EC_RENDER_RENDER_H
#define EC_RENDER_RENDER_H

#include "cl/cl.h"
#include "device/options.h"
#include "device/stats.h"
#include "film/film.h"
#include "scene/scene.h"

typedef struct ec_progress {
    double seconds, seconds_left;       /* seconds_left < 0: unknown */
    double fraction;                    /* 0..1 of the first limit that will end the render */
    uint64_t samples_per_pixel, samples; /* done */
    double samples_per_second;
    double error, error_bound;
    const ec_forecast *pilot;           /* the first one, once there is one; `forecast` is the present one */
    ec_forecast forecast;
} ec_progress;
/* Called after every batch and at least twice a second where waves allow; returning false stops cleanly: the film keeps
 * the batches that are complete, and where none is, what there is of the first. */
typedef bool (*ec_progress_fn)(void *user, const ec_progress *progress);

/* Renders a scene. film must be zero-initialised; the caller destroys it. cl stays the caller's. On failure too the film keeps the batches that were
 * complete, and stats describes them: film->batch_count says whether there is a picture. */
ec_result ec_render(ec_cl *cl, const ec_scene *scene, const ec_render_options *options, ec_progress_fn progress,
                    void *user, ec_film *film, ec_render_stats *stats, const ec_log *log, ec_error *err);

#endif
