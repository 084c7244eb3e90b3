#define _GNU_SOURCE /* vasprintf */
#include "commands/view_command.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs/combinations.h"
#include "jobs/command_line.h"
#include "report/names.h"

void ec_kept_options_add(ec_kept_options *kept, const char *option, const char *value)
{
    for (int k = 0; k < kept->count; k++)
        if (!strcmp(kept->row[k].option, option)) kept->row[k] = kept->row[--kept->count]; /* the last one counts */
    kept->row[kept->count].option = option;
    kept->row[kept->count++].value = value;
}

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

/* The camera that the window moved; or one of the scene's, the one that the options ask for as they ask for it. */
static void add_camera(words *w, uint32_t camera, const ec_view_shot *shot)
{
    const ec_viewpoint *v = &shot->viewpoint;
    if (!shot->moved && shot->options->camera == camera) return;
    if (!shot->moved) {
        add(w, "--camera=%u", shot->options->camera);
        return;
    }
    add_triple(w, "eye", v->eye);
    add_triple(w, "look-at", v->target);
    add_triple(w, "up", v->up);
    if (v->fov > 0) add(w, "--fov=%.9g", v->fov);
    else add(w, "--parallel=%.9g", v->tall);
}

static bool is_kept(uint32_t camera, const char *option, const char *value, const ec_view_shot *shot)
{
    ec_integrator integrator = shot->options->integrator;
    bool asked = !shot->moved && shot->options->camera == camera;
    if (!ec_combinations_belongs(option, integrator) || (!asked && ec_render_row(option)->uses & EC_OPTION_CAMERA)) return false;
    bool deep = !strcmp(option, "max-depth") && (!strcmp(value, "inf") || atoi(value) > EC_WHITTED_DEPTH_MOST);
    return !(integrator == EC_INTEGRATOR_WHITTED && deep);
}

char *ec_view_command(const ec_render_request *request, const ec_kept_options *kept, uint32_t camera, const ec_view_shot *shot,
                      const ec_outputs *outputs)
{
    words w = {.count = 0};
    const ec_render_options *o = shot->options;
    const bool is_still = request->choice.shutter && o->integrator != EC_INTEGRATOR_PATH; /* they show the exposure's middle */
    const uint64_t without = is_still ? o->without & ~EC_FEATURE_MOTION : o->without;
    add(&w, "eclat");
    add(&w, "render");
    add_file(&w, request->scene);
    for (int i = 0; i < kept->count; i++) {
        const char *option = kept->row[i].option, *value = kept->row[i].value;
        if (!is_kept(camera, option, value ? value : "", shot)) continue;
        if (value) add(&w, "--%s=%s", option, value);
        else add(&w, "--%s", option);
    }
    add(&w, "--size=%ux%u", o->width, o->height);
    add_camera(&w, camera, shot);
    if (o->integrator != EC_INTEGRATOR_PATH) add(&w, "--integrator=%s", ec_integrator_names[o->integrator]);
    if (is_still) add(&w, "--at=%.17g", 0.5 * (request->choice.opens + request->choice.closes));
    if (shot->env_degrees != 0) add(&w, "--env-rotate=%.9g", shot->env_degrees);
    for (uint32_t i = 0; i < ec_feature_count; i++)
        if (without & ec_features[i].bit) add(&w, "--without=%s", ec_features[i].name);
    add(&w, "--spp=%u", o->spp);
    if (o->replicates) add(&w, "--replicates=%u", o->replicates);
    if (shot->exposure != 0) add(&w, "--exposure=%.9g", shot->exposure);
    if (shot->tonemap != EC_TONEMAP_NEUTRAL) add(&w, "--tonemap=%s", ec_tonemap_names[shot->tonemap]);
    for (int i = 0; i < outputs->count; i++) {
        add(&w, "-o");
        add_file(&w, outputs->file[i].path);
    }
    char *line = w.incomplete ? NULL : ec_command_line(w.count, w.argv);
    while (w.count) free(w.argv[--w.count]);
    return line;
}
