/* Checks the guarantees of scene.h. */
#include "scene/validate.h"
#include "base/text.h"
#include "scene/material_fields.h"

#include <math.h>

static bool clamp(float *value, float low, float high)
{
    float old = *value;
    *value = old >= low ? (old <= high ? old : high) : low; /* NaN becomes low */
    return *value != old;
}

static bool clamp_material(ec_material *m)
{
    bool changed = false;
    for (int i = 0; i < ec_material_field_count; i++) {
        const ec_material_field *f = &ec_material_fields[i];
        float *floats = ec_material_floats(m, f);
        for (int k = 0; k < f->floats; k++)
            if (floats != &m->ior || m->ior != 0) changed |= clamp(&floats[k], f->least, f->most);
    }
    for (int slot = 0; slot < EC_SLOT_COUNT; slot++)
        for (int k = 0; k < 6; k++) changed |= clamp(&m->textures[slot].transform[k], -EC_UV_MOST, EC_UV_MOST);
    return changed;
}

void ec_scene_clamp_materials(ec_scene *s, const char *path, const ec_log *log)
{
    for (uint32_t i = 0; i < s->material_count; i++) {
        const char *name = s->materials[i].name;
        if (clamp_material(&s->materials[i]))
            ec_warn(log, "%s: materials[%u] \"%.*s\" has factors out of glTF's range; they are clamped", path, i, EC_CUT(name ? name : "", 80));
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
            return ec_fail(err, "internal error: normal %llu is not a unit vector", (unsigned long long)i);
        if (s->tangents && !unit_or_zero(s->tangents + 4 * i))
            return ec_fail(err, "internal error: tangent %llu is not a unit vector", (unsigned long long)i);
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
    for (int i = 0; i < ec_material_field_count; i++)
        if (!all_finite((const float *)((const char *)m + ec_material_fields[i].at), (uint64_t)ec_material_fields[i].floats))
            return ec_fail(err, "internal error: a material is not finite");
    return EC_OK;
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
