/* The `eclat render` that makes a picture again, bit for bit. */
#define _GNU_SOURCE /* vasprintf */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs/render_request.h"
#include "jobs/given.h"
#include "live/shared.h"
#include "report/names.h"

typedef struct words {
    char *argv[4 * EC_OPTIONS_MAX + 4 * EC_OUTPUTS_MAX + 64]; /* owned */
    int count;
    bool incomplete;
} words;

__attribute__((format(printf, 2, 3))) static void add(words *w, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    bool fits = w->count < (int)(sizeof w->argv / sizeof w->argv[0]) && vasprintf(&w->argv[w->count], format, args) >= 0;
    va_end(args);
    w->count += fits;
    w->incomplete |= !fits;
}

/* A name that no option is taken for. */
static void add_file(words *w, const char *path)
{
    add(w, "%s%s", *path == '-' ? "./" : "", path);
}

static void add_triple(words *w, const char *option, const double xyz[3])
{
    add(w, "--%s=%.9g,%.9g,%.9g", option, xyz[0], xyz[1], xyz[2]);
}

/* The camera that was moved; or one of the scene's, the one that the options ask for as they ask for it. */
static void add_camera(words *w, bool is_asked, const eclat_wish *wish, const ec_render_options *o)
{
    const eclat_viewpoint *v = &wish->viewpoint;
    if (is_asked) return;
    if (!wish->is_moved) {
        add(w, "--camera=%u", o->camera);
        return;
    }
    add_triple(w, "eye", v->eye);
    add_triple(w, "look-at", v->target);
    add_triple(w, "up", v->up);
    if (v->fov > 0) add(w, "--fov=%.9g", v->fov);
    else add(w, "--parallel=%.9g", v->tall);
}

/* Options of `render` as they were given: the last one counts, where the picture depends on it and no wish says it anew. */
static bool is_kept(const ec_given_options *given, int i, bool is_asked, ec_integrator integrator)
{
    const char *option = given->list[i].option, *value = given->list[i].value ? given->list[i].value : "";
    const uint32_t uses = ec_render_row(option)->uses;
    bool is_last = true, is_deep = !strcmp(option, "max-depth") && (!strcmp(value, "inf") || atoi(value) > EC_WHITTED_DEPTH_MOST);
    for (int k = i + 1; k < given->count; k++) is_last &= strcmp(given->list[k].option, option) != 0;
    if (!is_last || uses & EC_OPTION_WINDOW || !ec_combinations_belongs(option, integrator)) return false;
    return (is_asked || !(uses & EC_OPTION_CAMERA)) && !(integrator == EC_INTEGRATOR_WHITTED && is_deep);
}

static void add_kept(words *w, const ec_given_options *given, bool is_asked, ec_integrator integrator)
{
    for (int i = 0; i < given->count; i++) {
        const char *option = given->list[i].option, *value = given->list[i].value;
        if (!is_kept(given, i, is_asked, integrator)) continue;
        if (value) add(w, "--%s=%s", option, value);
        else add(w, "--%s", option);
    }
}

char *ec_live_command(const ec_live *live, const ec_live_scene *scene, const eclat_wish *wish, const ec_render_options *o,
                      const ec_outputs *outputs)
{
    words w = {.count = 0};
    const ec_render_request *request = &live->request;
    const bool is_asked = !wish->is_moved && o->camera == scene->request.options.camera;
    const bool is_still = request->choice.shutter && o->integrator != EC_INTEGRATOR_PATH; /* they show the exposure's middle */
    const uint64_t without = is_still ? o->without & ~EC_FEATURE_MOTION : o->without;
    add(&w, "eclat");
    add(&w, "render");
    add_file(&w, request->scene);
    add_kept(&w, &live->given, is_asked, o->integrator);
    add(&w, "--size=%ux%u", o->width, o->height);
    add_camera(&w, is_asked, wish, o);
    if (o->integrator != EC_INTEGRATOR_PATH) add(&w, "--integrator=%s", ec_integrator_names[o->integrator]);
    if (is_still) add(&w, "--at=%.17g", 0.5 * (request->choice.opens + request->choice.closes));
    if (wish->env_degrees != 0) add(&w, "--env-rotate=%.9g", wish->env_degrees);
    for (uint32_t i = 0; i < ec_feature_count; i++)
        if (without & ec_features[i].bit) add(&w, "--without=%s", ec_features[i].name);
    add(&w, "--spp=%u", o->spp);
    if (o->replicates) add(&w, "--replicates=%u", o->replicates);
    if (wish->exposure != 0) add(&w, "--exposure=%.9g", wish->exposure);
    if (wish->tonemap != ECLAT_TONEMAP_NEUTRAL) add(&w, "--tonemap=%s", ec_tonemap_names[wish->tonemap]);
    for (int i = 0; i < outputs->count; i++) {
        add(&w, "-o");
        add_file(&w, outputs->file[i].path);
    }
    char *line = w.incomplete ? NULL : ec_command_line(w.count, w.argv);
    while (w.count) free(w.argv[--w.count]);
    return line;
}
