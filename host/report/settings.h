/* The settings of a render that reports and identities state, one row each: their names and values. */
#ifndef EC_REPORT_SETTINGS_H
#define EC_REPORT_SETTINGS_H

#include "device/options.h"
#include "pack/called_effects.h"
#include "report/json.h"

typedef struct ec_setting_value {
    ec_field field;             /* without a key; its text may point to `made` */
    bool is_unsaid;             /* not asked for: reports leave it out, the identity has the default */
    bool is_idle;               /* has no effect on this render: the identity has 0 */
    char made[EC_EFFECT_NAMES];
} ec_setting_value;

/* How samples depend on a setting: not at all, by its value, or by the data made from it, where two values that give the same data are the same. */
typedef enum ec_setting_identity { EC_NOT_IDENTITY, EC_IDENTITY_BY_VALUE, EC_IDENTITY_BY_CONTENT } ec_setting_identity;

typedef struct ec_setting {
    const char *option;         /* of `eclat render`, without dashes; its trait is "--option" */
    const char *json, *exr;     /* key and attribute; NULL: reports do not state it, or do so in another form */
    ec_setting_identity identity;
    void (*get)(const ec_render_options *options, ec_setting_value *value);
} ec_setting;

/* In the order of an identity's traits, of which the first difference is reported. */
extern const ec_setting ec_settings[];
extern const int ec_setting_count;

/* Gets the value; it may point into itself, and so must not be moved. */
void ec_setting_get(const ec_setting *setting, const ec_render_options *options, ec_setting_value *value);

/* Writes the value in the form of identities: exact, "%.17g". */
void ec_setting_trait(const ec_setting *setting, const ec_render_options *options, char *text, size_t size);

#endif
