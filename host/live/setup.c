/* Makes and frees sessions, and the scenes that they show. */
#include <stdlib.h>

#include "live/shared.h"

/* Paths of a wave on a processor, some 20 ms per core: short enough to follow the mouse. */
#define WAVE_ON_CPU (1u << 16)

void ec_live_scene_release(ec_live *live, ec_live_scene *scene)
{
    if (!scene) return;
    pthread_mutex_lock(&live->lock);
    bool last = --scene->users == 0;
    pthread_mutex_unlock(&live->lock);
    if (!last) return;
    ec_render_job_free(&scene->job);
    free(scene->cameras);
    free(scene);
}

/* Resets options that do not belong to the integrator, as if they had not been given. */
static void drop_foreign(ec_render_options *o)
{
    if (o->integrator != EC_INTEGRATOR_PATH) {
        o->sample = EC_SAMPLE_MIS;
        o->light_choice = EC_LIGHTS_AUTO;
        o->terminator = EC_TERMINATOR_GEOMETRIC;
        o->guiding = false;
        o->light_paths = 0;
    }
    if (!ec_traces_paths(o->integrator)) o->survival = 0;
    if (o->integrator == EC_INTEGRATOR_LIGHT) o->light_paths = EC_LIGHT_PATHS_ALONE, o->clamp = 0;
    if (o->integrator == EC_INTEGRATOR_RASTER) {
        o->fstop = o->focus = 0;
        o->filter = EC_FILTER_BOX;
        o->filter_width = 0;
    }
    if (o->integrator == EC_INTEGRATOR_WHITTED && (!o->max_depth || o->max_depth > EC_WHITTED_DEPTH_MOST))
        o->max_depth = EC_WHITTED_DEPTH;
}

ec_result ec_live_setup_make(ec_live *live, ec_live_scene *scene, ec_integrator integrator, uint64_t without, ec_live_setup **made, ec_error *err)
{
    const ec_scene *contents = scene->job.scene;
    ec_live_setup *s = calloc(1, sizeof *s);
    if (!s) return ec_fail(err, "out of memory for a pipeline");
    *made = s;
    s->options = scene->request.options;
    /* A session takes no first look, which would decide on automatic light paths. */
    if (s->options.integrator == EC_INTEGRATOR_LIGHT || s->options.light_paths == EC_LIGHT_PATHS_AUTO) s->options.light_paths = 0;
    s->options.integrator = integrator;
    s->without = without;
    s->options.without = without & scene->optional;
    drop_foreign(&s->options);
    if (!ec_traces_paths(integrator) && contents->motion.segments) s->options.without |= EC_FEATURE_MOTION; /* shows the middle of the exposure */
    if (contents->environment.rgb) s->options.more_effects |= EC_FEATURE_ENVIRONMENT_TURN;
    pthread_mutex_lock(&live->lock);
    s->scene = scene;
    scene->users++;
    const eclat_view_request *view = &live->asked.view;
    if (view->width) s->options.width = view->width, s->options.height = view->height;
    pthread_mutex_unlock(&live->lock);
    ec_result result = ec_cl_open(&live->device, &s->cl, err);
    if (result == EC_OK && !s->options.wave && (s->cl.info.type & CL_DEVICE_TYPE_CPU)) s->options.wave = WAVE_ON_CPU;
    if (result == EC_OK) result = ec_session_open(&s->cl, contents, &s->options, EC_BATCH_MOST, &s->session, &s->stats, err);
    if (result == EC_OK) return EC_OK;
    ec_live_setup_free(live, s);
    *made = NULL;
    return result;
}

void ec_live_setup_free(ec_live *live, ec_live_setup *s)
{
    if (!s) return;
    ec_session_close(s->session);
    if (s->cl.context) ec_cl_close(&s->cl);
    ec_live_scene_release(live, s->scene);
    free(s);
}
