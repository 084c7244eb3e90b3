/* The scene as device buffers. Host copies are freed as soon as the device has them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "pipeline/pipeline.h"
#include "pipeline/pixel_filter.h"

static ec_result upload(ec_pipeline *p, ec_arg arg, const char *label, uint64_t bytes, const void *data, ec_error *err)
{
    if (!data || !bytes) return EC_OK; /* an absent stream stays NULL */
    return ec_buffer_create(p->cl, label, bytes, data, &p->buffers[arg], err);
}

/* The same with 16 spare bytes behind the end, for streams that are read in fours of words but not made of them. */
static ec_result upload_padded(ec_pipeline *p, ec_arg arg, const char *label, uint64_t bytes, const void *data, ec_error *err)
{
    if (!data || !bytes) return EC_OK;
    EC_TRY(ec_buffer_create(p->cl, label, bytes + 16, NULL, &p->buffers[arg], err));
    return ec_buffer_write(p->cl, p->buffers[arg], 0, bytes, data, err);
}

/* Both sets side by side. They must be finite and small enough for the kernels' integer texels. */
static ec_result upload_uvs(ec_pipeline *p, const ec_scene *scene, ec_error *err)
{
    if (!scene->uv[0] && !scene->uv[1]) return EC_OK;
    float *uvs = calloc(4 * (size_t)scene->vertex_count, sizeof *uvs);
    if (!uvs) return ec_fail(err, "out of memory for texture coordinates of %u vertices", scene->vertex_count);
    for (int set = 0; set < 2; set++)
        for (size_t i = 0; scene->uv[set] && i < 2 * (size_t)scene->vertex_count; i++) {
            float c = scene->uv[set][i];
            uvs[4 * (i / 2) + 2 * set + i % 2] = isfinite(c) ? fminf(fmaxf(c, -1e6f), 1e6f) : 0.0f;
        }
    ec_result result = upload(p, EC_ARG_UVS, "texture coordinates", 16 * (uint64_t)scene->vertex_count, uvs, err);
    free(uvs);
    return result;
}

ec_result ec_pipeline_upload(ec_pipeline *p, const ec_scene *scene, const ec_pack *pack, ec_error *err)
{
    const uint64_t f = pack->features; /* also for universal kernels: what is not called for stays NULL */
    const bool textured = f & EC_FEATURES_TEXTURED;
    const uint64_t vertices = scene->vertex_count;
    EC_TRY(upload(p, EC_ARG_PRIMS, "triangles", (uint64_t)pack->prim_count * sizeof *pack->prims, pack->prims, err));
    EC_TRY(upload(p, EC_ARG_MATERIALS, "materials", (uint64_t)pack->material_count * sizeof *pack->materials, pack->materials, err));
    EC_TRY(upload(p, EC_ARG_PLACES, "places of instances", (uint64_t)pack->place_words * 4, pack->places, err));
    EC_TRY(upload(p, EC_ARG_SRGB, "sRGB table", sizeof pack->srgb, pack->srgb, err));
    if (f & EC_FEATURES_ATTRIBUTES)
        EC_TRY(upload_padded(p, EC_ARG_INDICES, "indices", 12 * (uint64_t)scene->triangle_count, scene->indices, err));
    if (f & EC_FEATURE_SMOOTH_NORMALS) EC_TRY(upload_padded(p, EC_ARG_NORMALS, "normals", 12 * vertices, scene->normals, err));
    if (f & EC_FEATURES_TANGENTS) EC_TRY(upload(p, EC_ARG_TANGENTS, "tangents", 16 * vertices, scene->tangents, err));
    if (f & EC_FEATURE_VERTEX_COLORS) EC_TRY(upload(p, EC_ARG_COLORS, "colours", 16 * vertices, scene->colors, err));
    if (textured) {
        EC_TRY(upload_uvs(p, scene, err));
        EC_TRY(upload(p, EC_ARG_TEXTURE_TABLE, "textures", (uint64_t)pack->texture_count * sizeof *pack->textures, pack->textures, err));
        EC_TRY(upload(p, EC_ARG_TEXELS, "texels", (uint64_t)pack->texel_words * 4, pack->texels, err));
    }
    EC_TRY(upload(p, EC_ARG_LIGHT_TABLE, "lights", (uint64_t)pack->light_count * sizeof *pack->lights, pack->lights, err));
    EC_TRY(upload(p, EC_ARG_LIGHT_ALIAS, "light table", (uint64_t)pack->light_count * sizeof *pack->light_alias, pack->light_alias, err));
    if (pack->light_node_count) {
        EC_TRY(upload(p, EC_ARG_LIGHT_TREE, "light tree", (uint64_t)pack->light_node_count * sizeof *pack->light_tree, pack->light_tree, err));
        EC_TRY(upload(p, EC_ARG_LIGHT_TRAILS, "trails of lamps", 4 * (uint64_t)pack->prim_count, pack->light_of_prim, err));
    }
    uint64_t texels = (uint64_t)pack->environment_width * pack->environment_height;
    EC_TRY(upload(p, EC_ARG_ENVIRONMENT_TEXELS, "environment map", texels * 16, pack->environment_texels, err));
    return upload(p, EC_ARG_ENVIRONMENT_TABLE, "environment table", (texels + pack->environment_height) * sizeof *pack->environment_table, pack->environment_table, err);
}

ec_result ec_pipeline_upload_filter(ec_pipeline *p, const ec_render_options *o, ec_error *err)
{
    float table[EC_FILTER_ENTRIES];
    if (o->filter == EC_FILTER_BOX) return EC_OK;
    ec_pixel_filter_blackman_harris(o->filter_width > 0 ? o->filter_width : EC_FILTER_WIDTH, table);
    return upload(p, EC_ARG_PIXEL_FILTER, "pixel filter", sizeof table, table, err);
}

ec_result ec_pipeline_upload_accel(ec_pipeline *p, uint32_t which, ec_accel_input *input, ec_accel_stats *stats, ec_error *err)
{
    ec_accel accel = {0};
    char label[64];
    ec_result result = ec_accel_build(which, input, &accel, err);
    for (int k = 0; result == EC_OK && k < EC_ACCEL_BUFFERS; k++) {
        const ec_accel_buffer *buffer = &accel.buffers[k];
        if (!buffer->data) continue;
        snprintf(label, sizeof label, "%s %s", ec_accels[which].name, buffer->label);
        result = ec_buffer_create(p->cl, label, buffer->bytes, buffer->data, &p->accels[which].buffers[k], err);
    }
    if (stats) *stats = accel.stats;
    ec_accel_free(&accel);
    return result;
}

ec_accel_input ec_accel_input_of(const ec_scene *scene, float grid_density)
{
    return (ec_accel_input){.positions = scene->positions, .indices = scene->indices, .triangle_count = ec_scene_flat_count(scene),
                            .whole = scene->whole, .shape_count = scene->shape_count, .shapes = scene->shapes,
                            .placed_count = scene->placed_count, .placed = scene->placed, .grid_density = grid_density};
}

ec_result ec_pipeline_upload_accels(ec_pipeline *p, const ec_scene *scene, float grid_density, ec_error *err)
{
    ec_accel_input input = ec_accel_input_of(scene, grid_density);
    ec_result result = EC_OK;
    for (uint32_t a = 0; result == EC_OK && a < EC_ACCEL_COUNT; a++)
        if (p->accels[a].in_use) result = ec_pipeline_upload_accel(p, a, &input, NULL, err);
    ec_accel_input_free(&input);
    return result;
}
