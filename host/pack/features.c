/* Determines which effects the scene calls for, and why. Takes a plain view (scene_view.h), so that everything present counts. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "base/freed.h"
#include "base/text.h"
#include "base/vec3.h"
#include "pack/pack.h"
#include "scene/material_fields.h"
#include "scene/texture_range.h"

static float max3(const float v[3])
{
    return fmaxf(v[0], fmaxf(v[1], v[2]));
}

/* Tells whether kernels, whose product rounds differently, may take this roughness for 0. */
static bool is_smooth(float roughness) { return roughness * roughness * 0.99f < EC_SMOOTH_ALPHA; }

/* Tells whether kernels may find reflection or refraction too narrow for a density (surface_material, surface_transmission). */
static bool may_be_smooth(const ec_scene *scene, const ec_material *m, bool refracts)
{
    float least, most;
    ec_texture_range(scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 1, &least, &most);
    float alpha = m->roughness * m->roughness * least * least * 0.99f; /* the kernels' product rounds differently */
    float ior = fmaxf(m->ior - 0.0151f * m->dispersion * (m->ior - 1.0f), 1.0f); /* that of red light: dispersed_index */
    return alpha < EC_SMOOTH_ALPHA || (refracts && alpha * fabsf(1.0f - 1.0f / ior) < EC_SMOOTH_ALPHA);
}

bool ec_pack_is_matched(const ec_scene *plain, const ec_material *m)
{
    return !plain->solid_shadows && !m->unlit && ec_refracts(m) && m->ior == 1.0f;
}

bool ec_pack_is_pane(const ec_scene *plain, const ec_material *m)
{
    const bool thin = !plain->solid_shadows && !ec_refracts(m) && m->transmission > 0.0f && may_be_smooth(plain, m, false);
    return thin || ec_pack_is_matched(plain, m);
}

bool ec_pack_is_body(const ec_material *m)
{
    return !m->unlit && (ec_bounds(m) || (ec_refracts(m) && m->transmission > 0.0f));
}

ec_result ec_pack_find_bodies(const ec_scene *plain, ec_bodies *bodies, ec_error *err)
{
    *bodies = (ec_bodies){0};
    if (plain->bodies_apart) return EC_OK;
    EC_FREED bool *is_body = calloc(plain->material_count, sizeof *is_body);
    bool any = false;
    if (!is_body) return ec_fail(err, "out of memory for %u materials", plain->material_count);
    for (uint32_t m = 0; m < plain->material_count; m++) any |= is_body[m] = ec_pack_is_body(&plain->materials[m]);
    return any ? ec_bodies_find(plain, is_body, bodies, err) : EC_OK;
}

/* A material, and the effects that it calls for. */
typedef struct scan {
    const ec_scene *scene;
    const ec_material *m;
    char name[64];
    ec_effects found;
} scan;

static void name_material(const ec_scene *scene, uint32_t index, char *text, size_t size)
{
    const char *name = scene->materials[index].name;
    if (name && *name) snprintf(text, size, "material %u \"%.*s\"", index, EC_CUT(name, 36));
    else snprintf(text, size, "material %u", index);
}

/* Calls for an effect, and says what in the material calls for it. */
__attribute__((format(printf, 3, 4))) static void call(scan *s, uint64_t feature, const char *has, ...)
{
    char text[EC_EFFECT_WHY];
    va_list args;
    va_start(args, has);
    vsnprintf(text, sizeof text, has, args);
    va_end(args);
    ec_effects_call(&s->found, feature, "%s %s", s->name, text);
}

static bool has_texture(const scan *s, int slot) { return s->m->textures[slot].texture >= 0; }

/* Checks the coat, which has a roughness of its own. */
static void scan_coat(scan *s)
{
    const ec_material *m = s->m;
    float least, most;
    ec_texture_range(s->scene, &m->textures[EC_SLOT_CLEARCOAT_ROUGHNESS], 1, &least, &most);
    if (m->coat > 0.0f && is_smooth(m->coat_roughness * least))
        call(s, EC_FEATURE_SMOOTH, "has a coat of roughness %g", (double)(m->coat_roughness * least));
}

static void scan_specular(scan *s)
{
    const uint64_t over_diffuse = ~(uint64_t)(EC_FEATURE_EMISSION | EC_FEATURE_SPECULAR | EC_FEATURE_ANISOTROPY);
    const ec_material *m = s->m;
    if (m->metallic > 0.0f) call(s, EC_FEATURE_SPECULAR, "has metallic %g", (double)m->metallic);
    else if (m->specular > 0.0f) call(s, EC_FEATURE_SPECULAR, "has specular reflection");
    else if (ec_material_has(m, over_diffuse)) call(s, EC_FEATURE_SPECULAR, "has more than a diffuse base");
    else return;
    if (may_be_smooth(s->scene, m, ec_refracts(m))) call(s, EC_FEATURE_SMOOTH, "reflects or refracts in one direction, by its roughness or ior");
    if (has_texture(s, EC_SLOT_METALLIC_ROUGHNESS))
        call(s, EC_FEATURE_METALLIC_ROUGHNESS_TEXTURE, "has a metallic-roughness texture");
    if (has_texture(s, EC_SLOT_SPECULAR) || has_texture(s, EC_SLOT_SPECULAR_COLOR))
        call(s, EC_FEATURE_SPECULAR_TEXTURE, "has a specular texture");
    if (m->anisotropy == 0.0f) return;
    call(s, EC_FEATURE_ANISOTROPY, "has anisotropy %g", (double)m->anisotropy);
    if (has_texture(s, EC_SLOT_ANISOTROPY)) call(s, EC_FEATURE_ANISOTROPY_TEXTURE, "has an anisotropy texture");
}

/* Calls for the effects of shared/material_fields.h that the material uses. */
static void scan_rows(scan *s)
{
    for (int i = 0; i < ec_material_field_count; i++) {
        const ec_material_field *f = &ec_material_fields[i];
        float most = ec_material_most(s->m, f);
        if (!f->has || most == 0.0f) continue;
        if (f->floats == 1) call(s, f->effect, "%s %g", f->has, (double)most);
        else call(s, f->effect, "%s", f->has);
    }
    for (int slot = 0; slot < EC_SLOT_COUNT; slot++)
        if (has_texture(s, slot) && ec_material_slots[slot].has) call(s, ec_material_slots[slot].textured, "%s", ec_material_slots[slot].has);
}

static void scan_base_color(scan *s)
{
    bool colors = false;
    if (!has_texture(s, EC_SLOT_BASE_COLOR)) return;
    for (int k = 0; k < 3; k++) {
        float least, most;
        ec_texture_range(s->scene, &s->m->textures[EC_SLOT_BASE_COLOR], k, &least, &most);
        colors |= least != most;
    }
    const char *has = colors ? "has a base colour texture" : "has alpha in its base colour texture";
    call(s, EC_FEATURE_BASE_COLOR_TEXTURE, "%s", has);
}

static void scan_material(scan *s)
{
    const ec_material *m = s->m;
    scan_base_color(s);
    if (!m->double_sided && !ec_refracts(m) && !ec_bounds(m)) call(s, EC_FEATURE_CULLING, "is single-sided");
    if (m->alpha_mode != EC_ALPHA_OPAQUE) call(s, EC_FEATURE_ALPHA, "is transparent where its alpha says so");
    if (m->unlit) {
        call(s, EC_FEATURE_UNLIT, "is unlit");
        return;
    }
    scan_rows(s);
    if (ec_emits(m)) call(s, EC_FEATURE_AREA_LIGHTS, "emits");
    const bool matched = ec_pack_is_matched(s->scene, m);
    if (ec_pack_is_pane(s->scene, m)) call(s, EC_FEATURE_PANES, "lets light straight through %s", matched ? "walls of a body" : "a thin wall");
    if (matched) call(s, EC_FEATURE_MATCHED, "is a body of index 1");
    scan_coat(s);
    scan_specular(s);
}

static void scan_images(scan *s)
{
    for (int k = 0; k < EC_SLOT_COUNT; k++)
        if (has_texture(s, k) && s->scene->images[s->scene->textures[s->m->textures[k].texture].image].rgba16)
            call(s, EC_FEATURE_FLOAT_TEXTURE, "has a texture of more than 8 bits");
}

/* Calls for the effects of rough reflection, unless all facets lie flat. */
static void scan_rough(scan *s)
{
    const ec_material *m = s->m;
    float least, most;
    ec_texture_range(s->scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 1, &least, &most);
    float roughness = m->roughness * most;
    if (m->unlit || (m->metallic == 0.0f && m->transmission == 0.0f) || roughness * roughness <= EC_SMOOTH_ALPHA) return;
    call(s, EC_FEATURE_MULTISCATTER, "is %s of roughness %g", m->metallic > 0.0f ? "metal" : "glass", (double)roughness);
}

typedef void scan_fn(scan *s);

static void look_at_material(const ec_scene *scene, uint32_t m, scan_fn *look, ec_effects *effects)
{
    scan s = {.scene = scene, .m = &scene->materials[m]};
    name_material(scene, m, s.name, sizeof s.name);
    look(&s);
    ec_effects_add(effects, &s.found);
}

/* Scans the materials of triangles with `look`. */
static ec_result scan_materials(const ec_scene *scene, scan_fn *look, ec_effects *effects, ec_error *err)
{
    EC_FREED bool *used = calloc(scene->material_count, sizeof *used);
    if (!used) return ec_fail(err, "out of memory for %u materials", scene->material_count);
    for (uint32_t t = 0; t < scene->triangle_count; t++) used[scene->triangle_material[t]] = true;
    for (uint32_t m = 0; m < scene->material_count; m++)
        if (used[m]) look_at_material(scene, m, look, effects);
    return EC_OK;
}

/* Looks for a vertex normal that differs from its triangle's; otherwise interpolation would change nothing. */
static void scan_normals(const ec_scene *scene, ec_effects *effects)
{
    if (!scene->normals) return;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t *i = scene->indices + 3 * (size_t)t;
        const float *a = scene->positions + 3 * (size_t)i[0], *b = scene->positions + 3 * (size_t)i[1],
                    *c = scene->positions + 3 * (size_t)i[2];
        double n[3];
        ec_triangle_normal(a, b, c, n);
        double length = sqrt(ec_dot(n, n));
        for (int v = 0; v < 3; v++) {
            const float *m = scene->normals + 3 * (size_t)i[v];
            if (m[0] == 0.0f && m[1] == 0.0f && m[2] == 0.0f) continue;
            /* A normal against the winding counts as flat, as kernels turn it round. 1e-6 is 0.08 degrees. */
            if (fabs(n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) < length * (1.0 - 1e-6)) {
                char name[64];
                name_material(scene, scene->triangle_material[t], name, sizeof name);
                ec_effects_call(effects, EC_FEATURE_SMOOTH_NORMALS, "the surface of %s has vertex normals", name);
                return;
            }
        }
    }
}

/* Checks colours of vertices in use. Alpha counts only if coverage depends on it. */
static void scan_colors(const ec_scene *scene, ec_effects *effects)
{
    for (size_t i = 0; scene->colors && i < 3 * (size_t)scene->triangle_count; i++) {
        const float *c = scene->colors + 4 * (size_t)scene->indices[i];
        bool covers = c[3] == 1.0f || scene->materials[scene->triangle_material[i / 3]].alpha_mode == EC_ALPHA_OPAQUE;
        if (c[0] == 1.0f && c[1] == 1.0f && c[2] == 1.0f && covers) continue;
        char name[64];
        name_material(scene, scene->triangle_material[i / 3], name, sizeof name);
        ec_effects_call(effects, EC_FEATURE_VERTEX_COLORS, "the surface of %s has vertex colours", name);
        return;
    }
}

static void scan_lights(const ec_scene *scene, ec_effects *effects)
{
    static const char *const types[] =
        {[EC_LIGHT_POINT] = "point", [EC_LIGHT_SPOT] = "spot", [EC_LIGHT_DIRECTIONAL] = "directional"};
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const ec_light *light = &scene->lights[i];
        ec_effects one = {0};
        const char *type = types[light->type], *name = light->name;
        if (name) ec_effects_call(&one, EC_FEATURE_PUNCTUAL_LIGHTS, "%s light \"%.*s\"", type, EC_CUT(name, 60));
        else ec_effects_call(&one, EC_FEATURE_PUNCTUAL_LIGHTS, "%s light %u", type, i);
        ec_effects_add(effects, &one);
    }
    const ec_environment *e = &scene->environment;
    if (!scene->has_environment) return;
    if (e->rgb) {
        ec_effects_call(effects, EC_FEATURE_ENVIRONMENT, "the environment map shines");
        ec_effects_call(effects, EC_FEATURE_ENVIRONMENT_MAP, "the environment is a map of %u x %u", e->width, e->height);
        if (e->turned) ec_effects_call(effects, EC_FEATURE_ENVIRONMENT_TURN, "the environment is turned");
    } else if (max3(e->constant) > 0.0f) {
        ec_effects_call(effects, EC_FEATURE_ENVIRONMENT, "the environment shines");
    }
}

/* Calls for nested bodies: a wall that another body displaces has a single direction, in which all light passes. */
static void scan_bodies(const ec_bodies *bodies, ec_effects *effects)
{
    static const uint64_t of_walls[] = {EC_FEATURE_NESTED, EC_FEATURE_SPECULAR, EC_FEATURE_SMOOTH, EC_FEATURE_TRANSMISSION};
    for (int i = 0; bodies->count && i < 4; i++)
        ec_effects_call(effects, of_walls[i], "bodies of %u materials may lie in one another", bodies->count);
}

static void scan_motion(const ec_scene *scene, ec_effects *effects)
{
    const ec_motion *m = &scene->motion;
    char what[64] = "";
    if (!m->segments) return;
    size_t used = 0;
    if (m->triangle_count) used = (size_t)snprintf(what, sizeof what, "%u triangles", m->triangle_count);
    if (m->light_count) used += (size_t)snprintf(what + used, sizeof what - used, "%s%u lights", used ? ", " : "", m->light_count);
    if (m->camera_count) snprintf(what + used, sizeof what - used, "%s%u cameras", used ? ", " : "", m->camera_count);
    ec_effects_call(effects, EC_FEATURE_MOTION, "%s move, in %u straight steps within %.2g %%", what, m->segments,
                    100 * m->deviation);
}

ec_result ec_pack_effects(const ec_scene *scene, const ec_bodies *bodies, ec_effects *effects, ec_error *err)
{
    *effects = (ec_effects){0};
    EC_TRY(scan_materials(scene, scan_material, effects, err));
    EC_TRY(scan_materials(scene, scan_images, effects, err));
    if (scene->placed_count)
        ec_effects_call(effects, EC_FEATURE_INSTANCES, "meshes kept once appear in %u places", scene->placed_count);
    scan_motion(scene, effects);
    scan_bodies(bodies, effects);
    scan_lights(scene, effects);
    scan_normals(scene, effects);
    scan_colors(scene, effects);
    return EC_OK;
}

void ec_pack_rough(const ec_scene *plain, ec_effects *effects)
{
    for (uint32_t m = 0; m < plain->material_count; m++) look_at_material(plain, m, scan_rough, effects);
}
