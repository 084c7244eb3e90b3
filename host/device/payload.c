/* Lists what a payload holds and fills it: params first, then buffers. */
#include "device/payload.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/freed.h"
#include "device/ahead.h"
#include "device/light_batch.h"
#include "device/light_share.h"
#include "device/pipeline.h"
#include "device/pixel_filter.h"
#include "pack/bulbs.h"
#include "pack/distribution.h"
#include "pack/lamp_pairs.h"
#include "scene/texels.h"

static void add_accel_buffers(ec_payload *payload, uint32_t which, const ec_accel *accel, bool owned)
{
    char label[64];
    for (uint32_t k = 0; k < EC_ACCEL_BUFFERS; k++) {
        const ec_accel_buffer *buffer = &accel->buffers[k];
        uint32_t before = payload->head.buffer_count;
        snprintf(label, sizeof label, "%s %s", ec_accels[which].name, buffer->label);
        ec_payload_add(payload, EC_ARG_ACCEL + k, label, buffer->bytes, 0, buffer->data, owned ? buffer->data : NULL);
        if (payload->head.buffer_count > before) payload->buffers[before].accel = which;
    }
}

ec_result ec_payload_add_accel(ec_payload *payload, uint32_t which, ec_accel_input *input, ec_accel_stats *stats, ec_error *err)
{
    ec_accel accel = {0};
    EC_TRY(ec_accel_build(which, input, &accel, err));
    add_accel_buffers(payload, which, &accel, true);
    if (stats) *stats = accel.stats;
    return EC_OK;
}

static ec_result choose_accels(ec_payload_head *head, const ec_scene *scene, const char *name, uint32_t kinds, ec_error *err)
{
    if (scene->placed_count) name = "twolevel"; /* the others would have had them written out */
    for (uint32_t kind = 0; kind < EC_KIND_COUNT; kind++)
        if (kinds >> kind & 1) EC_TRY(ec_accels_choose(name, scene->triangle_count, kind == EC_KIND_CPU, &head->accels[kind], err));
    return EC_OK;
}

/* The structures stay in `followed`, for the next render to follow. */
static ec_result follow_accels(ec_payload *payload, ec_followed *followed, ec_accel_input *input, uint32_t wanted, ec_error *err)
{
    EC_TRY(ec_accels_follow(followed, input, wanted, err));
    for (uint32_t a = 0; a < EC_ACCEL_COUNT; a++)
        if (wanted >> a & 1) add_accel_buffers(payload, a, &followed->accels[a], false);
    return EC_OK;
}

static ec_result add_accels(ec_payload *payload, const ec_scene *scene, const ec_render_options *o, ec_error *err)
{
    ec_accel_input input = ec_accel_input_of(scene, o->grid_density);
    uint32_t wanted = 0;
    ec_result result = EC_OK;
    for (uint32_t kind = 0; kind < EC_KIND_COUNT; kind++) wanted |= payload->head.accels[kind];
    if (o->followed) result = follow_accels(payload, o->followed, &input, wanted, err);
    for (uint32_t a = 0; !o->followed && result == EC_OK && a < EC_ACCEL_COUNT; a++)
        if (wanted >> a & 1) result = ec_payload_add_accel(payload, a, &input, NULL, err);
    ec_accel_input_free(&input);
    return result;
}

static ec_result add_filter(ec_payload *payload, const ec_render_options *o, ec_error *err)
{
    if (o->filter == EC_FILTER_BOX) return EC_OK;
    float *table = malloc(EC_FILTER_ENTRIES * sizeof *table);
    if (!table) return ec_fail(err, "out of memory for a pixel filter");
    ec_pixel_filter_blackman_harris(o->filter_width > 0 ? o->filter_width : EC_FILTER_WIDTH, table);
    ec_payload_add(payload, EC_ARG_PIXEL_FILTER, "pixel filter", EC_FILTER_ENTRIES * sizeof *table, 0, table, table);
    return EC_OK;
}

/* Adds a table of group numbers: the environment's, then each light's, then each material's. */
static ec_result add_light_groups(ec_payload *payload, const ec_render_options *o, ec_error *err)
{
    const ec_light_groups *groups = o->groups;
    const ec_pack *pack = &payload->pack;
    const uint32_t lights = payload->head.params.light_count, count = 1 + lights + pack->material_count;
    if (!o->layers.group_count) return EC_OK;
    uint32_t *table = malloc(count * sizeof *table);
    if (!table) return ec_fail(err, "out of memory for light groups");
    table[0] = groups->environment;
    for (uint32_t i = 0; i < lights; i++) {
        const ec_light_data *l = &pack->lights[i];
        const uint32_t kind = l->kind & EC_LIGHT_KIND_MASK;
        table[1 + i] = kind == EC_KIND_TRIANGLE      ? groups->of_material[pack->prims[l->prim].material]
                       : kind == EC_KIND_ENVIRONMENT ? groups->environment
                                                     : groups->of_light[pack->light_source[i]];
    }
    memcpy(table + 1 + lights, groups->of_material, pack->material_count * sizeof *table);
    ec_payload_add(payload, EC_ARG_LIGHT_GROUPS, "light groups", count * sizeof *table, 0, table, table);
    return EC_OK;
}

/* Adds the table of nodes' triangles, laid out as lib/features.h reads it. */
static ec_result add_parts(ec_payload *payload, const ec_scene *scene, const ec_render_options *o, ec_error *err)
{
    const bool begins = scene->part_count && !scene->parts[0].first;
    const uint32_t count = scene->part_count + !begins, before = count - scene->part_count;
    if (!o->layers.mattes) return EC_OK;
    uint32_t *table = calloc(2 + 2 * (size_t)count, sizeof *table), step = 1;
    if (!table) return ec_fail(err, "out of memory for %u nodes", count);
    while (2 * step < count) step *= 2;
    table[0] = count, table[1] = step;
    for (uint32_t i = 0; i < scene->part_count; i++) {
        const ec_part *part = &scene->parts[i];
        table[2 + before + i] = part->first;
        table[2 + count + before + i] = part->node == EC_NO_NODE ? 0 : part->node + 1;
    }
    ec_payload_add(payload, EC_ARG_PARTS, "nodes of triangles", (2 + 2 * (uint64_t)count) * sizeof *table, 0, table, table);
    return EC_OK;
}

/* Returns whether paths sample lamps that stand still. Bounds and sides of moving lamps would hold for one moment only. */
static bool joins_still_lamps(const ec_render_options *o, const ec_pack *pack)
{
    return o->integrator == EC_INTEGRATOR_PATH && ec_pipeline_joins(o, pack) && !pack->lamps_move;
}

/* Prepares how lamps are chosen: by a tree, or by power and in pairs. */
static ec_result prepare_lamps(const ec_render_options *o, ec_pack *pack, ec_error *err)
{
    if (!joins_still_lamps(o, pack)) return EC_OK;
    if (o->light_choice == EC_LIGHTS_BY_POWER) return ec_pack_lamp_pairs(pack, err);
    EC_FREED uint32_t *root = malloc((pack->light_count + (size_t)1) * sizeof *root);
    if (!root) return ec_fail(err, "out of memory for %u lights", pack->light_count);
    EC_TRY(ec_lamp_bodies(pack, root, err));
    pack->by_tree = true;
    if (o->light_choice == EC_LIGHTS_AUTO) EC_TRY(ec_pack_wants_light_tree(pack, root, &pack->by_tree, err));
    return pack->by_tree ? ec_pack_bulbs(pack, root, err) : ec_pack_lamp_pairs(pack, err);
}

/* Packs a scene. called_for: the scene itself or, if that was written out, the one with instances: rounding may not change effects. Which faces lie
 * in one plane is found in the world, for both. */
static ec_result fill_pack(const ec_scene *scene, const ec_scene *called_for, const ec_render_options *o, ec_pack *pack,
                           ec_error *err)
{
    EC_TRY(ec_pack_scene(scene, pack, err));
    if (called_for != scene) {
        ec_effects here = pack->effects;
        here.bits &= EC_FEATURE_COPLANAR;
        EC_TRY(ec_scene_calls(called_for, &pack->effects, err));
        pack->effects.bits &= ~EC_FEATURE_INSTANCES;
        ec_effects_add(&pack->effects, &here);
    }
    EC_TRY(prepare_lamps(o, pack, err));
    const ec_aim aim = o->integrator == EC_INTEGRATOR_LIGHT ? EC_AIM_SCENE : o->guiding ? EC_AIM_CASTERS_AND_SCENE : EC_AIM_CASTERS;
    if (o->light_paths > 0 || o->guiding) EC_TRY(ec_pack_casters(pack, aim, err));
    if (o->light_paths == EC_LIGHT_PATHS_AUTO) EC_TRY(ec_pack_caster_flux(pack, err));
    if (!ec_traces_paths(o->integrator)) EC_TRY(ec_pack_light_centres(&pack->plain.scene, pack, err));
    return EC_OK;
}

/* Does the part of packing that takes time and does not matter to effects. */
static ec_result finish_pack(ec_pack *pack, ec_error *err)
{
    EC_TRY(ec_pack_texels(pack, err));
    return pack->by_tree ? ec_pack_light_tree(pack, err) : EC_OK;
}

/* Begins to build kernels. The tree of lights is still to be built, but it is known whether there is one. */
static void build_ahead(ec_cl *alone, const ec_payload *payload, const ec_render_options *o, uint32_t batch)
{
    ec_render_effects effects = {.buffer_count = 0};
    ec_pack pack = payload->pack; /* its arrays are the payload's */
    pack.light_node_count = pack.by_tree;
    ec_pipeline_effects(o, &pack, &effects);
    ec_build_ahead(alone, payload, &effects, o->width, o->height, batch);
}

ec_result ec_payload_pack(ec_payload *payload, const ec_scene *scene, const ec_scene *called_for, const ec_render_options *o, ec_cl *alone, uint32_t batch,
                        ec_error *err)
{
    EC_TRY(fill_pack(scene, called_for, o, &payload->pack, err));
    if (alone) build_ahead(alone, payload, o, batch);
    EC_TRY(finish_pack(&payload->pack, err));
    ec_pipeline_effects(o, &payload->pack, &payload->head.effects);
    return EC_OK;
}

/* Sets roulette. A constant probability is used from the first surface on, as a first path tracer does it; the one that goes by throughput starts
 * late, since it tells least from bright short paths. Rounded down to a multiple of 2^-24, the step of the random numbers, so that what is divided
 * by is what is sampled, and nothing under 1 becomes 1, which would never end. */
static void set_roulette(double survival, ec_params *params)
{
    params->first_roulette = survival == 0.0 ? EC_ROULETTE_FIRST : survival < 1.0 ? 1 : UINT32_MAX;
    params->survival = survival == 0.0 ? 0.0f : (float)ldexp(fmax(floor(ldexp(survival, 24)), 1.0), -24);
}

static void set_environment(const ec_pack *pack, ec_params *params)
{
    const ec_scene *plain = &pack->plain.scene;
    params->environment_width = pack->environment_width;
    params->environment_height = pack->environment_height;
    params->environment_pmf = pack->environment_pmf;
    ec_stretch_words(pack->environment_stretch, params->environment_stretch);
    for (int k = 0; k < 3; k++)
        params->environment[k] = !plain->has_environment ? 0.0f : plain->environment.rgb ? 1.0f : plain->environment.constant[k];
    params->environment_turned = plain->has_environment && plain->environment.turned;
    for (int k = 0; k < 9; k++) params->environment_turn[k / 3 * 4 + k % 3] = plain->environment.turn[k];
    memcpy(params->environment_mean, pack->environment_mean, sizeof pack->environment_mean);
}

/* Sets light paths' parameters. Steps of the splats are so small that what they round off is 2^-30 of the mean radiance of the scene, about, and sums
 * of 2^33 times that fit. */
static void set_light_paths(const ec_render_options *o, const ec_pack *pack, uint64_t called, ec_params *params)
{
    int exponent;
    if (!pack->caster_count) return;
    frexp(pack->mean_radiance, &exponent);
    params->splat_unit = ldexpf(1, exponent - 31 < -120 ? -120 : exponent - 31);
    params->light_paths = called & EC_FEATURE_LIGHT_PATHS ? ec_light_paths_a_pixel(o->light_paths, o->width, o->height) : 0.0f;
    params->caster_count = pack->caster_count;
    for (uint32_t j = 0; j < pack->caster_count; j++) {
        memcpy(params->casters[j], pack->casters[j].centre, sizeof pack->casters[j].centre);
        params->casters[j][3] = pack->casters[j].radius;
        params->caster_share[j] = pack->casters[j].share;
    }
}

static void set_params(const ec_render_options *o, uint32_t batch, const ec_pack *pack, uint64_t called, ec_params *params)
{
    const uint32_t unlimited = o->integrator == EC_INTEGRATOR_WHITTED ? EC_WHITTED_DEPTH : UINT32_MAX - EC_SEGMENT;
    params->width = o->width;
    params->height = params->film_rows = o->height;
    params->batch = batch;
    params->max_depth = o->max_depth ? o->max_depth : unlimited;
    params->cutoff = (float)o->cutoff;
    params->backdrop = o->hides_environment;
    params->panes_count = ec_traces_paths(o->integrator);
    set_roulette(o->survival, params);
    params->sample = o->integrator == EC_INTEGRATOR_LIGHT ? EC_SAMPLE_LIGHT_PATHS : o->sample;
    params->apart = o->clamp > 0.0;
    params->limit = (float)o->clamp_luminance;
    params->light_count = ec_pipeline_joins(o, pack) ? pack->light_count : 0;
    set_environment(pack, params);
    params->nested = pack->bodies.count > 0;
    for (int k = 0; k < 3; k++) params->fog[k] = (float)o->fog[k];
    params->terminator = (called & EC_FEATURE_TERMINATOR) != 0;
    params->multiple = (called & EC_FEATURE_MULTISCATTER) != 0;
    params->light_choices = pack->light_choices;
    params->light_tree_numbers = pack->light_tree_numbers;
    set_light_paths(o, pack, called, params);
    if (pack->lights_are_halved) ec_light_share_set(params, o->far_share > 0 ? o->far_share : 0.5);
    params->layer_count = o->layers.count;
    for (int k = 0; k < EC_LAYER_KINDS; k++) params->layer_of[k] = ec_layers_find(&o->layers, k);
    params->layer_groups = ec_layers_groups(&o->layers);
    params->layer_ids = o->layers.mattes ? o->layers.count + 1 : 0;
    params->scene_radius = pack->scene_radius;
    params->scene_max = pack->scene_max;
}

/* Fills in the content. Where a scene is written out, takes the one with its meshes kept once, so that the job is the same with any accelerator. */
static ec_result tell_content(const ec_payload *payload, const ec_scene *scene, const ec_scene *called_for,
                              const ec_render_options *o, uint32_t batch, ec_content *content, ec_error *err)
{
    if (!o->identify) return EC_OK;
    if (scene == called_for) {
        ec_payload_content(&payload->head, scene, &payload->pack, content);
        return EC_OK;
    }
    ec_pack kept = {0};
    ec_payload_head head = payload->head;
    ec_result result = fill_pack(called_for, called_for, o, &kept, err);
    if (result == EC_OK) result = finish_pack(&kept, err);
    if (result == EC_OK) {
        ec_pipeline_effects(o, &kept, &head.effects);
        set_params(o, batch, &kept, head.effects.called.bits, &head.params);
        ec_payload_content(&head, called_for, &kept, content);
    }
    ec_pack_free(&kept);
    return result;
}

static ec_result add_packed(ec_payload *payload, const ec_scene *scene, const ec_scene *called_for,
                            const ec_render_options *o, uint32_t batch, ec_render_stats *stats, ec_error *err)
{
    ec_pack *pack = &payload->pack;
    ec_payload_head *head = &payload->head;
    set_params(o, batch, pack, head->effects.called.bits, &head->params);
    head->bodies_too_many = pack->bodies.too_many;
    EC_TRY(ec_insides_make(pack, head->effects.called.bits, &payload->insides, err));
    head->params.camera_medium = ec_insides_of(&payload->insides, &scene->cameras[o->camera]);
    EC_TRY(tell_content(payload, scene, called_for, o, batch, &stats->content, err));
    EC_TRY(ec_payload_add_scene(payload, scene, pack, err));
    EC_TRY(ec_payload_add_camera(payload, scene, o, err));
    EC_TRY(add_light_groups(payload, o, err));
    EC_TRY(add_parts(payload, scene, o, err));
    return add_filter(payload, o, err);
}

static ec_result fill(ec_payload *payload, const ec_scene *scene, const ec_scene *called_for, const ec_render_options *o,
                      uint32_t batch, uint32_t kinds, ec_cl *alone, ec_render_stats *stats, ec_error *err)
{
    ec_payload_head *head = &payload->head;
    head->triangle_count = scene->triangle_count;
    head->integrator = o->integrator;
    head->replicates = ec_render_replicates(o);
    head->fast_math = o->fast_math;
    head->lanes = o->lanes;
    head->compile = o->compile;
    head->waves_until_fast = o->waves_until_fast;
    for (int k = 0; k < 3; k++) head->params.scene_centre[k] = (float)scene->center[k];
    head->wave = o->wave;
    if (scene->motion.segments && !ec_traces_paths(o->integrator))
        return ec_fail(err, "only the path tracer renders motion blur; leave out --shutter, or give --integrator path");
    EC_TRY(ec_pipeline_set_camera(&scene->cameras[o->camera], o, &head->params, err));
    const bool traces = o->integrator != EC_INTEGRATOR_RASTER;
    if (traces) EC_TRY(choose_accels(head, scene, o->accel, kinds, err));
    double start = ec_now();
    EC_TRY(ec_payload_pack(payload, scene, called_for, o, alone, batch, err));
    stats->pack_seconds = ec_now() - start;
    start = ec_now();
    if (traces) EC_TRY(add_accels(payload, scene, o, err));
    if (traces && o->followed) stats->followed = o->followed->report;
    stats->accel_seconds = ec_now() - start;
    start = ec_now();
    EC_TRY(add_packed(payload, scene, called_for, o, batch, stats, err));
    stats->pack_seconds += ec_now() - start;
    stats->replicates = head->replicates;
    stats->instances = scene->placed_count;
    stats->triangles = ec_scene_met_count(scene);
    stats->stored_triangles = scene->triangle_count;
    stats->effects = head->effects;
    for (uint32_t i = 0; i < head->buffer_count; i++) stats->scene_bytes += payload->buffers[i].bytes;
    return EC_OK;
}

ec_result ec_payload_choose(ec_payload *payload, const ec_scene **scene, const ec_scene **called_for,
                          const ec_render_options *o, ec_error *err)
{
    if (o->without) {
        EC_TRY(ec_scene_view_without(*scene, o->without, (int64_t)o->without_of - 1, &payload->view, err));
        *scene = &payload->view.scene;
    }
    /* Meshes that are kept once are written out where an accelerator or an integrator knows one level only. */
    bool keeps = o->integrator != EC_INTEGRATOR_RASTER && (!o->accel || !strcmp(o->accel, "auto") || !strcmp(o->accel, "twolevel"));
    *called_for = *scene;
    if ((*scene)->placed_count && !keeps) {
        EC_TRY(ec_scene_write_out(*scene, &payload->written, err));
        *scene = &payload->written;
    }
    return EC_OK;
}

ec_result ec_payload_make(const ec_scene *scene, const ec_render_options *o, uint32_t batch, uint32_t kinds, ec_cl *alone, ec_payload *payload,
                        ec_render_stats *stats, ec_error *err)
{
    const ec_scene *called_for;
    memset(payload, 0, sizeof *payload);
    EC_TRY(ec_payload_choose(payload, &scene, &called_for, o, err));
    return fill(payload, scene, called_for, o, batch, kinds, alone, stats, err);
}

void ec_payload_buffer_free(ec_payload_buffer *buffer)
{
    free(buffer->owned);
    ec_texels_leave(buffer->texels);
    buffer->owned = NULL;
    buffer->texels = NULL;
}

void ec_payload_free(ec_payload *payload)
{
    for (uint32_t i = 0; i < payload->head.buffer_count; i++) ec_payload_buffer_free(&payload->buffers[i]);
    payload->head.buffer_count = 0;
    ec_insides_free(&payload->insides);
    ec_pack_free(&payload->pack);
    ec_scene_written_free(&payload->written);
    ec_scene_view_free(&payload->view);
}
