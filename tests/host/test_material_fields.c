/* tier: quick */
/* Every row of shared/material_fields.h: a file with that member alone changes only that field or texture, and values out of range are
 * clamped. */
#include "scene/material_fields.h"
#include "textured_triangle.h"

/* A material with one member, at the end of a path: extensions/NAME/MEMBER. */
static ec_scene *load_member(const char *path, const char *value)
{
    char material[512] = ",", text[4096];
    int open = 0;
    for (const char *slash; (slash = strchr(path, '/')); path = slash + 1, open++)
        snprintf(material + strlen(material), sizeof material - strlen(material), "'%.*s':{%s", (int)(slash - path), path,
                 strncmp(slash - 7, "Texture/", 8) ? "" : "'index':0,");
    snprintf(material + strlen(material), sizeof material - strlen(material), "'%s':%s%.*s", path, value, open, "}}}}");
    snprintf(text, sizeof text, TEXTURED("%s", ""), material);
    return load(text);
}

static void say(const ec_material_field *f, float value, char *text, size_t size)
{
    snprintf(text, size, f->floats == 1 ? "%.9g" : f->floats == 3 ? "[%.9g,%.9g,%.9g]" : "[%.9g,%.9g,%.9g,%.9g]", (double)value, (double)value,
             (double)value, (double)value);
}

/* Checks that all fields are at their defaults except this one. */
static void check_fields(const ec_material *found, const ec_material_field *one, float value)
{
    for (int i = 0; i < ec_material_field_count; i++) {
        const ec_material_field *f = &ec_material_fields[i];
        const float *floats = (const float *)((const char *)found + f->at), expected = f == one ? value : f->value;
        for (int k = 0; k < f->floats; k++)
            CHECK_MSG(floats[k] == expected, "%s[%d]: %g, not %g", f->path, k, (double)floats[k], (double)expected);
    }
}

static void test_field(const ec_material_field *f)
{
    char text[96];
    const float inside = f->least < 0.25f ? 0.25f : 1.75f;
    CHECK_MSG(f->value >= f->least && f->value <= f->most && f->channel + f->floats <= 4, "%s", f->path);
    say(f, inside, text, sizeof text);
    ec_scene *s = load_member(f->path, text);
    check_fields(s->materials, f, inside);
    CHECK_MSG(!strstr(messages, "clamped"), "%s: %s", f->path, messages);
    ec_scene_free(s);
    if (f->at == offsetof(ec_material, anisotropy_rotation)) return; /* whole turns are removed */
    say(f, 3e30f, text, sizeof text);
    s = load_member(f->path, text);
    check_fields(s->materials, f, f->most);
    CHECK_MSG(strstr(messages, "clamped"), "%s: %s", f->path, messages);
    ec_scene_free(s);
}

static void test_slot(int slot)
{
    ec_scene *s = load_member(ec_material_slots[slot].path, "{'index':0}");
    for (int k = 0; k < EC_SLOT_COUNT; k++) CHECK_MSG((s->materials->textures[k].texture >= 0) == (k == slot), "%s, slot %d", ec_material_slots[slot].path, k);
    check_fields(s->materials, NULL, 0);
    ec_scene_free(s);
}

int main(void)
{
    const size_t absorption = offsetof(ec_material, absorption); /* depends on a colour and a distance */
    for (int i = 0; i < ec_material_field_count; i++)
        if (ec_material_fields[i].at != absorption) test_field(&ec_material_fields[i]);
    for (int slot = 0; slot < EC_SLOT_COUNT; slot++) test_slot(slot);
    TEST_END();
}
