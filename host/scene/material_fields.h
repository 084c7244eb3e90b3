/* Tables of the rows of shared/material_fields.h. */
#ifndef EC_SCENE_MATERIAL_FIELDS_H
#define EC_SCENE_MATERIAL_FIELDS_H

#include "scene/scene.h"

typedef struct ec_material_field {
    size_t at;             /* offset in ec_material */
    int floats;
    float value;           /* default, if a file does not set it */
    float least, most;
    enum ec_slot slot;     /* slot of the texture that multiplies it; EC_SLOT_NONE: none */
    int channel;           /* first channel of that texture, 0 to 3 */
    uint64_t effect;       /* effect whose weight it is: EC_FEATURE_*, or 0 */
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
/* Returns the greatest of the field's numbers. */
float ec_material_most(const ec_material *m, const ec_material_field *f);
/* Tells whether a field that weighs one of these effects is not 0. */
bool ec_material_has(const ec_material *m, uint64_t effects);
/* Sets the fields that weigh these effects to 0. */
void ec_material_clear(ec_material *m, uint64_t effects);

/* Returns glTF's default material, without textures. */
ec_material ec_material_default(void);

#endif
