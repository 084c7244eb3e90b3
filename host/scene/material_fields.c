#include "scene/material_fields.h"

#include <math.h>

#include "shared/features.h"

#define FIELD(field, floats, value, least, most, slot, channel, effect, has, path) \
    {offsetof(ec_material, field), floats, value, least, most, EC_SLOT_##slot, channel, EC_FEATURE_##effect, has, path},
#define WORD(type, field)
#define WORDS(field)
const ec_material_field ec_material_fields[] = {EC_MATERIAL_FIELDS(FIELD, FIELD, WORD, WORDS)};
const int ec_material_field_count = sizeof ec_material_fields / sizeof *ec_material_fields;

#define SLOT(name, is_srgb, effect, textured, has, path) {is_srgb, EC_FEATURE_##effect, EC_FEATURE_##textured, has, path},
const ec_material_slot ec_material_slots[EC_SLOT_COUNT] = {EC_SLOTS(SLOT)};

float ec_material_most(const ec_material *m, const ec_material_field *f)
{
    const float *floats = (const float *)((const char *)m + f->at);
    float most = floats[0];
    for (int k = 1; k < f->floats; k++) most = fmaxf(most, floats[k]);
    return most;
}

bool ec_material_has(const ec_material *m, uint64_t effects)
{
    for (int i = 0; i < ec_material_field_count; i++)
        if ((ec_material_fields[i].effect & effects) && ec_material_most(m, &ec_material_fields[i]) > 0) return true;
    return false;
}

void ec_material_clear(ec_material *m, uint64_t effects)
{
    for (int i = 0; i < ec_material_field_count; i++) {
        const ec_material_field *f = &ec_material_fields[i];
        for (int k = 0; (f->effect & effects) && k < f->floats; k++) ec_material_floats(m, f)[k] = 0;
    }
}

ec_material ec_material_default(void)
{
    ec_material m = {0};
    for (int i = 0; i < ec_material_field_count; i++)
        for (int k = 0; k < ec_material_fields[i].floats; k++) ec_material_floats(&m, &ec_material_fields[i])[k] = ec_material_fields[i].value;
    for (int i = 0; i < EC_SLOT_COUNT; i++) m.textures[i] = (ec_texture_use){.texture = -1, .transform = {1, 0, 0, 0, 1, 0}};
    return m;
}
