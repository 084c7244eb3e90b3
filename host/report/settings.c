#include "report/settings.h"

#include <inttypes.h>
#include <stdio.h>

#include "film/denoiser.h"
#include "report/format.h"
#include "report/names.h"

#define GET(name, ...) static void get_##name(const ec_render_options *o, ec_setting_value *v) { *v = (ec_setting_value){__VA_ARGS__}; }
#define TEXT(value) .field = EC_STRING(NULL, value)
#define WHOLE(value) .field = EC_WHOLE(NULL, value)
#define REAL(value) .field = EC_REAL(NULL, value)
#define NONE(value) .field = {.kind = EC_FIELD_NONE, .text = value} /* not a number, e.g. an endless depth: shown as text, null in JSON */

GET(background, TEXT(o->hides_environment ? "hidden" : "env"), .is_unsaid = !o->hides_environment)
GET(adaptive, .field = EC_FLAG(NULL, o->adaptive))
GET(guiding, .field = EC_FLAG(NULL, o->guiding), .is_unsaid = !o->guiding)
GET(denoise, TEXT(ec_denoiser_names[o->denoise]), .is_unsaid = !o->denoise)
GET(filter_width, REAL(o->filter_width > 0 ? o->filter_width : EC_FILTER_WIDTH), .is_unsaid = !(o->filter_width > 0))
GET(fstop, REAL(o->fstop), .is_unsaid = !(o->fstop > 0))
GET(focus, REAL(o->focus), .is_unsaid = !(o->fstop > 0))
GET(cutoff, REAL(o->cutoff), .is_idle = o->integrator != EC_INTEGRATOR_WHITTED)
GET(replicates, WHOLE(ec_render_replicates(o)))
GET(seed, WHOLE(o->seed))
GET(integrator, TEXT(ec_integrator_names[o->integrator]))
GET(sampler, TEXT(ec_sampler_names[o->sampler]))
GET(sample, TEXT(ec_sample_names[o->sample]))
GET(terminator, TEXT(ec_terminator_names[o->terminator]))
GET(scattering, TEXT(ec_scattering_names[o->scattering]))
GET(light_choice, TEXT(ec_light_choice_names[o->light_choice]))
GET(filter, TEXT(ec_filter_names[o->filter]))
GET(accel, TEXT(o->accel ? o->accel : "auto"))

static void get_size(const ec_render_options *o, ec_setting_value *v)
{
    snprintf(v->made, sizeof v->made, "%ux%u", o->width, o->height);
    v->field.text = v->made;
}

static void get_screen_window(const ec_render_options *o, ec_setting_value *v)
{
    const double *w = o->screen_window;
    if (ec_has_screen_window(o)) snprintf(v->made, sizeof v->made, "%.9g,%.9g,%.9g,%.9g", w[0], w[1], w[2], w[3]);
    else snprintf(v->made, sizeof v->made, "whole"), v->is_unsaid = true;
    v->field.text = v->made;
}

static void get_fog(const ec_render_options *o, ec_setting_value *v)
{
    snprintf(v->made, sizeof v->made, "%.9g,%.9g,%.9g", o->fog[0], o->fog[1], o->fog[2]);
    v->field.text = o->fog[0] > 0 ? v->made : "none";
    v->is_unsaid = !(o->fog[0] > 0);
}

static void get_max_depth(const ec_render_options *o, ec_setting_value *v)
{
    *v = o->max_depth ? (ec_setting_value){WHOLE(o->max_depth)} : (ec_setting_value){NONE("inf")};
}

static void get_rr(const ec_render_options *o, ec_setting_value *v)
{
    snprintf(v->made, sizeof v->made, "%s", ec_roulette(o->survival).text);
    v->field.text = v->made;
}

static void get_clamp(const ec_render_options *o, ec_setting_value *v)
{
    *v = o->clamp > 0 ? (ec_setting_value){REAL(o->clamp)} : (ec_setting_value){NONE("off")};
}

static void get_light_paths(const ec_render_options *o, ec_setting_value *v)
{
    *v = o->light_paths > 0 ? (ec_setting_value){REAL(o->light_paths)} : (ec_setting_value){NONE(o->light_paths < 0 ? "auto" : "0")};
}

static void get_without(const ec_render_options *o, ec_setting_value *v)
{
    ec_feature_names(o->without, v->made, sizeof v->made);
    v->field.text = *v->made ? v->made : "nothing";
}

const ec_setting ec_settings[] = {
    {"size", NULL, NULL, EC_IDENTITY_BY_VALUE, get_size},
    {"replicates", NULL, NULL, EC_IDENTITY_BY_VALUE, get_replicates},
    {"seed", "seed", "eclat.seed", EC_IDENTITY_BY_VALUE, get_seed},
    {"adaptive", "adaptive", "eclat.adaptive", EC_IDENTITY_BY_VALUE, get_adaptive},
    {"integrator", "integrator", "eclat.integrator", EC_IDENTITY_BY_VALUE, get_integrator},
    {"sampler", "sampler", "eclat.sampler", EC_IDENTITY_BY_VALUE, get_sampler},
    {"sample", "sample", "eclat.sample", EC_IDENTITY_BY_VALUE, get_sample},
    {"max-depth", "max_depth", "eclat.maxDepth", EC_IDENTITY_BY_VALUE, get_max_depth},
    {"rr", "rr", "eclat.rr", EC_IDENTITY_BY_VALUE, get_rr},
    {"clamp", NULL, NULL, EC_IDENTITY_BY_VALUE, get_clamp}, /* reported with its effect in report/error_text.h */
    {"light-paths", "light_paths", "eclat.lightPaths", EC_IDENTITY_BY_VALUE, get_light_paths},
    {"guiding", "guiding", "eclat.guiding", EC_IDENTITY_BY_VALUE, get_guiding},
    {"fog", "fog", "eclat.fog", EC_IDENTITY_BY_VALUE, get_fog},
    {"terminator", "terminator", "eclat.terminator", EC_IDENTITY_BY_VALUE, get_terminator},
    {"scattering", "scattering", "eclat.scattering", EC_IDENTITY_BY_CONTENT, get_scattering},
    {"light-choice", "light_choice", "eclat.lightChoice", EC_IDENTITY_BY_CONTENT, get_light_choice},
    {"background", NULL, NULL, EC_IDENTITY_BY_VALUE, get_background}, /* reported by kind */
    {"filter", "filter", "eclat.filter", EC_IDENTITY_BY_VALUE, get_filter},
    {"filter-width", "filter_width", "eclat.filterWidth", EC_IDENTITY_BY_VALUE, get_filter_width},
    {"fstop", "fstop", "eclat.fstop", EC_IDENTITY_BY_VALUE, get_fstop},
    {"focus", "focus", "eclat.focus", EC_IDENTITY_BY_VALUE, get_focus},
    {"screen-window", "screen_window", "eclat.screenWindow", EC_IDENTITY_BY_VALUE, get_screen_window},
    {"cutoff", "cutoff", "eclat.cutoff", EC_IDENTITY_BY_VALUE, get_cutoff},
    {"without", NULL, NULL, EC_IDENTITY_BY_VALUE, get_without}, /* reported among the effects */
    {"denoise", "denoise", "eclat.denoise", EC_IDENTITY_BY_VALUE, get_denoise},
    {"accel", "accel", "eclat.accel", EC_NOT_IDENTITY, get_accel},
};
const int ec_setting_count = sizeof ec_settings / sizeof ec_settings[0];

void ec_setting_get(const ec_setting *setting, const ec_render_options *options, ec_setting_value *value)
{
    *value = (ec_setting_value){TEXT(NULL)};
    setting->get(options, value);
}

void ec_setting_trait(const ec_setting *setting, const ec_render_options *options, char *text, size_t size)
{
    ec_setting_value value;
    ec_setting_get(setting, options, &value);
    const ec_field *f = &value.field;
    if (f->kind == EC_FIELD_WHOLE) snprintf(text, size, "%" PRIu64, f->whole);
    else if (f->kind == EC_FIELD_REAL) snprintf(text, size, "%.17g", value.is_idle ? 0 : f->real);
    else if (f->kind == EC_FIELD_FLAG) snprintf(text, size, "%s", f->whole ? "on" : "off");
    else snprintf(text, size, "%s", f->text);
}
