#include "pack/called_effects.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

#define ROW(name, text) {EC_FEATURE_##name, text},
const ec_feature ec_features[] = {EC_FEATURES(ROW)};
const uint32_t ec_feature_count = sizeof ec_features / sizeof *ec_features;

static int place_of(uint64_t bit)
{
    int place = 0;
    while (bit >>= 1) place++;
    return place;
}

void ec_effects_call(ec_effects *effects, uint64_t feature, const char *why, ...)
{
    if (effects->bits & feature) return;
    va_list args;
    va_start(args, why);
    int place = place_of(feature);
    char *text = effects->calls[place].why;
    vsnprintf(text, EC_EFFECT_WHY, why, args);
    va_end(args);
    text[ec_text_cut(text, EC_EFFECT_WHY)] = 0;
    effects->calls[place].others = 0;
    effects->bits |= feature;
}

void ec_effects_add(ec_effects *effects, const ec_effects *one)
{
    for (int k = 0; k < EC_EFFECT_BITS; k++) {
        uint64_t bit = (uint64_t)1 << k;
        if (!(one->bits & bit)) continue;
        if (effects->bits & bit) effects->calls[k].others++;
        else effects->calls[k] = one->calls[k];
    }
    effects->bits |= one->bits;
}

void ec_effects_why(const ec_effects *effects, uint64_t feature, char *text, size_t size)
{
    int place = place_of(feature);
    text[0] = 0;
    if (!(effects->bits & feature)) return;
    uint32_t others = effects->calls[place].others;
    if (!others) snprintf(text, size, "%s", effects->calls[place].why);
    else snprintf(text, size, "%s, and %u other%s", effects->calls[place].why, others, others == 1 ? "" : "s");
}

void ec_feature_names(uint64_t features, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (uint32_t i = 0; i < ec_feature_count && used < size; i++)
        if (features & ec_features[i].bit)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "", ec_features[i].name);
}
