#include "store/identity.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "report/names.h"
#include "report/settings.h"

/* Names of digests for messages, in the order of ec_content_id. */
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

/* Returns a setting by what the scene's data call for, not by what was asked for: where nothing is rough, or no lights lie apart, it makes no
 * difference. */
static const char *name_by_content(const char *option, uint64_t called)
{
    if (!strcmp(option, "scattering"))
        return ec_scattering_names[called & EC_FEATURE_MULTISCATTER ? EC_SCATTERING_MULTIPLE : EC_SCATTERING_SINGLE];
    return ec_light_choice_names[called & EC_FEATURE_LIGHT_TREE ? EC_LIGHTS_BY_TREE : EC_LIGHTS_BY_POWER];
}

static void add_setting(ec_identity *identity, const ec_setting *setting, const ec_render_options *options, const ec_content *content)
{
    char name[sizeof identity->traits->name], value[sizeof identity->traits->value];
    const bool is_by_content = setting->identity == EC_IDENTITY_BY_CONTENT;
    if (setting->identity == EC_NOT_IDENTITY || (is_by_content && !content)) return;
    snprintf(name, sizeof name, "--%s", setting->option);
    ec_setting_trait(setting, options, value, sizeof value);
    add(identity, name, "%s", is_by_content ? name_by_content(setting->option, content->called) : value);
}

void ec_identity_of(const ec_render_options *o, const ec_content *content, ec_identity *identity)
{
    memset(identity, 0, sizeof *identity);
    add(identity, "version", ECLAT_VERSION);
    if (content) add(identity, contents[EC_CONTENT_KERNELS], "%s", content->digest[EC_CONTENT_KERNELS]);
    for (int i = 0; i < ec_setting_count; i++) add_setting(identity, &ec_settings[i], o, content);
    for (int i = 0; content && i < EC_CONTENT_COUNT; i++)
        if (i != EC_CONTENT_KERNELS) add(identity, contents[i], "%s", content->digest[i]);
}

void ec_identity_add(ec_identity *identity, const char *name, const char *value) { add(identity, name, "%s", value); }

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

/* Lists all that differs in the scene: "the scene's camera and geometry". */
static void describe_scene(const ec_identity *there, const ec_identity *here, char *text, size_t size)
{
    snprintf(text, size, "the scenes differ in");
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
    if (!strcmp(name, "kernels")) snprintf(text, size, "it is from another version of eclat, whose kernels differ");
    else if (!strcmp(name, "settings")) snprintf(text, size, "the render settings differ");
    else if (!strcmp(name, "files")) snprintf(text, size, "the scene's files differ");
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
