/* The settings of a render that reports and identities tell, one row each: what it is called there, and its value. */
#ifndef EC_REPORT_SETTINGS_H
#define EC_REPORT_SETTINGS_H

#include "device/options.h"
#include "pack/called_effects.h"
#include "report/json.h"

typedef struct ec_setting_value {
    ec_field field;             /* without a key; its text may be `made` */
    bool is_unsaid;             /* not asked for: reports leave it out, the identity has the default */
    bool is_idle;               /* without effect on this render: the identity has 0 */
    char made[EC_EFFECT_NAMES];
} ec_setting_value;

/* Does a sample depend on it? By what the scene's data call for: two values that come to the same are the same. */
typedef enum ec_setting_identity { EC_NOT_IDENTITY, EC_IDENTITY_BY_VALUE, EC_IDENTITY_BY_CONTENT } ec_setting_identity;

typedef struct ec_setting {
    const char *option;         /* of `eclat render`, without dashes; its trait is "--option" */
    const char *json, *exr;     /* key and attribute; NULL: reports do not tell it, or in other words */
    ec_setting_identity identity;
    void (*get)(const ec_render_options *options, ec_setting_value *value);
} ec_setting;

/* In the order of traits, the first difference of which is told. */
extern const ec_setting ec_settings[];
extern const int ec_setting_count;

/* The value; pointers into it hold while it stays where it is. */
void ec_setting_get(const ec_setting *setting, const ec_render_options *options, ec_setting_value *value);

/* As identities keep it: exact, "%.17g". */
void ec_setting_trait(const ec_setting *setting, const ec_render_options *options, char *text, size_t size);

#endif
