/* The effects that are called for, and why. Whoever sets a bit says why in the same line:
 *
 *     ec_effects_call(effects, EC_FEATURE_SHEEN, "material %u has sheen", index);
 *
 * All reports read it from here. */
#ifndef EC_PACK_CALLED_EFFECTS_H
#define EC_PACK_CALLED_EFFECTS_H

#include <stddef.h>
#include <stdint.h>

#include "shared/features.h"

enum { EC_EFFECT_BITS = 64, EC_EFFECT_WHY = 112, EC_EFFECT_NAMES = 2048 /* room for all names */ };

typedef struct ec_effects {
    uint64_t bits; /* EC_FEATURE_* */
    struct {       /* by bit */
        char why[EC_EFFECT_WHY]; /* reason of the first caller */
        uint32_t others;         /* number of other callers */
    } calls[EC_EFFECT_BITS];
} ec_effects;

/* Calls for one effect; the first reason is kept. */
void ec_effects_call(ec_effects *effects, uint64_t feature, const char *why, ...) __attribute__((format(printf, 3, 4)));
/* Adds the effects that another caller needs. */
void ec_effects_add(ec_effects *effects, const ec_effects *one);
/* Writes e.g. "material 2 "Light" emits, and 3 others"; empty if nobody calls for the effect. */
void ec_effects_why(const ec_effects *effects, uint64_t feature, char *text, size_t size);

/* All effects, in the order of reports. */
typedef struct ec_feature {
    uint64_t bit;
    const char *name;
} ec_feature;
extern const ec_feature ec_features[];
extern const uint32_t ec_feature_count;

/* Lists names of the effects in a mask, separated by blanks. */
void ec_feature_names(uint64_t features, char *text, size_t size);

#endif
