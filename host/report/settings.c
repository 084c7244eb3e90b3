#include "report/settings.h"

#include <inttypes.h>
#include <stdio.h>

#include "report/format.h"
#include "report/names.h"

static void put_text(ec_setting_value *value, const char *text) { value->text = text; }

static void put_whole(ec_setting_value *value, uint64_t whole)
{
    value->kind = EC_SETTING_WHOLE;
    value->whole = whole;
}

static void put_real(ec_setting_value *value, double real)
{
    value->kind = EC_SETTING_REAL;
    value->real = real;
}

static void put_none(ec_setting_value *value, const char *text)
{
    value->kind = EC_SETTING_NONE;
    value->text = text;
}

#define GET(name) static void get_##name(const ec_render_options *o, ec_setting_value *value)

GET(size)
{
    snprintf(value->made, sizeof value->made, "%ux%u", o->width, o->height);
    put_text(value, value->made);
}

GET(adaptive)
{
    value->kind = EC_SETTING_SWITCH;
    value->on = o->adaptive;
}

GET(max_depth)
{
    if (o->max_depth) put_whole(value, o->max_depth);
    else put_none(value, "inf");
}

GET(rr)
{
    snprintf(value->made, sizeof value->made, "%s", ec_roulette(o->survival).text);
    put_text(value, value->made);
}

GET(clamp)
{
    if (o->clamp > 0) put_real(value, o->clamp);
    else put_none(value, "off");
}

GET(filter_width)
{
    value->is_unsaid = !(o->filter_width > 0);
    put_real(value, value->is_unsaid ? EC_FILTER_WIDTH : o->filter_width);
}

GET(fstop)
{
    value->is_unsaid = !(o->fstop > 0);
    put_real(value, o->fstop);
}

GET(focus)
{
    value->is_unsaid = !(o->fstop > 0);
    put_real(value, o->focus);
}

GET(cutoff)
{
    value->is_idle = o->integrator != EC_INTEGRATOR_WHITTED;
    put_real(value, o->cutoff);
}

GET(without)
{
    ec_feature_names(o->without, value->made, sizeof value->made);
    put_text(value, *value->made ? value->made : "nothing");
}

GET(replicates) { put_whole(value, ec_render_replicates(o)); }
GET(seed) { put_whole(value, o->seed); }
GET(integrator) { put_text(value, ec_integrator_names[o->integrator]); }
GET(sampler) { put_text(value, ec_sampler_names[o->sampler]); }
GET(sample) { put_text(value, ec_sample_names[o->sample]); }
GET(terminator) { put_text(value, ec_terminator_names[o->terminator]); }
GET(scattering) { put_text(value, ec_scattering_names[o->scattering]); }
GET(light_choice) { put_text(value, ec_light_choice_names[o->light_choice]); }
GET(filter) { put_text(value, ec_filter_names[o->filter]); }
GET(accel) { put_text(value, o->accel ? o->accel : "auto"); }

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
    {"clamp", NULL, NULL, EC_IDENTITY_BY_VALUE, get_clamp}, /* reports: with what it took, report/error_text.h */
    {"terminator", "terminator", "eclat.terminator", EC_IDENTITY_BY_VALUE, get_terminator},
    {"scattering", "scattering", "eclat.scattering", EC_IDENTITY_BY_CONTENT, get_scattering},
    {"light-choice", "light_choice", "eclat.lightChoice", EC_IDENTITY_BY_CONTENT, get_light_choice},
    {"filter", "filter", "eclat.filter", EC_IDENTITY_BY_VALUE, get_filter},
    {"filter-width", "filter_width", "eclat.filterWidth", EC_IDENTITY_BY_VALUE, get_filter_width},
    {"fstop", "fstop", "eclat.fstop", EC_IDENTITY_BY_VALUE, get_fstop},
    {"focus", "focus", "eclat.focus", EC_IDENTITY_BY_VALUE, get_focus},
    {"cutoff", "cutoff", "eclat.cutoff", EC_IDENTITY_BY_VALUE, get_cutoff},
    {"without", NULL, NULL, EC_IDENTITY_BY_VALUE, get_without}, /* reports: among the effects */
    {"accel", "accel", "eclat.accel", EC_NOT_IDENTITY, get_accel},
};
const int ec_setting_count = sizeof ec_settings / sizeof ec_settings[0];

void ec_setting_get(const ec_setting *setting, const ec_render_options *options, ec_setting_value *value)
{
    *value = (ec_setting_value){.kind = EC_SETTING_TEXT};
    setting->get(options, value);
}

void ec_setting_trait(const ec_setting *setting, const ec_render_options *options, char *text, size_t size)
{
    ec_setting_value value;
    ec_setting_get(setting, options, &value);
    switch (value.kind) {
    case EC_SETTING_TEXT:
    case EC_SETTING_NONE: snprintf(text, size, "%s", value.text); break;
    case EC_SETTING_WHOLE: snprintf(text, size, "%" PRIu64, value.whole); break;
    case EC_SETTING_REAL: snprintf(text, size, "%.17g", value.is_idle ? 0 : value.real); break;
    case EC_SETTING_SWITCH: snprintf(text, size, "%s", value.on ? "on" : "off"); break;
    }
}
