/* The rows of shared/material_fields.h as tables. */
#ifndef EC_SCENE_MATERIAL_FIELDS_H
#define EC_SCENE_MATERIAL_FIELDS_H

#include "scene/scene.h"

typedef struct ec_material_field {
    size_t at;             /* in ec_material */
    int floats;
    float value;           /* where a file does not say */
    float least, most;
    enum ec_slot slot;     /* texture that multiplies it; EC_SLOT_NONE: none does */
    int channel;           /* from this one on: 0 to 3 */
    uint64_t effect;       /* that it weighs: EC_FEATURE_*, or 0 */
    const char *has, *path;
} ec_material_field;
extern const ec_material_field ec_material_fields[];
extern const int ec_material_field_count;

typedef struct ec_material_slot {
    bool is_srgb;
    uint64_t effect, textured;
    const char *has, *path;
} ec_material_slot;
extern const ec_material_slot ec_material_slots[EC_SLOT_COUNT];

static inline float *ec_material_floats(ec_material *m, const ec_material_field *f) { return (float *)((char *)m + f->at); }
/* The greatest of its numbers. */
float ec_material_most(const ec_material *m, const ec_material_field *f);
/* Is there any of these effects, by the fields that weigh them? */
bool ec_material_has(const ec_material *m, uint64_t effects);
/* None of these effects. */
void ec_material_clear(ec_material *m, uint64_t effects);

/* All as glTF has it by default, without textures. */
ec_material ec_material_default(void);

#endif
