/* The wave: how many paths are in flight, and the buffers that hold them. */
#include "cl/workarounds.h"
#include "device/pipeline.h"

#define EC_SMALLEST_WAVE 4096
#define LEAST_UNITS 4        /* of a queue: in the memory of so many, kernels of all effects, whose paths are larger, have room for at least one */
#define EC_UNIT_PATHS 32768  /* of a CPU's wave, for each of its cores: 2^16 to 2^18 in all */
#define EC_NARROW_WAVE 32768 /* at most, of narrow kernels */

/* Returns the floats of radiance in a slot: R, G, B, and again for indirect light where it is kept apart, or for each layer. */
static uint64_t radiance_fields(const ec_pipeline *p) { return p->params.apart ? 6 : 3 + 3 * p->params.layer_count + (p->params.layer_ids ? 3 : 0); }

/* Returns the wanted paths in flight: enough to fill a GPU; on a CPU enough for a launch to last longer than waking its threads, and few enough for
 * queues that stay in the cache. (On two cores waves of 2^18 take 0 to 17 % longer than those of 2^16, and those of 2^14 20 % longer in a small
 * scene. An H100 takes 4.4 times as long for waves of 2^16 as for 2^20, 2 % longer for 2^22, 16 % for 2^23.) */
static uint64_t wanted_wave(const ec_device_info *device)
{
    uint64_t wave = (uint64_t)1 << 16;
    if (!(device->type & CL_DEVICE_TYPE_CPU)) return (uint64_t)1 << 20;
    while (wave < (uint64_t)EC_UNIT_PATHS * device->compute_units && wave < (uint64_t)1 << 18) wave *= 2;
    return wave;
}

static uint64_t fit_wave(const ec_pipeline *p)
{
    const ec_device_info *device = &p->cl->info;
    uint64_t wave = wanted_wave(device);
    uint64_t stack = p->integrator == EC_INTEGRATOR_WHITTED ? ec_whitted_stack_words(p->params.max_depth) : 0;
    uint64_t words = 2 * EC_PATH_FIELDS + EC_HIT_FIELDS + EC_SHADOW_FIELDS + radiance_fields(p) + EC_AOV_FIELDS + stack;
    uint64_t widest = stack > EC_PATH_FIELDS ? stack : EC_PATH_FIELDS;
    while (wave > EC_SMALLEST_WAVE &&
           (wave * 4 * words > device->memory_bytes / 4 || wave * 4 * widest > device->max_allocation_bytes))
        wave /= 2;
    return wave;
}

/* Returns how many samples a wave needs room for: a pixel's, and the rays to lamps' edges that they may have. */
static uint64_t least_samples(const ec_pipeline *p)
{
    return p->params.batch * (ec_pipeline_edges_can_be(p) ? 1 + EC_EDGE_RAYS : 1ull);
}

/* Sets the wave: no more than the picture has samples, or than a small one takes; no fewer than a pixel's; every part of a queue holds whole packets. */
static void set_wave(ec_pipeline *p, uint64_t wave)
{
    const uint64_t unit = (uint64_t)EC_PARTS * p->lanes, samples = (uint64_t)p->params.width * p->params.height * p->params.batch;
    const uint64_t least = LEAST_UNITS * unit, most = samples > least ? samples : least;
    if (wave > most) wave = most;
    if (wave < least_samples(p)) wave = least_samples(p);
    p->wave = (uint32_t)((wave + unit - 1) / unit * unit);
    p->params.wave = p->wave;
    p->params.part = p->wave / EC_PARTS;
}

/* Creates a buffer and writes to it. Drivers give memory when it is first used; used here, a lack of it is found while there is a remedy. */
static ec_result create(ec_pipeline *p, const char *label, uint64_t bytes, cl_mem *buffer, ec_error *err)
{
    const ec_workaround *workaround = ec_workaround_for(&p->cl->info);
    EC_TRY(ec_buffer_create(p->cl, label, bytes, NULL, buffer, err));
    if (workaround && workaround->no_touch) return EC_OK;
    EC_TRY(ec_buffer_zero(p->cl, *buffer, 0, 4, err));
    return ec_cl_finish(p->cl, err);
}

static uint32_t path_fields_of(uint64_t features)
{
    if (features & EC_FEATURE_GUIDING) return EC_PATH_GUIDED_FIELDS;
    if (features & EC_FEATURE_LIGHT_PATHS) return EC_PATH_LIGHT_FIELDS;
    return features & EC_FEATURE_PANES ? EC_PATH_PANE_FIELDS : features & EC_FEATURES_MEDIUM ? EC_PATH_MEDIUM_FIELDS : EC_PATH_FIELDS;
}

static uint32_t shadow_fields_of(uint64_t features)
{
    return (features & EC_FEATURE_MATCHED) && (features & EC_FEATURES_MEDIUM) ? EC_SHADOW_MEDIUM_FIELDS : EC_SHADOW_FIELDS;
}

static ec_result create_wave(ec_pipeline *p, ec_error *err)
{
    p->room = p->wave;
    /* Lane-wide loads may read a packet past the last entry. */
    const uint64_t field = (uint64_t)p->wave * 4, slack = 64;
    const uint64_t path_fields = path_fields_of(p->effects.built);
    for (int i = 0; i < 2; i++) EC_TRY(create(p, "path queue", field * path_fields + slack, &p->path_queues[i], err));
    EC_TRY(create(p, "hits", field * EC_HIT_FIELDS + slack, &p->buffers[EC_ARG_HITS], err));
    EC_TRY(create(p, "shadow queue", field * shadow_fields_of(p->effects.built) + slack, &p->buffers[EC_ARG_SHADOWS], err));
    EC_TRY(create(p, "radiance", field * radiance_fields(p) + slack, &p->buffers[EC_ARG_RADIANCE], err));
    EC_TRY(create(p, "first-hit features", field * EC_AOV_FIELDS + slack, &p->buffers[EC_ARG_AOV], err));
    if (p->effects.called.bits & EC_FEATURE_MOTION)
        EC_TRY(create(p, "times of paths", field + slack, &p->buffers[EC_ARG_TIMES], err));
    if (p->effects.called.bits & EC_FEATURES_FROM_LIGHTS)
        EC_TRY(create(p, "what light paths are of", field * EC_LIGHT_SLOT_FIELDS + slack, &p->buffers[EC_ARG_LIGHT_SLOTS], err));
    if (p->integrator != EC_INTEGRATOR_WHITTED || !(p->effects.built & EC_FEATURE_TRANSMISSION)) return EC_OK; /* branches need transmission */
    return create(p, "ray trees", field * ec_whitted_stack_words(p->params.max_depth), &p->buffers[EC_ARG_BRANCHES], err);
}

static void release_wave(ec_pipeline *p)
{
    static const ec_arg of_wave[] = {EC_ARG_HITS, EC_ARG_SHADOWS, EC_ARG_RADIANCE, EC_ARG_AOV, EC_ARG_TIMES, EC_ARG_LIGHT_SLOTS, EC_ARG_BRANCHES};
    for (int i = 0; i < 2; i++) ec_buffer_release(p->cl, &p->path_queues[i]);
    for (size_t i = 0; i < sizeof of_wave / sizeof of_wave[0]; i++) ec_buffer_release(p->cl, &p->buffers[of_wave[i]]);
}

/* Other programs may be using what a device says it has. Fewer paths in flight cost speed only, so the wave is halved until it fits. */
static ec_result create_wave_that_fits(ec_pipeline *p, uint32_t wanted, ec_error *err)
{
    ec_error why = {0};
    set_wave(p, wanted ? wanted : fit_wave(p));
    p->first_room = p->wave;
    for (uint32_t refused = 0; create_wave(p, &why) != EC_OK; release_wave(p)) {
        bool lacks_memory = why.kind == EC_ERROR_DEVICE_MEMORY,
             is_last = wanted || p->wave <= EC_SMALLEST_WAVE || p->wave == refused;
        if (lacks_memory && wanted) ec_fail_more(&why, ", or a smaller --wave");
        if (err) *err = why;
        if (!lacks_memory || is_last) return EC_FAILED;
        refused = p->wave;
        set_wave(p, refused / 2);
    }
    return EC_OK;
}

void ec_pipeline_plan_wave(ec_pipeline *p, uint32_t wave)
{
    set_wave(p, wave ? wave : fit_wave(p));
    p->room = p->wave;
}

ec_result ec_pipeline_create_queues(ec_pipeline *p, uint32_t wave, ec_error *err)
{
    ec_cl *cl = p->cl;
    EC_TRY(ec_buffer_create(cl, "counters", sizeof(ec_counters), NULL, &p->buffers[EC_ARG_COUNTERS], err));
    EC_TRY(ec_buffer_create(cl, "invalid counts", EC_STAGE_COUNT * 4, NULL, &p->buffers[EC_ARG_INVALID], err));
    EC_TRY(ec_buffer_zero(cl, p->buffers[EC_ARG_INVALID], 0, EC_STAGE_COUNT * 4, err));
    const uint64_t before = cl->allocated_bytes;
    EC_TRY(create_wave_that_fits(p, wave, err));
    p->wave_bytes = cl->allocated_bytes - before;
    p->wave_is_given = wave != 0;
    return ec_buffer_create(cl, "parameters", sizeof p->params, &p->params, &p->buffers[EC_ARG_PARAMS], err);
}

uint32_t ec_pipeline_narrow_wave(const ec_pipeline *p, uint64_t features)
{
    const uint64_t unit = (uint64_t)EC_PARTS * p->lanes, built = p->effects.built;
    const uint64_t paths = (uint64_t)p->room * path_fields_of(built) / path_fields_of(features);
    const uint64_t shadows = (uint64_t)p->room * shadow_fields_of(built) / shadow_fields_of(features), fits = paths < shadows ? paths : shadows;
    const uint64_t wave = (fits < EC_NARROW_WAVE ? fits : EC_NARROW_WAVE) / unit * unit;
    return wave < least_samples(p) ? 0 : (uint32_t)wave;
}

ec_result ec_pipeline_use_wave(ec_pipeline *p, uint32_t wave, ec_error *err)
{
    p->wave = p->params.wave = wave;
    p->params.part = wave / EC_PARTS;
    return ec_buffer_write(p->cl, p->buffers[EC_ARG_PARAMS], 0, sizeof p->params, &p->params, err);
}

static ec_result create_films(ec_pipeline *p, uint64_t pixels, uint64_t positions, ec_error *err)
{
    ec_buffer_release(p->cl, &p->buffers[EC_ARG_BATCH_FILM]);
    ec_buffer_release(p->cl, &p->buffers[EC_ARG_FEATURE_FILM]);
    ec_buffer_release(p->cl, &p->buffers[EC_ARG_SPLATS]);
    ec_buffer_release(p->cl, &p->buffers[EC_ARG_LAYER_FILM]);
    if (p->params.layer_count) EC_TRY(create(p, "layer film", positions * EC_LAYER_BYTES * p->params.layer_count, &p->buffers[EC_ARG_LAYER_FILM], err));
    if (p->params.light_paths > 0) EC_TRY(create(p, "splats", pixels * 4 * EC_SPLAT_WORDS, &p->buffers[EC_ARG_SPLATS], err));
    EC_TRY(create(p, "batch film", positions * 4 * EC_BATCH_FIELDS, &p->buffers[EC_ARG_BATCH_FILM], err));
    return create(p, "feature film", positions * 4 * EC_AOV_FIELDS, &p->buffers[EC_ARG_FEATURE_FILM], err);
}

static ec_result halve_wave(ec_pipeline *p, ec_error *err)
{
    release_wave(p);
    set_wave(p, p->room / 2);
    EC_TRY(create_wave(p, err));
    return ec_pipeline_use_wave(p, p->is_narrow ? ec_pipeline_narrow_wave(p, p->kernels.features) : p->room, err);
}

/* Makes room by halving the wave, too. */
ec_result ec_pipeline_fit_films(ec_pipeline *p, uint64_t pixels, uint64_t positions, ec_error *err)
{
    ec_error why = {0};
    if (pixels <= p->film_pixels && p->buffers[EC_ARG_FEATURE_FILM]) return EC_OK;
    p->film_pixels = 0;
    for (uint32_t refused = 0; create_films(p, pixels, positions, &why) != EC_OK;) {
        bool is_last = p->wave_is_given || p->room <= EC_SMALLEST_WAVE || p->room == refused;
        if (err) *err = why;
        if (why.kind != EC_ERROR_DEVICE_MEMORY || is_last) return EC_FAILED;
        refused = p->room;
        EC_TRY(halve_wave(p, err));
    }
    p->film_pixels = pixels;
    return EC_OK;
}

/* Queues have parts, each filled by some of the threads. */
uint64_t ec_pipeline_total(const uint32_t *parts)
{
    uint64_t sum = 0;
    for (int k = 0; k < EC_PARTS; k++) sum += parts[k * EC_PART_STRIDE];
    return sum;
}

uint64_t ec_counters_bytes(uint32_t bounces) { return (bounces + 1) * sizeof(ec_bounce_counters); }

uint64_t ec_counters_clear(ec_counters *counters, uint32_t bounces)
{
    const uint64_t bytes = ec_counters_bytes(bounces), kept = sizeof counters->at[0].rays;
    memset((char *)counters + kept, 0, bytes - kept);
    return bytes;
}

uint32_t ec_pipeline_fullest(const uint32_t *parts)
{
    uint32_t most = 0;
    for (int k = 0; k < EC_PARTS; k++) most = parts[k * EC_PART_STRIDE] > most ? parts[k * EC_PART_STRIDE] : most;
    return most;
}

void ec_pipeline_swap_queues(ec_pipeline *p, uint32_t bounce)
{
    p->buffers[EC_ARG_PATHS] = p->path_queues[bounce & 1];
    p->buffers[EC_ARG_NEXT] = p->path_queues[~bounce & 1];
}

void ec_pipeline_fill_parts(ec_pipeline *p, uint32_t paths)
{
    for (uint32_t k = 0; k < EC_PARTS; k++) {
        uint32_t before = k * p->params.part, left = paths > before ? paths - before : 0;
        p->counters.at[0].rays[k * EC_PART_STRIDE] = left < p->params.part ? left : p->params.part;
    }
}
