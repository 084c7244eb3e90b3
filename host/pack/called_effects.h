/* Which effects are called for, and why. Who sets a bit says why in the same line:
 *
 *     ec_effects_call(effects, EC_FEATURE_SHEEN, "material %u has sheen", index);
 *
 * All reports read it from here. */
#ifndef EC_PACK_CALLED_EFFECTS_H
#define EC_PACK_CALLED_EFFECTS_H

#include <stddef.h>
#include <stdint.h>

#include "shared/features.h"

enum { EC_EFFECT_BITS = 64, EC_EFFECT_WHY = 112, EC_EFFECT_NAMES = 2048 /* all of them */ };

typedef struct ec_effects {
    uint64_t bits; /* EC_FEATURE_* */
    struct {       /* by bit */
        char why[EC_EFFECT_WHY]; /* of the first that calls for it */
        uint32_t others;         /* that call for it too */
    } calls[EC_EFFECT_BITS];
} ec_effects;

/* One bit; the first reason stays. */
void ec_effects_call(ec_effects *effects, uint64_t feature, const char *why, ...) __attribute__((format(printf, 3, 4)));
/* Adds the effects that one more caller needs. */
void ec_effects_add(ec_effects *effects, const ec_effects *one);
/* "material 2 "Light" emits, and 3 others"; empty where nobody calls for it. */
void ec_effects_why(const ec_effects *effects, uint64_t feature, char *text, size_t size);

/* Every effect, in the order of the reports. */
typedef struct ec_feature {
    uint64_t bit;
    const char *name;
} ec_feature;
extern const ec_feature ec_features[];
extern const uint32_t ec_feature_count;

/* Names of the effects in a mask, blank separated. */
void ec_feature_names(uint64_t features, char *text, size_t size);

#endif
