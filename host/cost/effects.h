/* Effects of a scene, and scenes without them. */
#ifndef EC_COST_EFFECTS_H
#define EC_COST_EFFECTS_H

#include "scene/scene.h"

typedef enum ec_cost_effect_kind {
    EC_EFFECT_NONE,
    EC_EFFECT_INDIRECT,        /* light that more than one surface has passed on: an option, not an edit */
    EC_EFFECT_BASE_TEXTURES,   /* base colour textures: their mean colour instead */
    EC_EFFECT_NORMAL_MAPS,
    EC_EFFECT_OTHER_TEXTURES,  /* all others but emission: their mean instead */
    EC_EFFECT_SMOOTH_NORMALS,  /* the triangles' own instead */
    EC_EFFECT_GLOSS,           /* specular reflection and metal: diffuse instead */
    EC_EFFECT_TRANSMISSION,    /* opaque instead */
    EC_EFFECT_ALPHA,           /* opaque instead */
    EC_EFFECT_ENVIRONMENT,     /* black instead */
    EC_EFFECT_PUNCTUAL,        /* point, spot and directional lights */
    EC_EFFECT_LAMPS            /* what emits with material `material` */
} ec_cost_effect_kind;

typedef struct ec_cost_effect {
    ec_cost_effect_kind kind;
    uint32_t material; /* EC_EFFECT_LAMPS only */
} ec_cost_effect;

/* Does the scene have it? (EC_EFFECT_INDIRECT: always.) */
bool ec_cost_has_effect(const ec_scene *scene, ec_cost_effect effect);

/* The scene without it. *without shares everything that it does not change with `scene` and is valid as long as that is; end it
 * with ec_cost_restore. */
typedef struct ec_cost_edit {
    ec_scene scene;
    ec_material *materials; /* owned, or NULL */
} ec_cost_edit;
ec_result ec_cost_without(const ec_scene *scene, ec_cost_effect effect, ec_cost_edit *edit, ec_error *err);
void ec_cost_restore(ec_cost_edit *edit);

#endif
