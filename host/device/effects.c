#include "device/effects.h"

#include <stdio.h>
#include <string.h>

#include "device/pipeline.h"

/* If paths pass panes, shadow rays must too. Light paths do not scatter inside bodies, so with --integrator light camera paths do not, either. */
static uint64_t never_built(const ec_render_options *o, uint64_t without)
{
    return (without & EC_FEATURE_PANES ? EC_FEATURE_PANES | EC_FEATURE_MATCHED : 0) |
           (o->integrator == EC_INTEGRATOR_LIGHT ? EC_FEATURE_SCATTERING | EC_FEATURE_FOG : 0);
}

static void call_light_paths(const ec_render_options *o, const ec_pack *pack, ec_effects *called)
{
    if (o->integrator == EC_INTEGRATOR_LIGHT) ec_effects_call(called, EC_FEATURE_LIGHT_PATHS, "--integrator light"); /* camera paths need it, too */
    else if (pack->caster_count && o->light_paths > 0 && !(called->bits & EC_FEATURE_SCATTERING)) /* which light paths do not follow */
        ec_effects_call(called, EC_FEATURE_LIGHT_PATHS, "--light-paths %g, aimed at %u bodies that bend or mirror light", o->light_paths,
                        pack->caster_count);
}

void ec_pipeline_effects(const ec_render_options *options, const ec_pack *pack, ec_render_effects *effects)
{
    ec_effects *called = &effects->called;
    *called = pack->effects;
    if (options->scattering == EC_SCATTERING_MULTIPLE) ec_pack_rough(&pack->plain.scene, called);
    effects->without = options->without_of ? 0 : options->without;
    effects->never = never_built(options, effects->without);
    if (options->sampler == EC_SAMPLER_SOBOL) ec_effects_call(called, EC_FEATURE_SOBOL, "--sampler sobol");
    if (options->terminator == EC_TERMINATOR_SMOOTH && (called->bits & EC_FEATURE_SMOOTH_NORMALS))
        ec_effects_call(called, EC_FEATURE_TERMINATOR, "--terminator smooth, and there are vertex normals");
    if (pack->light_node_count) ec_effects_call(called, EC_FEATURE_LIGHT_TREE, "%u lights are chosen among", pack->light_count);
    if (pack->lamp_node_count && options->integrator == EC_INTEGRATOR_PATH && ec_pipeline_joins(options, pack))
        ec_effects_call(called, EC_FEATURE_LAMP_PARTS, "lamps in %u parts, as their textures vary", 3 * pack->lamp_node_count);
    if (pack->bulb_count)
        ec_effects_call(called, EC_FEATURE_LAMP_PAIRS, "%u lamps of many triangles are chosen as one from afar", pack->bulb_count);
    else if (pack->lamp_pair_count)
        ec_effects_call(called, EC_FEATURE_LAMP_PAIRS, "%u pairs of lamps face opposite ways", pack->lamp_pair_count);
    static const uint64_t of_fog[] = {EC_FEATURE_FOG, EC_FEATURE_SCATTERING, EC_FEATURE_ABSORPTION};
    for (int i = 0; options->fog[0] > 0 && i < 3; i++) ec_effects_call(called, of_fog[i], "--fog %g,%g,%g", options->fog[0], options->fog[1], options->fog[2]);
    call_light_paths(options, pack, called); /* after all that scatters inside bodies */
    if (pack->caster_count && options->guiding) ec_effects_call(called, EC_FEATURE_GUIDING, "--guiding, by light paths to %u bodies that bend or mirror light", pack->caster_count - 1);
    if (options->layers.count) ec_effects_call(called, EC_FEATURE_LAYERS, "--channels or --light-groups: %u layers", options->layers.count);
    else if (options->layers.mattes) ec_effects_call(called, EC_FEATURE_LAYERS, "--channels cryptomatte");
    if (ec_layers_find(&options->layers, EC_LAYER_UV)) ec_effects_call(called, EC_FEATURE_UV, "--channels uv");
    if (options->filter != EC_FILTER_BOX) ec_effects_call(called, EC_FEATURE_PIXEL_FILTER, "--filter");
    if (options->fstop > 0) ec_effects_call(called, EC_FEATURE_LENS, "--fstop %g", (double)options->fstop);
    effects->built = options->all_effects ? ec_universal_features(effects) : called->bits | options->more_effects;
    effects->built &= ~effects->never;
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++)
        if (ec_stage_is_of(&ec_stages[id], options->integrator, called->bits)) effects->launched |= 1u << id;
    if (!ec_pipeline_joins(options, pack)) effects->launched &= ~(1u << EC_CONNECT | 1u << EC_WHITTED_LIGHT);
}

uint64_t ec_universal_features(const ec_render_effects *effects)
{
    const uint64_t all = effects->called.bits | (EC_FEATURE_ALL & ~(EC_FEATURE_SOBOL | EC_FEATURES_FROM_LIGHTS | EC_FEATURE_LAYERS)); /* these are other
                                                                                                                                       * ways, not more
                                                                                                                                       * effects */
    return all & ~effects->never;
}

/* Lights without extent are met in no other way, whatever --sample is. */
bool ec_pipeline_joins(const ec_render_options *options, const ec_pack *pack)
{
    bool asked = options->sample == EC_SAMPLE_MIS || options->sample == EC_SAMPLE_LIGHT;
    return pack->light_count && (asked || (pack->effects.bits & EC_FEATURE_PUNCTUAL_LIGHTS));
}

/* Alpha goes by base colour, panes by all of the surface; without them traversals do not read it. Stages that shade read the alpha of lamps alone. */
uint64_t ec_stage_features(const ec_stage_entry *stage, uint64_t features)
{
    uint64_t f = features & stage->features;
    const uint64_t of_alpha = EC_FEATURE_BASE_COLOR_TEXTURE | EC_FEATURE_VERTEX_COLORS | EC_FEATURE_FLOAT_TEXTURE;
    if (stage->features & EC_FEATURE_AREA_LIGHTS) return f & EC_FEATURE_AREA_LIGHTS ? f : f & ~EC_FEATURE_ALPHA;
    if (!(stage->features & EC_FEATURE_ALPHA) || (f & EC_FEATURE_PANES)) return f;
    return f & (EC_FEATURE_CULLING | EC_FEATURE_LIGHT_PATHS | EC_FEATURE_LAYERS | EC_FEATURE_SOBOL | EC_FEATURE_INSTANCES | EC_FEATURE_MOTION | EC_FEATURE_COPLANAR |
                (f & EC_FEATURE_ALPHA ? EC_FEATURE_ALPHA | of_alpha : 0));
}

static void add_word(char *text, size_t size, const char *word)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s", used ? ", " : "", word);
}

ec_effect_row ec_effect_describe(const ec_render_effects *effects, uint32_t i)
{
    uint64_t bit = ec_features[i].bit;
    ec_effect_row row = {.name = ec_features[i].name, .called = effects->called.bits & bit, .built = effects->built & bit,
                         .left_out = effects->without & bit};
    ec_effects_why(&effects->called, bit, row.why, sizeof row.why);
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++)
        if ((effects->launched >> id & 1) && (ec_stage_features(&ec_stages[id], effects->built) & bit))
            add_word(row.kernels, sizeof row.kernels, ec_stages[id].source);
    for (uint32_t k = 0; row.called && k < effects->buffer_count; k++) {
        const ec_scene_buffer *buffer = &effects->buffers[k];
        if (!(buffer->effects & bit) || !buffer->bytes) continue;
        add_word(row.buffers, sizeof row.buffers, buffer->label);
        row.bytes += buffer->bytes;
    }
    return row;
}

void ec_effects_kernels(const ec_render_effects *effects, char *text, size_t size)
{
    text[0] = 0;
    for (int id = 0; id < EC_STAGE_ID_COUNT; id++)
        if (effects->launched >> id & 1) add_word(text, size, ec_stages[id].source);
}
