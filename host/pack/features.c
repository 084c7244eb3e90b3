/* Which effects does the scene call for? Only materials that some triangle uses count. */
#include <math.h>
#include <stdlib.h>

#include "pack/pack.h"
#include "pack/texture_mean.h"

static float max3(const float v[3])
{
    return fmaxf(v[0], fmaxf(v[1], v[2]));
}

static bool transmits(const ec_scene *scene, const ec_material *m)
{
    float least_metal, least, most;
    if (m->transmission == 0.0f) return false;
    ec_texture_range(scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 2, &least_metal, &most);
    if (m->metallic * least_metal == 1.0f) return false;
    ec_texture_range(scene, &m->textures[EC_SLOT_TRANSMISSION], 0, &least, &most);
    return most > 0.0f;
}

/* May kernels find this roughness, whose product rounds otherwise there, to be none? */
static bool is_smooth(float roughness) { return roughness * roughness * 0.99f < EC_SMOOTH_ALPHA; }

/* May kernels find reflection or refraction too narrow for a density: surface_material, surface_transmission? */
static bool may_be_smooth(const ec_scene *scene, const ec_material *m, bool refracts)
{
    float least, most;
    ec_texture_range(scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 1, &least, &most);
    float alpha = m->roughness * m->roughness * least * least * 0.99f; /* the kernels' product rounds otherwise */
    float ior = fmaxf(m->ior - 0.0151f * m->dispersion * (m->ior - 1.0f), 1.0f); /* red's: dispersed_index */
    return alpha < EC_SMOOTH_ALPHA || (refracts && alpha * fabsf(1.0f - 1.0f / ior) < EC_SMOOTH_ALPHA);
}

bool ec_pack_is_pane(const ec_scene *scene, const ec_material *m)
{
    return !m->unlit && !ec_refracts(m) && transmits(scene, m) && may_be_smooth(scene, m, false);
}

bool ec_pack_is_body(const ec_scene *scene, const ec_material *m)
{
    return !m->unlit && (ec_bounds(m) || (ec_refracts(m) && transmits(scene, m)));
}

void ec_pack_find_bodies(const ec_scene *scene, ec_bodies *bodies)
{
    *bodies = (ec_bodies){0};
    bool *is_body = calloc(scene->material_count, sizeof *is_body);
    if (!is_body) return;
    for (uint32_t m = 0; m < scene->material_count; m++) is_body[m] = ec_pack_is_body(scene, &scene->materials[m]);
    ec_bodies_find(scene, is_body, bodies);
    free(is_body);
}

static uint64_t coat_features(const ec_scene *scene, const ec_material *m)
{
    float least, most;
    ec_texture_range(scene, &m->textures[EC_SLOT_CLEARCOAT], 0, &least, &most);
    if (m->coat * most == 0.0f) return 0;
    uint64_t f = EC_FEATURE_CLEARCOAT;
    if (m->textures[EC_SLOT_CLEARCOAT].texture >= 0 || m->textures[EC_SLOT_CLEARCOAT_ROUGHNESS].texture >= 0) f |= EC_FEATURE_CLEARCOAT_TEXTURE;
    if (m->textures[EC_SLOT_CLEARCOAT_NORMAL].texture >= 0) f |= EC_FEATURE_CLEARCOAT_NORMAL_TEXTURE;
    ec_texture_range(scene, &m->textures[EC_SLOT_CLEARCOAT_ROUGHNESS], 1, &least, &most);
    if (is_smooth(m->coat_roughness * least)) f |= EC_FEATURE_SMOOTH;
    return f;
}

/* A texture's channels are multiplied by the colour's: where each is 0 on one side or the other there is no sheen. */
static uint64_t sheen_features(const ec_scene *scene, const ec_material *m)
{
    bool any = false;
    for (int k = 0; k < 3; k++) {
        float least, most;
        ec_texture_range(scene, &m->textures[EC_SLOT_SHEEN_COLOR], k, &least, &most);
        any |= m->sheen[k] * most > 0.0f;
    }
    bool textured = m->textures[EC_SLOT_SHEEN_COLOR].texture >= 0 || m->textures[EC_SLOT_SHEEN_ROUGHNESS].texture >= 0;
    return any ? EC_FEATURE_SHEEN | (textured ? EC_FEATURE_SHEEN_TEXTURE : 0) : 0;
}

/* At roughness 1 the lobe is as wide as it gets in all directions. */
static uint64_t anisotropy_features(const ec_scene *scene, const ec_material *m)
{
    float least, most, unused;
    ec_texture_range(scene, &m->textures[EC_SLOT_ANISOTROPY], 2, &unused, &most);
    ec_texture_range(scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 1, &least, &unused);
    if (m->anisotropy * most == 0.0f || m->roughness * least == 1.0f) return 0;
    if (transmits(scene, m) && m->metallic < 1.0f && m->textures[EC_SLOT_TRANSMISSION].texture < 0 &&
        m->textures[EC_SLOT_METALLIC_ROUGHNESS].texture < 0) return 0; /* glass is as rough in all directions */
    return EC_FEATURE_ANISOTROPY | (m->textures[EC_SLOT_ANISOTROPY].texture >= 0 ? EC_FEATURE_ANISOTROPY_TEXTURE : 0);
}

/* A film of no thickness, or of air, is none. */
static uint64_t film_features(const ec_scene *scene, const ec_material *m)
{
    const ec_texture_use *thickness = &m->textures[EC_SLOT_IRIDESCENCE_THICKNESS];
    float unused, most, low = 1, high = 1;
    ec_texture_range(scene, &m->textures[EC_SLOT_IRIDESCENCE], 0, &unused, &most);
    if (thickness->texture >= 0) ec_texture_range(scene, thickness, 1, &low, &high);
    bool thick = (m->film_least > 0.0f && low < 1.0f) || (m->film_most > 0.0f && high > 0.0f);
    if (m->film * most == 0.0f || m->film_ior == 1.0f || !thick) return 0;
    bool textured = m->textures[EC_SLOT_IRIDESCENCE].texture >= 0 || thickness->texture >= 0;
    return EC_FEATURE_IRIDESCENCE | (textured ? EC_FEATURE_IRIDESCENCE_TEXTURE : 0);
}

/* Of no use under metal, nor where all the light passes straight. */
static uint64_t seeping_features(const ec_scene *scene, const ec_material *m)
{
    float least, most, unused;
    ec_texture_range(scene, &m->textures[EC_SLOT_DIFFUSE_TRANSMISSION], 3, &unused, &most);
    if (m->seeps * most == 0.0f) return 0;
    ec_texture_range(scene, &m->textures[EC_SLOT_METALLIC_ROUGHNESS], 2, &least, &unused);
    if (m->metallic * least == 1.0f) return 0;
    ec_texture_range(scene, &m->textures[EC_SLOT_TRANSMISSION], 0, &least, &unused);
    if (m->transmission * least == 1.0f) return 0;
    bool textured = m->textures[EC_SLOT_DIFFUSE_TRANSMISSION].texture >= 0 || m->textures[EC_SLOT_DIFFUSE_TRANSMISSION_COLOR].texture >= 0;
    return EC_FEATURE_DIFFUSE_TRANSMISSION | (textured ? EC_FEATURE_DIFFUSE_TRANSMISSION_TEXTURE : 0) |
           (ec_bounds(m) && max3(m->absorption) > 0.0f ? EC_FEATURE_ABSORPTION : 0);
}

static uint64_t material_features(const ec_scene *scene, const ec_material *m)
{
    uint64_t f = 0;
    if (m->unlit) return EC_FEATURE_UNLIT | (m->textures[EC_SLOT_BASE_COLOR].texture >= 0 ? EC_FEATURE_BASE_COLOR_TEXTURE : 0);
    if (max3(m->emission) > 0.0f) f |= EC_FEATURE_EMISSION | EC_FEATURE_AREA_LIGHTS;
    if (max3(m->emission) > 0.0f && m->textures[EC_SLOT_EMISSION].texture >= 0) f |= EC_FEATURE_EMISSION_TEXTURE;
    if (transmits(scene, m)) {
        f |= EC_FEATURE_TRANSMISSION;
        if (m->textures[EC_SLOT_TRANSMISSION].texture >= 0) f |= EC_FEATURE_TRANSMISSION_TEXTURE;
        if (ec_refracts(m) && max3(m->absorption) > 0.0f) f |= EC_FEATURE_ABSORPTION;
        if (ec_pack_is_pane(scene, m)) f |= EC_FEATURE_PANES;
        if (ec_refracts(m) && m->ior > 1.0f && m->dispersion > 0.0f) f |= EC_FEATURE_DISPERSION;
    }
    f |= coat_features(scene, m) | sheen_features(scene, m) | film_features(scene, m) | seeping_features(scene, m);
    if (m->metallic > 0.0f || (m->specular > 0.0f && max3(m->specular_color) > 0.0f) || 
        (f & (EC_FEATURE_TRANSMISSION | EC_FEATURE_CLEARCOAT | EC_FEATURE_SHEEN | EC_FEATURE_IRIDESCENCE | EC_FEATURE_DIFFUSE_TRANSMISSION))) {
        f |= EC_FEATURE_SPECULAR;
        if (may_be_smooth(scene, m, (f & EC_FEATURE_TRANSMISSION) && ec_refracts(m))) f |= EC_FEATURE_SMOOTH;
        if (m->textures[EC_SLOT_METALLIC_ROUGHNESS].texture >= 0) f |= EC_FEATURE_METALLIC_ROUGHNESS_TEXTURE;
        if (m->textures[EC_SLOT_SPECULAR].texture >= 0 || m->textures[EC_SLOT_SPECULAR_COLOR].texture >= 0) f |= EC_FEATURE_SPECULAR_TEXTURE;
    }
    if (f & EC_FEATURE_SPECULAR) f |= anisotropy_features(scene, m);
    if (m->textures[EC_SLOT_BASE_COLOR].texture >= 0) f |= EC_FEATURE_BASE_COLOR_TEXTURE;
    if (m->textures[EC_SLOT_NORMAL].texture >= 0) f |= EC_FEATURE_NORMAL_TEXTURE;
    if (!m->double_sided) f |= EC_FEATURE_CULLING;
    bool may_be_open = m->base_color[3] < 1.0f || m->textures[EC_SLOT_BASE_COLOR].texture >= 0 || scene->colors;
    if (m->alpha_mode != EC_ALPHA_OPAQUE && may_be_open) f |= EC_FEATURE_ALPHA;
    return f;
}

/* Does any vertex normal differ from its triangle's? Otherwise interpolating them would change nothing. */
static bool has_smooth_normals(const ec_scene *scene)
{
    if (!scene->normals) return false;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t *i = scene->indices + 3 * (size_t)t;
        const float *a = scene->positions + 3 * (size_t)i[0], *b = scene->positions + 3 * (size_t)i[1],
                    *c = scene->positions + 3 * (size_t)i[2];
        double e[3], f[3];
        for (int k = 0; k < 3; k++) {
            e[k] = (double)b[k] - a[k];
            f[k] = (double)c[k] - a[k];
        }
        double n[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int v = 0; v < 3; v++) {
            const float *m = scene->normals + 3 * (size_t)i[v];
            if (m[0] == 0.0f && m[1] == 0.0f && m[2] == 0.0f) continue;
            /* Against the winding is flat as well: the kernels turn it round. 1e-6 is 0.08 degrees. */
            if (fabs(n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) < length * (1.0 - 1e-6)) return true;
        }
    }
    return false;
}

static bool has_vertex_colors(const ec_scene *scene)
{
    for (size_t i = 0; scene->colors && i < 4 * (size_t)scene->vertex_count; i++)
        if (scene->colors[i] != 1.0f) return true;
    return false;
}

static bool has_deep_images(const ec_scene *scene)
{
    for (uint32_t i = 0; i < scene->image_count; i++)
        if (scene->images[i].rgba16) return true;
    return false;
}

uint64_t ec_pack_features(const ec_scene *scene)
{
    uint64_t f = 0;
    bool *used = calloc(scene->material_count, sizeof *used);
    for (uint32_t t = 0; used && t < scene->triangle_count; t++) used[scene->triangle_material[t]] = true;
    for (uint32_t m = 0; m < scene->material_count; m++)
        if (!used || used[m]) f |= material_features(scene, &scene->materials[m]);
    free(used);
    if (scene->placed_count) f |= EC_FEATURE_INSTANCES;
    if (f & (EC_FEATURE_TRANSMISSION | EC_FEATURE_DIFFUSE_TRANSMISSION)) {
        ec_bodies bodies;
        ec_pack_find_bodies(scene, &bodies);
        /* Walls that are not there have one direction, in which all passes. */
        if (bodies.count) f |= EC_FEATURE_NESTED | EC_FEATURE_SPECULAR | EC_FEATURE_SMOOTH | EC_FEATURE_TRANSMISSION;
    }
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (max3(scene->lights[i].intensity) > 0.0f) f |= EC_FEATURE_PUNCTUAL_LIGHTS;
    if (scene->has_environment) {
        const ec_environment *e = &scene->environment;
        if (e->rgb)
            f |= EC_FEATURE_ENVIRONMENT | EC_FEATURE_ENVIRONMENT_MAP | (e->turned ? EC_FEATURE_ENVIRONMENT_TURN : 0);
        else if (max3(e->constant) > 0.0f)
            f |= EC_FEATURE_ENVIRONMENT;
    }
    if (has_smooth_normals(scene)) f |= EC_FEATURE_SMOOTH_NORMALS;
    if (has_vertex_colors(scene)) f |= EC_FEATURE_VERTEX_COLORS;
    if ((f & EC_FEATURES_TEXTURED) && has_deep_images(scene)) f |= EC_FEATURE_FLOAT_TEXTURE;
    return f;
}
