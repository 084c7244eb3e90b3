#include "store/identity.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "report/format.h"
#include "report/names.h"

/* What is said of digests, which nobody wants to read. In the order of ec_content_id. */
static const char *const contents[EC_CONTENT_COUNT] = {"camera", "geometry", "materials", "textures", "lights", "environment",
                                                       "settings", "kernels"};

__attribute__((format(printf, 3, 4))) static void add(ec_identity *identity, const char *name, const char *format, ...)
{
    if (identity->count == EC_TRAITS_MAX) return;
    ec_trait *trait = &identity->traits[identity->count++];
    snprintf(trait->name, sizeof trait->name, "%s", name);
    va_list args;
    va_start(args, format);
    vsnprintf(trait->value, sizeof trait->value, format, args);
    va_end(args);
}

void ec_identity_of(const ec_render_options *o, const ec_content *content, ec_identity *identity)
{
    char names[EC_EFFECT_NAMES], roulette[32];
    memset(identity, 0, sizeof *identity);
    ec_format_roulette(o->survival, roulette, sizeof roulette);
    ec_feature_names(o->without, names, sizeof names);
    add(identity, "version", ECLAT_VERSION);
    if (content) add(identity, contents[EC_CONTENT_KERNELS], "%s", content->digest[EC_CONTENT_KERNELS]);
    add(identity, "--size", "%ux%u", o->width, o->height);
    add(identity, "--replicates", "%u", ec_render_replicates(o));
    add(identity, "--seed", "%" PRIu64, o->seed);
    add(identity, "--adaptive", "%s", o->adaptive ? "on" : "off");
    add(identity, "--integrator", "%s", ec_integrator_names[o->integrator]);
    add(identity, "--sampler", "%s", ec_sampler_names[o->sampler]);
    add(identity, "--sample", "%s", ec_sample_names[o->sample]);
    add(identity, "--max-depth", o->max_depth ? "%u" : "inf", o->max_depth);
    add(identity, "--rr", "%s", roulette);
    add(identity, "--clamp", o->clamp > 0 ? "%.17g" : "off", o->clamp);
    add(identity, "--terminator", "%s", ec_terminator_names[o->terminator]);
    if (content) {
        add(identity, "--scattering", "%s",
            ec_scattering_names[content->called & EC_FEATURE_MULTISCATTER ? EC_SCATTERING_MULTIPLE
                                                                          : EC_SCATTERING_SINGLE]);
        add(identity, "--light-choice", "%s",
            ec_light_choice_names[content->called & EC_FEATURE_LIGHT_TREE ? EC_LIGHTS_BY_TREE : EC_LIGHTS_BY_POWER]);
    }
    add(identity, "--filter", "%s", ec_filter_names[o->filter]);
    add(identity, "--filter-width", "%.17g", o->filter_width > 0 ? o->filter_width : EC_FILTER_WIDTH);
    add(identity, "--fstop", "%.17g", o->fstop);
    add(identity, "--focus", "%.17g", o->focus);
    add(identity, "--cutoff", "%.17g", o->integrator == EC_INTEGRATOR_WHITTED ? o->cutoff : 0);
    add(identity, "--without", "%s", *names ? names : "nothing");
    for (int i = 0; content && i < EC_CONTENT_COUNT; i++)
        if (i != EC_CONTENT_KERNELS) add(identity, contents[i], "%s", content->digest[i]);
}

const char *ec_identity_value(const ec_identity *identity, const char *name)
{
    for (uint32_t i = 0; i < identity->count; i++)
        if (!strcmp(identity->traits[i].name, name)) return identity->traits[i].value;
    return NULL;
}

static bool is_scene(const char *name)
{
    for (int i = 0; i < EC_CONTENT_COUNT; i++)
        if (i != EC_CONTENT_SETTINGS && i != EC_CONTENT_KERNELS && !strcmp(name, contents[i])) return true;
    return false;
}

/* "the scene's camera and geometry": all that differ. */
static void describe_scene(const ec_identity *there, const ec_identity *here, char *text, size_t size)
{
    snprintf(text, size, "not the same are the scene's");
    for (uint32_t i = 0, found = 0; i < here->count; i++) {
        const ec_trait *own = &here->traits[i];
        const char *other = ec_identity_value(there, own->name);
        size_t used = strlen(text);
        if (!is_scene(own->name) || (other && !strcmp(other, own->value))) continue;
        snprintf(text + used, size - used, "%s%s", found++ ? ", " : " ", own->name);
    }
}

static void describe(const char *name, const char *there, const char *here, char *text, size_t size)
{
    if (!strcmp(name, "kernels")) snprintf(text, size, "it is of another version of eclat, whose kernels are not the same");
    else if (!strcmp(name, "settings")) snprintf(text, size, "the settings of the render are not the same");
    else if (!strcmp(name, "files")) snprintf(text, size, "the scene's files are not the same");
    else if (!there || !here) snprintf(text, size, "%s is %s there and %s here", name, there ? there : "not given", here ? here : "not given");
    else snprintf(text, size, "%s is %s there and %s here", name, there, here);
}

bool ec_identity_differs(const ec_identity *there, const ec_identity *here, char *text, size_t size)
{
    for (uint32_t i = 0; i < here->count; i++) {
        const ec_trait *own = &here->traits[i];
        const char *other = ec_identity_value(there, own->name);
        if (other && !strcmp(other, own->value)) continue;
        if (is_scene(own->name)) describe_scene(there, here, text, size);
        else describe(own->name, other, own->value, text, size);
        return true;
    }
    for (uint32_t i = 0; i < there->count; i++) {
        if (ec_identity_value(here, there->traits[i].name)) continue;
        describe(there->traits[i].name, there->traits[i].value, NULL, text, size);
        return true;
    }
    return false;
}
