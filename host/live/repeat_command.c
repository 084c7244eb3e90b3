/* Makes the `eclat render` command that makes a picture again, bit for bit. */
#include <stdlib.h>
#include <string.h>

#include "film/denoiser.h"
#include "jobs/given.h"
#include "jobs/render_request.h"
#include "live/shared.h"
#include "report/names.h"

static void add_triple(ec_words *w, const char *option, const double xyz[3])
{
    ec_words_add(w, "--%s=%.9g,%.9g,%.9g", option, xyz[0], xyz[1], xyz[2]);
}

/* Adds the camera that was moved, or the chosen one of the scene; nothing if it is the one that the options ask for. */
static void add_camera(ec_words *w, bool is_asked, const eclat_view_request *view, const ec_render_options *o)
{
    const eclat_viewpoint *v = &view->viewpoint;
    if (is_asked) return;
    if (!view->is_moved) {
        ec_words_add(w, "--camera=%u", o->camera);
        return;
    }
    add_triple(w, "eye", v->eye);
    add_triple(w, "look-at", v->target);
    add_triple(w, "up", v->up);
    if (v->fov > 0) ec_words_add(w, "--fov=%.9g", v->fov);
    else ec_words_add(w, "--parallel=%.9g", v->tall);
}

/* Tells whether an option of `render` is kept as given: it must be the last of its name, matter for the picture, and not be replaced by the view. */
static bool is_kept(const ec_given_options *given, int i, bool is_asked, ec_integrator integrator)
{
    const char *option = given->list[i].option, *value = given->list[i].value ? given->list[i].value : "";
    const uint32_t uses = ec_render_row(option)->uses;
    bool is_last = true, is_deep = !strcmp(option, "max-depth") && (!strcmp(value, "inf") || atoi(value) > EC_WHITTED_DEPTH_MOST);
    for (int k = i + 1; k < given->count; k++) is_last &= strcmp(given->list[k].option, option) != 0;
    if (!is_last || uses & EC_OPTION_WINDOW || !strcmp(option, "light-paths") || !ec_combinations_belongs(option, integrator)) return false;
    return (is_asked || !(uses & EC_OPTION_CAMERA)) && !(integrator == EC_INTEGRATOR_WHITTED && is_deep);
}

static void add_kept(ec_words *w, const ec_given_options *given, bool is_asked, ec_integrator integrator)
{
    for (int i = 0; i < given->count; i++) {
        const char *option = given->list[i].option, *value = given->list[i].value;
        if (!is_kept(given, i, is_asked, integrator)) continue;
        if (value) ec_words_add(w, "--%s=%s", option, value);
        else ec_words_add(w, "--%s", option);
    }
}

char *ec_live_command(const ec_live *live, const ec_live_scene *scene, const eclat_view_request *view, const ec_render_options *o,
                      const ec_outputs *outputs)
{
    ec_words w = {0};
    const ec_render_request *request = &live->request;
    const bool is_asked = !view->is_moved && o->camera == scene->request.options.camera;
    const bool is_still = request->choice.shutter && !ec_traces_paths(o->integrator); /* these show the middle of the exposure */
    const uint64_t without = is_still ? o->without & ~EC_FEATURE_MOTION : o->without;
    ec_words_add(&w, "eclat");
    ec_words_add(&w, "render");
    ec_words_add_file(&w, request->scene);
    add_kept(&w, &live->given, is_asked, o->integrator);
    ec_words_add(&w, "--size=%ux%u", o->width, o->height);
    add_camera(&w, is_asked, view, o);
    if (o->integrator != EC_INTEGRATOR_PATH) ec_words_add(&w, "--integrator=%s", ec_integrator_names[o->integrator]);
    if (o->integrator == EC_INTEGRATOR_PATH && ec_scene_casts(scene->job.scene)) ec_words_add(&w, "--light-paths=%.9g", o->light_paths);
    if (is_still) ec_words_add(&w, "--at=%.17g", 0.5 * (request->choice.opens + request->choice.closes));
    if (view->env_degrees != 0) ec_words_add(&w, "--env-rotate=%.9g", view->env_degrees);
    for (uint32_t i = 0; i < ec_feature_count; i++)
        if (without & ec_features[i].bit) ec_words_add(&w, "--without=%s", ec_features[i].name);
    if (o->denoise == EC_DENOISER_AUTO) ec_words_add(&w, "--denoise");
    else if (o->denoise) ec_words_add(&w, "--denoise=%s", ec_denoiser_names[o->denoise]);
    ec_words_add(&w, "--spp=%u", o->spp);
    if (o->replicates) ec_words_add(&w, "--replicates=%u", o->replicates);
    if (view->exposure != 0) ec_words_add(&w, "--exposure=%.9g", view->exposure);
    if (view->tonemap != ECLAT_TONEMAP_NEUTRAL) ec_words_add(&w, "--tonemap=%s", ec_tonemap_names[view->tonemap]);
    for (int i = 0; i < outputs->count; i++) {
        ec_words_add(&w, "-o");
        ec_words_add_file(&w, outputs->file[i].path);
    }
    char *line = w.is_short ? NULL : ec_command_line(w.count, w.list);
    ec_words_free(&w);
    return line;
}
