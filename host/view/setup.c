/* Sessions and the scenes they are of. */
#include <stdlib.h>

#include "view/shared.h"

/* On a processor a wave of this many paths takes some 20 ms a core: short enough for pictures that follow the hand. */
#define WAVE_ON_CPU (1u << 16)

void ec_view_scene_release(ec_view *view, ec_view_scene *scene)
{
    if (!scene) return;
    pthread_mutex_lock(&view->lock);
    bool last = --scene->users == 0;
    pthread_mutex_unlock(&view->lock);
    if (!last) return;
    ec_scene_free(scene->scene);
    free(scene->cameras);
    free(scene);
}

/* What belongs to another integrator is as that command line has it which does not name it. */
static void drop_foreign(ec_render_options *o)
{
    if (o->integrator != EC_INTEGRATOR_PATH) {
        o->sample = EC_SAMPLE_MIS;
        o->light_choice = EC_LIGHTS_AUTO;
        o->terminator = EC_TERMINATOR_GEOMETRIC;
        o->survival = 0;
    }
    if (o->integrator == EC_INTEGRATOR_RASTER) {
        o->fstop = o->focus = 0;
        o->filter = EC_FILTER_BOX;
        o->filter_width = 0;
    }
    if (o->integrator == EC_INTEGRATOR_WHITTED && (!o->max_depth || o->max_depth > EC_WHITTED_DEPTH_MOST))
        o->max_depth = EC_WHITTED_DEPTH;
}

ec_result ec_view_setup_make(ec_view *view, ec_view_scene *scene, ec_integrator integrator, uint64_t without, ec_view_setup **made,
                             ec_error *err)
{
    ec_view_setup *s = calloc(1, sizeof *s);
    if (!s) return ec_fail(err, "out of memory for a pipeline");
    *made = s;
    s->options = view->request->options;
    s->options.camera = scene->options.camera;
    s->options.integrator = integrator;
    s->without = without;
    s->options.without = without & scene->optional;
    drop_foreign(&s->options);
    if (integrator != EC_INTEGRATOR_PATH && scene->scene->motion.segments) s->options.without |= EC_FEATURE_MOTION; /* the moment in the middle */
    if (scene->scene->environment.rgb) s->options.more_effects |= EC_FEATURE_ENVIRONMENT_TURN;
    pthread_mutex_lock(&view->lock);
    s->scene = scene;
    scene->users++;
    bool has_window = view->wish.width > 0;
    s->options.width = has_window ? view->wish.width : scene->options.width;
    s->options.height = has_window ? view->wish.height : scene->options.height;
    pthread_mutex_unlock(&view->lock);
    ec_result result = ec_cl_open(&view->request->device, &s->cl, err);
    if (result == EC_OK && !s->options.wave && (s->cl.info.type & CL_DEVICE_TYPE_CPU)) s->options.wave = WAVE_ON_CPU;
    if (result == EC_OK) result = ec_session_open(&s->cl, scene->scene, &s->options, EC_BATCH_MOST, &s->session, &s->stats, err);
    if (result == EC_OK) return EC_OK;
    ec_view_setup_free(view, s);
    *made = NULL;
    return result;
}

void ec_view_setup_free(ec_view *view, ec_view_setup *s)
{
    if (!s) return;
    ec_session_close(s->session);
    if (s->cl.context) ec_cl_close(&s->cl);
    ec_view_scene_release(view, s->scene);
    free(s);
}
