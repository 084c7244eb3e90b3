/* Decides which of the scene's data go to a device, and for which effects. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "device/payload.h"
#include "device/pipeline.h"
#include "scene/texels.h"

uint32_t ec_upload_plan(const ec_scene *s, const ec_pack *pack, ec_upload plan[EC_SCENE_BUFFERS], ec_render_effects *effects)
{
    const uint64_t vertices = s->vertex_count, triangles = s->triangle_count, lights = pack->light_count;
    const uint64_t map_rows = pack->environment_height + 1ull, texels = pack->environment_width * map_rows;
    const uint64_t light = EC_FEATURE_AREA_LIGHTS | EC_FEATURE_PUNCTUAL_LIGHTS | EC_FEATURE_ENVIRONMENT;
    const uint64_t prims = pack->prim_count ? pack->prim_count : 1; /* kernels read the first one where a ray met none */
    const ec_upload all[] = {
        {EC_ARG_PRIMS, pack->prims, 0, {"triangles", 0, prims * sizeof *pack->prims}},
        {EC_ARG_MATERIALS, pack->materials, 0, {"materials", 0, pack->material_count * sizeof *pack->materials}},
        {EC_ARG_PLACES, pack->places, 0, {"places of instances", EC_FEATURE_INSTANCES, pack->place_words * 4ull}},
        {EC_ARG_MOTION, pack->motion, 0, {"keys of what moves", EC_FEATURE_MOTION, pack->motion_words * 4ull}},
        {EC_ARG_COPLANAR, pack->coplanar, 0, {"faces in one plane", EC_FEATURE_COPLANAR, pack->coplanar_words * 4ull}},
        {EC_ARG_SRGB, pack->srgb, 0, {"sRGB table", 0, sizeof pack->srgb}},
        {EC_ARG_INDICES, s->indices, 16, {"indices", EC_FEATURES_ATTRIBUTES, 12 * triangles}},
        {EC_ARG_NORMALS, s->normals, 16, {"normals", EC_FEATURE_SMOOTH_NORMALS, s->normals ? 12 * vertices : 0}},
        {EC_ARG_TANGENTS, s->tangents, 0, {"tangents", EC_FEATURES_TANGENTS, s->tangents ? 16 * vertices : 0}},
        {EC_ARG_COLORS, s->colors, 0, {"colours", EC_FEATURE_VERTEX_COLORS, s->colors ? 16 * vertices : 0}},
        {EC_ARG_UVS, NULL, 0, {"texture coordinates", EC_FEATURES_UV, s->uv[0] || s->uv[1] ? 16 * vertices : 0}},
        {EC_ARG_TEXTURE_TABLE, pack->textures, 0, {"textures", EC_FEATURES_TEXTURED, pack->texture_count * sizeof *pack->textures}},
        {EC_ARG_TEXELS, pack->texels ? pack->texels->words : NULL, 4, {"texels", EC_FEATURES_TEXTURED, pack->texel_words * 4}},
        {EC_ARG_LIGHT_TABLE, pack->lights, 0, {"lights", light, lights * sizeof *pack->lights}},
        {EC_ARG_LIGHT_SHARES, pack->light_shares, 0, {"light table", light, pack->light_choices * sizeof *pack->light_shares}},
        {EC_ARG_ENVIRONMENT_TEXELS, pack->environment_texels, 0, {"environment map", EC_FEATURE_ENVIRONMENT_MAP, texels * 16}},
        {EC_ARG_ENVIRONMENT_TABLE, pack->environment_table, 0,
         {"environment table", EC_FEATURE_ENVIRONMENT_MAP, (texels + map_rows) * sizeof *pack->environment_table}},
        {EC_ARG_LIGHT_TREE, pack->light_tree, 0, {"light tree", EC_FEATURE_LIGHT_TREE, pack->light_node_count * sizeof *pack->light_tree}},
        {EC_ARG_LAMP_PARTS, pack->lamp_nodes, 0, {"parts of lamps", EC_FEATURE_LAMP_PARTS, pack->lamp_node_count * sizeof *pack->lamp_nodes}},
        {EC_ARG_EMISSION, pack->emission, 0, {"lights of light paths", EC_FEATURES_FROM_LIGHTS, pack->emission_words * sizeof *pack->emission}},
        {EC_ARG_LIGHT_TRAILS, pack->light_of_prim, 0,
         {"trails of lamps", EC_FEATURE_LIGHT_TREE, pack->light_node_count ? (uint64_t)pack->prim_count * sizeof *pack->light_of_prim : 0}},
        {EC_ARG_LIGHT_TRAILS, pack->pair_of_prim, 0, /* a scene never has both */
         {"pairs of lamps", EC_FEATURE_LAMP_PAIRS, pack->pair_of_prim ? (uint64_t)pack->prim_count * sizeof *pack->pair_of_prim : 0}},
    };
    const uint32_t count = sizeof all / sizeof *all;
    effects->buffer_count = count;
    for (uint32_t i = 0; i < count; i++) {
        plan[i] = all[i];
        uint64_t for_whom = plan[i].buffer.effects; /* universal kernels, too, get NULL for what is not called for */
        if ((for_whom && !(effects->called.bits & for_whom)) || (!plan[i].data && plan[i].arg != EC_ARG_UVS))
            plan[i].buffer.bytes = 0;
        if (plan[i].buffer.bytes) plan[i].buffer.bytes += plan[i].slack;
        effects->buffers[i] = plan[i].buffer;
    }
    return count;
}

void ec_payload_add(ec_payload *payload, uint32_t arg, const char *label, uint64_t bytes, uint64_t slack, const void *data, void *owned)
{
    if (!data) return;
    ec_payload_buffer *buffer = &payload->buffers[payload->head.buffer_count++];
    *buffer = (ec_payload_buffer){.arg = arg, .accel = EC_ACCEL_COUNT, .bytes = bytes, .slack = slack, .data = data, .owned = owned};
    snprintf(buffer->label, sizeof buffer->label, "%s", label);
}

/* Adds both uv sets side by side. They must be finite and small enough for the kernels' integer texels. */
static ec_result add_uvs(ec_payload *payload, const ec_scene *scene, const ec_upload *u, ec_error *err)
{
    float *uvs = calloc(4 * (size_t)scene->vertex_count, sizeof *uvs);
    if (!uvs) return ec_fail(err, "out of memory for texture coordinates of %u vertices", scene->vertex_count);
    for (int set = 0; set < 2; set++)
        for (size_t i = 0; scene->uv[set] && i < 2 * (size_t)scene->vertex_count; i++) {
            float c = scene->uv[set][i];
            uvs[4 * (i / 2) + 2 * set + i % 2] = isfinite(c) ? fminf(fmaxf(c, -1e6f), 1e6f) : 0.0f;
        }
    ec_payload_add(payload, u->arg, u->buffer.label, u->buffer.bytes, 0, uvs, uvs);
    return EC_OK;
}

ec_result ec_payload_add_scene(ec_payload *payload, const ec_scene *scene, ec_pack *pack, ec_error *err)
{
    ec_upload plan[EC_SCENE_BUFFERS];
    uint32_t count = ec_upload_plan(scene, pack, plan, &payload->head.effects);
    for (uint32_t i = 0; i < count; i++) {
        const ec_upload *u = &plan[i];
        uint64_t bytes = u->buffer.bytes;
        if (!bytes) continue; /* an absent stream stays NULL */
        void *owned = u->arg == EC_ARG_PRIMS ? pack->prims : NULL;
        if (u->arg == EC_ARG_UVS) EC_TRY(add_uvs(payload, scene, u, err));
        else ec_payload_add(payload, u->arg, u->buffer.label, bytes - u->slack, u->slack, u->data, owned);
        if (u->arg == EC_ARG_TEXELS) { /* the payload's from here on */
            payload->buffers[payload->head.buffer_count - 1].texels = pack->texels;
            pack->texels = NULL;
        }
        if (u->arg == EC_ARG_PRIMS) pack->prims_lent = true;
    }
    return EC_OK;
}

ec_accel_input ec_accel_input_of(const ec_scene *scene, float grid_density)
{
    return (ec_accel_input){.positions = scene->positions, .indices = scene->indices, .triangle_count = ec_scene_flat_count(scene),
                            .vertex_count = scene->vertex_count,
                            .whole = scene->whole, .shape_count = scene->shape_count, .shapes = scene->shapes,
                            .swept = scene->motion.swept, .swept_count = scene->motion.segments ? scene->motion.triangle_count : 0,
                            .placed_count = scene->placed_count, .placed = scene->placed, .grid_density = grid_density};
}
