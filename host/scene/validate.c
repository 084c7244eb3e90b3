/* The promises of scene.h, checked. */
#include "scene/validate.h"
#include "base/text.h"

#include <math.h>

static bool clamp(float *value, float low, float high)
{
    float old = *value;
    *value = old >= low ? (old <= high ? old : high) : low; /* NaN becomes low */
    return *value != old;
}

void ec_scene_clamp_materials(ec_scene *s, const char *path, const ec_log *log)
{
    for (uint32_t i = 0; i < s->material_count; i++) {
        ec_material *m = &s->materials[i];
        bool changed = clamp(&m->metallic, 0, 1) | clamp(&m->roughness, 0, 1) | clamp(&m->specular, 0, 1);
        for (int k = 0; k < 4; k++) changed |= clamp(&m->base_color[k], 0, 1);
        for (int k = 0; k < 3; k++) changed |= clamp(&m->emission[k], 0, EC_RADIANCE_MOST) | clamp(&m->specular_color[k], 0, 1e30f);
        changed |= clamp(&m->transmission, 0, 1) | clamp(&m->coat, 0, 1) | clamp(&m->coat_roughness, 0, 1);
        changed |= clamp(&m->coat_normal_scale, -1e30f, 1e30f) | clamp(&m->sheen_roughness, 0, 1);
        changed |= clamp(&m->anisotropy, 0, 1) | clamp(&m->anisotropy_rotation, -7, 7);
        changed |= clamp(&m->diffuse_transmission, 0, 1) | clamp(&m->dispersion, 0, 1e3f);
        for (int k = 0; k < 3; k++) changed |= clamp(&m->transmission_color[k], 0, 1);
        changed |= clamp(&m->film, 0, 1) | clamp(&m->film_ior, 1, 1e3f) | clamp(&m->film_least, 0, 1e6f) |
                   clamp(&m->film_most, 0, 1e6f);
        for (int k = 0; k < 3; k++) changed |= clamp(&m->sheen[k], 0, 1);
        if (m->ior != 0) changed |= clamp(&m->ior, 1, 1e3f);
        changed |= clamp(&m->alpha_cutoff, 0, 1e30f) | clamp(&m->normal_scale, -1e30f, 1e30f);
        for (int slot = 0; slot < EC_SLOT_COUNT; slot++)
            for (int k = 0; k < 6; k++) changed |= clamp(&m->textures[slot].transform[k], -EC_UV_MOST, EC_UV_MOST);
        if (changed)
            ec_warn(log, "%s: materials[%u] \"%.*s\" has factors out of glTF's range; they are clamped", path, i,
                    EC_CUT(m->name ? m->name : "", 80));
    }
}

static bool all_finite(const float *values, uint64_t count)
{
    for (uint64_t i = 0; values && i < count; i++)
        if (!isfinite(values[i])) return false;
    return true;
}

static bool unit_or_zero(const float *v)
{
    double length = sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
    return length == 0 || fabs(length - 1) < 1e-5;
}

static ec_result check_vertices(const ec_scene *s, ec_error *err)
{
    uint64_t n = s->vertex_count;
    for (int i = 0; i < EC_STREAMS; i++)
        if (!all_finite(ec_scene_stream(s, i), ec_stream_width[i] * n)) return ec_fail(err, "internal error: a vertex stream is not finite");
    for (uint64_t i = 0; i < n; i++) {
        if (s->normals && !unit_or_zero(s->normals + 3 * i))
            return ec_fail(err, "internal error: normal %llu is not unit", (unsigned long long)i);
        if (s->tangents && !unit_or_zero(s->tangents + 4 * i))
            return ec_fail(err, "internal error: tangent %llu is not unit", (unsigned long long)i);
    }
    return EC_OK;
}

static ec_result check_triangles(const ec_scene *s, ec_error *err)
{
    for (uint64_t i = 0; i < 3 * (uint64_t)s->triangle_count; i++)
        if (s->indices[i] >= s->vertex_count) return ec_fail(err, "internal error: vertex index out of range");
    for (uint32_t i = 0; i < s->triangle_count; i++)
        if (s->triangle_material[i] >= s->material_count)
            return ec_fail(err, "internal error: material index out of range");
    return EC_OK;
}

static ec_result check_material(const ec_scene *s, const ec_material *m, ec_error *err)
{
    for (int i = 0; i < EC_SLOT_COUNT; i++) {
        const ec_texture_use *use = &m->textures[i];
        if (use->texture >= (int64_t)s->texture_count || use->uv_set > 1)
            return ec_fail(err, "internal error: texture use out of range");
        if (!all_finite(use->transform, 6)) return ec_fail(err, "internal error: texture transform is not finite");
        if (use->texture >= 0 && !s->uv[use->uv_set]) return ec_fail(err, "internal error: texture without coordinates");
    }
    bool finite = all_finite(m->base_color, 4) && all_finite(m->emission, 3) && all_finite(m->specular_color, 3) &&
                  all_finite(m->absorption, 3) && isfinite(m->normal_scale) && isfinite(m->alpha_cutoff);
    return finite ? EC_OK : ec_fail(err, "internal error: a material is not finite");
}

static ec_result check_images(const ec_scene *s, ec_error *err)
{
    for (uint32_t i = 0; i < s->texture_count; i++)
        if (s->textures[i].image >= s->image_count) return ec_fail(err, "internal error: image index out of range");
    for (uint32_t i = 0; i < s->image_count; i++) {
        const ec_image *image = &s->images[i];
        if (!image->width || !image->height || !image->rgba8 == !image->rgba16)
            return ec_fail(err, "internal error: image %u has no pixels", i);
    }
    return EC_OK;
}

static ec_result check_cameras_and_lights(const ec_scene *s, ec_error *err)
{
    if (!s->camera_count || s->default_camera >= s->camera_count) return ec_fail(err, "internal error: no camera");
    for (uint32_t i = 0; i < s->camera_count; i++) {
        const ec_camera *c = &s->cameras[i];
        if (!all_finite(c->position, 3) || !unit_or_zero(c->right) || !unit_or_zero(c->up) || !unit_or_zero(c->forward))
            return ec_fail(err, "internal error: camera %u has no frame", i);
    }
    for (uint32_t i = 0; i < s->light_count; i++)
        if (!all_finite(s->lights[i].position, 3) || !all_finite(s->lights[i].intensity, 3) ||
            !unit_or_zero(s->lights[i].direction))
            return ec_fail(err, "internal error: light %u is not finite", i);
    return EC_OK;
}

ec_result ec_scene_validate(const ec_scene *s, ec_error *err)
{
    if (!s->material_count) return ec_fail(err, "internal error: a scene without a material");
    EC_TRY(check_vertices(s, err));
    EC_TRY(check_triangles(s, err));
    for (uint32_t i = 0; i < s->material_count; i++) EC_TRY(check_material(s, &s->materials[i], err));
    EC_TRY(check_images(s, err));
    return check_cameras_and_lights(s, err);
}
